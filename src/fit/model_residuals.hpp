#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "dual.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit {

/// Indices of every slip.
std::vector<std::size_t> all_slips(const Observations& observations);

/// Residuals of a friction model over slips: sqrt(weight) (measured - model) for every value of each slip, and
/// |measured| - level for the break-away that begins it. Where the model acts in stick and the observations hold its
/// evidence (add_stick_evidence), the rows of the stick before the slip follow: measured v_r - creep, weighted.
///
/// A solver sees the rows of each slip compressed by a QR decomposition of [J r g] to a few rows: J'J, J'r and r'r, all
/// that least squares uses, are unchanged, and a long record stays in the cache.
///
/// With a robust loss each residual r becomes sign(r) sqrt(rho(r^2)), whose squares add up to the robust cost.
///
/// The level of break-away differs from cycle to cycle, by delta_i say, and the whole slip with it, by delta_i g_i with
/// g_i = d model/d mu_s. A cycle that breaks away higher also slips faster, so delta_i is not independent of v_r and
/// plain least squares would blame the law for it: mu_k and the decay factor come out biased. Once the scatter is known
/// the rows are therefore whitened against delta_i ~ N(0, s^2) (a random effect, N. M. Laird, J. H. Ware, Biometrics 38
/// (1982) 963, doi:10.2307/2529876): r_i becomes r_i - c g_i (d_i - d), with d_i the least-squares delta_i of the slip
/// and d their mean, so that only differences between cycles lose weight. The mean weighs each slip by how well its
/// delta_i is known beside the scatter, not by g_i'g_i, which is less the higher a slip broke away. s^2 comes from what
/// neighbouring cycles differ by (half the mean square), so that a slow change, which may be an effect the model lacks,
/// is not taken for scatter. In matrix form r becomes M r.
///
/// Friction as a whole differs from cycle to cycle too (real pads by 1 to 4 %; noise that wanders over longer times
/// than a slip does the same): a second random effect, e_i u_i with u_i the model itself and e_i ~ N(0, t^2). It looks
/// like delta_i g_i where the law falls little, and a law whose g_i it fits better would be taken for the true one.
/// Each slip's rows are first whitened against it; t^2 comes from what neighbours differ by, too, as far as break-away
/// and friction in fast slip of the record change together (see level_scatter()).
///
/// g_i follows the parameters too: a slip that broke away higher bends differently with them. So each slip is evaluated
/// at its own level mu_s + delta_i, with delta_i as predicted where the whitening was made (Lindstrom and Bates'
/// linearisation of a mixed model, Biometrics 46 (1990) 673, doi:10.2307/2532087) and taken back along g_i; without
/// that whitening and parameters settle slowly, or elsewhere.
///
/// Not for several threads at once, though its functions are const: each takes a copy.
class ModelResiduals final : public Residuals {
 public:
  struct Options {
    Loss loss = Loss::squares;
    double loss_width = 0;  ///< where the loss turns from squares to a line, for a single sample [1 or N]
    int threads = 1;        ///< that share the slips, where they hold many values; 0: as many as there are
  };

  /// How break-away scatter is taken out.
  struct Whitening {
    std::vector<Eigen::VectorXd> g;  ///< of every slip of the observations: its rows, then its break-away if it has one
    std::vector<Eigen::VectorXd> u;  ///< of every slip likewise: what the model says of each row
    double part = 0;                 ///< c = 1 - 1/sqrt(1 + s^2 g'g/sigma^2); 0: nothing to take out
    double noise = 0;                ///< sigma^2, variance of a row
    std::vector<double> level;   ///< delta_i of every slip as predicted: the least-squares one, shrunk by the scatter
    std::vector<double> weight;  ///< of every slip in the mean: s^2 g'g/(sigma^2 + s^2 g'g)
    std::vector<double> log_spread;  ///< log(1 + s^2 g'g/sigma^2) of every slip: what its likelihood pays for scatter
    double slow = 0;                 ///< t^2/sigma^2; 0: levels do not scatter
    double stick = 1;                ///< to which the squares of stick are weakened
    bool any() const { return part > 0 || slow > 0; }
  };

  /// slips: indices into observations.slips.
  ModelResiduals(const FrictionModel& model, const Observations& observations, std::vector<std::size_t> slips,
                 const Options& options = {Loss::squares, 0, 1});

