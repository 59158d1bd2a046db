#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit {

/// Residuals of a friction model over slips: sqrt(weight) (measured - model) for every value of each slip, in the
/// order of the slips, then one residual for each break-away: |measured| - level.
///
/// With a robust loss each residual r becomes sign(r) sqrt(rho(r^2)), whose squares add up to the robust cost.
///
/// The level of break-away differs from cycle to cycle, by delta_i say, and the whole slip with it, by delta_i g with
/// g = d model/d mu_s. A cycle that breaks away higher also slips faster, so delta_i is not independent of v_r and plain least
/// squares would blame the law for it: mu_k and the decay factor come out biased. Once the scatter is known the rows of each
/// slip are therefore whitened against delta_i ~ N(0, s^2), covariance sigma^2 I + s^2 g g' (a random effect, N. M. Laird,
/// J. H. Ware, Biometrics 38 (1982) 963, doi:10.2307/2529876).
class ModelResiduals final : public Residuals {
 public:
  struct Options {
    Loss loss = Loss::squares;
    double loss_width = 0;  ///< where the loss bends, for a single sample [1 or N]
  };
  /// slips: indices into observations.slips.
  ModelResiduals(const FrictionModel& model, const Observations& observations, std::vector<std::size_t> slips,
                 const Options& options);
  ModelResiduals(const FrictionModel& model, const Observations& observations, std::vector<std::size_t> slips);

  std::size_t count() const override { return count_; }
  std::size_t parameter_count() const override { return model_.parameters().size(); }
  bool evaluate(const double* p, double* residual, double* jacobian) const override;

  /// Rows [begin, end) of slip k (of those given), its break-away excluded.
  Span rows(std::size_t k) const { return rows_[k]; }
  /// Row of the break-away of slip k, or count() when it has none.
  std::size_t break_away_row(std::size_t k) const { return break_away_rows_[k]; }
  std::span<const std::size_t> slips() const { return slips_; }

  /// How the break-away scatter of one slip is taken out of its rows: r - part g (g'r)/(g'g).
  struct Whitening {
    std::vector<double> g;  ///< the slip's rows, then its break-away if it has one
    double part = 0;        ///< 1 - 1/sqrt(1 + s^2 g'g/sigma^2); 0: nothing to take out
  };
  /// One for each slip of the observations.
  void whiten(const std::vector<Whitening>& by_slip) { whitening_ = &by_slip; }
  /// The whitening that the residuals at p call for; none where no slip begins with a break-away.
  std::vector<Whitening> whitening_at(const double* p) const;

 private:
  template <class T, class Write>
  bool run(const T* p, Write&& write) const;

  FrictionModel model_;  // a copy: formulas must not be shared between threads
  const Observations& observations_;
  std::vector<std::size_t> slips_;
  Options options_;
  std::vector<Span> rows_;
  std::vector<std::size_t> break_away_rows_;
  void apply_whitening(double* residual, double* jacobian) const;

  std::size_t count_ = 0;
  const std::vector<Whitening>* whitening_ = nullptr;
};

}  // namespace tribofit