  std::size_t count() const override { return slips_.size() * rows_per_slip(); }
  std::size_t parameter_count() const override { return model_.parameters().size(); }
  bool evaluate(const double* p, double* residual, double* jacobian) const override;

  std::span<const std::size_t> slips() const { return slips_; }

  /// J'J and J'r of one slip, whitened; the gradient as the part of the whole gradient that is linear in the slip's own
  /// residuals, (M'M J)_i' r_i, which is what one cycle contributes to the estimate's error: through its own rows, and
  /// through the mean of the levels.
  struct Normal {
    Eigen::MatrixXd curvature;
    Eigen::VectorXd gradient, level_gradient;
  };
  /// One for each slip given. Empty where the model is not finite. Costs little where evaluate() was last asked for the
  /// Jacobian at p.
  std::vector<Normal> normal_equations(const double* p) const;

  /// Further columns of the rows of slip k (index in observations.slips): d residual/d coefficient for every value and,
  /// last, for the break-away if it has one; not weighted.
  using FurtherColumns = std::function<Eigen::MatrixXd(std::size_t k)>;

  /// Rows [J r] of every slip at p, whitened and compressed to at most as many rows as columns plus one; with further
  /// columns [J more r]. Empty where the model is not finite.
  std::vector<Eigen::MatrixXd> white_rows(const double* p, const FurtherColumns& further = {}) const;

  /// Sum of squares of every slip at p, break-away included, stick not, not whitened. Empty where the model is not
  /// finite.
  std::vector<double> squares(const double* p) const;

  /// These residuals, of other slips.
  ModelResiduals of_slips(std::vector<std::size_t> slips) const {
    ModelResiduals out = *this;
    out.slips_ = std::move(slips);
    return out;
  }

  /// Residuals of every slip at p, compressed, and those of one slip (a place in slips()): what changes in few slips
  /// needs to be looked at in those alone. Empty where the model is not finite.
  std::vector<Eigen::MatrixXd> residual_blocks(const double* p) const;
  Eigen::MatrixXd residual_block(std::size_t k, const double* p) const;
  /// Their sum of squares of every slip, whitened.
  std::vector<double> squares_of(const std::vector<Eigen::MatrixXd>& blocks) const;

  /// Sum of squares of all rows at p, whitened. NaN where the model is not finite.
  double white_squares(const double* p) const;

  /// The same with the scatter of break-away in it, which whitening takes out. That of levels stays whitened where
  /// there is any.
  double squares_with_scatter(const double* p) const;

  /// What the rows of stick are worth against a rigid stick.
  struct StickSquares {
    double rigid = 0;  ///< squares of those rows without any creep
    double left = 0;   ///< at p
    double rows = 0;
  };
  /// One for each slip; all zero where the model does not act in stick.
  std::vector<StickSquares> stick_squares(const double* p) const;

  /// Takes the squares of stick for this part of what the noise of v_r makes of them.
  void weaken_stick(double part) {
    cache_.last.p.clear();
    for (Eigen::MatrixXd& weights : weights_) weights *= std::sqrt(part);
  }

  /// Whitens; `whitening` must outlive this object. own_levels: evaluate each slip at its own level; for the model that
  /// the whitening was made with.
  void whiten(const Whitening& whitening, bool own_levels = false) {
    cache_.last.p.clear();
    whitening_ = &whitening;
    own_levels_ = own_levels && options_.loss == Loss::squares;
  }
  /// The whitening that the residuals at p call for; none where no slip begins with a break-away.
  Whitening whitening_at(const double* p) const;

 private:
  /// Columns J (when asked for), r, g of one slip; compressed to as many rows as columns at the most.
  using Block = Eigen::MatrixXd;
  std::size_t rows_per_slip() const { return parameter_count() + 2; }
  /// Rows of friction: values and break-away.
  static Eigen::Index friction_rows(const Observations::SlipObservation& range) {
    return static_cast<Eigen::Index>(range.end - range.begin + (range.from_stick ? 1 : 0));
  }
  Eigen::Index stick_rows(const Observations::SlipObservation& range) const {
    return range.stick == Observations::npos || weights_.empty() ? 0 : weights_[range.record].rows();
  }
  /// What is written anew for every slip, kept from one to the next.
  template <class T>
  struct Arrays {
    std::vector<T> p, at_level, velocity, mu, rows;
  };
  struct Workspace {
    Arrays<double> values;
    Arrays<Dual<2>> two;
    Arrays<Dual<4>> four;
    Arrays<Dual<6>> six;
    Arrays<Dual<8>> eight;
  };
  /// Adds the residuals of stick to `rows`.
  template <class T>
  void add_stick_residuals(const Observations::SlipObservation& range, const T* p, std::vector<T>& rows) const;
  /// Every row of a slip, each with a robust loss on, into arrays.rows; false where the model is not finite.
  template <class T>
  bool run(const Observations::SlipObservation& range, const T* p, double level, Arrays<T>& arrays) const;
  /// Derivatives by the parameters [first, first + N), and the residuals, into the block.
  template <std::size_t N>
  bool differentiate(const Observations::SlipObservation& range, const double* p, double level, std::size_t first,
                     std::size_t derivatives, Arrays<Dual<N>>& arrays, Block& block) const;
  /// Derivatives by the first so many parameters, r, g of one slip.
  bool fill(std::size_t k, const double* p, std::size_t derivatives, Workspace& workspace, Block& block,
            bool plain = false) const;
  bool compressed(const double* p, bool with_jacobian, std::vector<Block>& blocks,
                  const FurtherColumns& further = {}) const;
  bool was_evaluated(const double* p) const;  ///< by white_blocks(), and last
  /// Blocks with the Jacobian, whitened; nullptr where the model is not finite. A search often asks once more for
  /// where another one ended.
  const std::vector<Block>* white_blocks(const double* p) const;
  /// As compressed(), of the slips [begin, end).
  bool compress(std::size_t begin, std::size_t end, const double* p, bool with_jacobian, std::vector<Block>& blocks,
                const FurtherColumns& further) const;
  /// Into how many parts the slips are best split.
  std::size_t parts() const;
  /// work(residuals, begin, end) for each part of the slips, side by side; false where it is for one of them.
  template <class Work>
  bool in_parts(Work&& work) const;
  /// Takes out of the rows of a slip what scatter of its level is expected to do. level: see Whitening::u.
  void whiten_level(const Eigen::VectorXd& level, Block& block) const;
  /// c (mean over slips of the regression of the columns on g, less that of the slip), to be added as g times it: one
  /// column for each slip, a row for each of its columns but g. No columns where there is nothing to add.
  Eigen::MatrixXd corrections(const std::vector<Block>& blocks) const;
  /// Adds g times what corrections() gave for this slip to the other columns of its block.
  static void add_to(Block& block, Eigen::Index slip, const Eigen::MatrixXd& added);

  FrictionModel model_;  // a copy: formulas must not be shared between threads
  const Observations& observations_;
  std::vector<std::size_t> slips_;
  Options options_;
  const Whitening* whitening_ = nullptr;
  bool own_levels_ = false;
  std::size_t first_part_ = 0;            ///< of a stick, from which the model's creep holds
  std::vector<Eigen::MatrixXd> weights_;  ///< of the parts of a stick, for each record
  struct Evaluated {
    std::vector<double> p;  ///< empty: none yet
    std::vector<Block> blocks;
    Eigen::MatrixXd added;  ///< see corrections(): what whitened them
  };
  /// From one evaluation to the next; copies begin without it.
  struct Cache {
    Evaluated last;                     ///< see white_blocks()
    std::vector<Block> without_slopes;  ///< memory for an evaluation without the Jacobian

    Cache() = default;
    Cache(const Cache&) {}
    Cache(Cache&&) = default;
  };
  mutable Cache cache_;
};

template <class Work>
bool ModelResiduals::in_parts(Work&& work) const {
  const std::size_t count = parts();
  if (count == 1) return work(*this, std::size_t{0}, slips_.size());
  std::vector<unsigned char> done(count);
  run_tasks(count, options_.threads, [&](std::size_t part) {
    const ModelResiduals own(*this);  // its formulas must not be shared between threads
    done[part] = work(own, part * slips_.size() / count, (part + 1) * slips_.size() / count) ? 1 : 0;
  });
  return std::find(done.begin(), done.end(), 0) == done.end();
}

}  // namespace tribofit
