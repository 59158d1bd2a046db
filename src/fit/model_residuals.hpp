#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit {

/// Residuals of a friction model over slips: sqrt(weight) (measured - model) for every value of each slip, and
/// |measured| - level for the break-away that begins it.
///
/// A solver sees the rows of each slip compressed by a QR decomposition of [J r] to as many rows as it has parameters, plus one:
/// J'J, J'r and r'r, all that least squares uses, are unchanged, and a long record stays in the cache.
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

  /// How the break-away scatter of one slip is taken out of its rows: r - part g (g'r)/(g'g).
  struct Whitening {
    Eigen::VectorXd g;  ///< the slip's rows, then its break-away if it has one
    double part = 0;    ///< 1 - 1/sqrt(1 + s^2 g'g/sigma^2); 0: nothing to take out
  };

  /// slips: indices into observations.slips.
  ModelResiduals(const FrictionModel& model, const Observations& observations, std::vector<std::size_t> slips,
                 const Options& options = {Loss::squares, 0});

  std::size_t count() const override { return slips_.size() * (parameter_count() + 1); }
  std::size_t parameter_count() const override { return model_.parameters().size(); }
  bool evaluate(const double* p, double* residual, double* jacobian) const override;

  std::span<const std::size_t> slips() const { return slips_; }
  /// First of the parameter_count() + 1 compressed rows of slip k (of those given).
  std::size_t first_row(std::size_t k) const { return k * (parameter_count() + 1); }
  /// Sum of squares of every slip at p, break-away included. Empty where the model is not finite.
  std::vector<double> squares(const double* p) const;

  /// Whitens with one entry for each slip of the observations, which must outlive this object.
  void whiten(const std::vector<Whitening>& by_slip) { whitening_ = &by_slip; }
  /// The whitening that the residuals at p call for; none where no slip begins with a break-away.
  std::vector<Whitening> whitening_at(const double* p) const;

 private:
  /// Uncompressed rows of one slip.
  struct Rows {
    Eigen::MatrixXd jacobian_and_residual;  ///< the last column holds the residuals
    auto residual() { return jacobian_and_residual.col(jacobian_and_residual.cols() - 1); }
  };
  bool fill(std::size_t k, const double* p, bool with_jacobian, Rows& rows) const;
  template <class T, class Write>
  bool run(const Observations::Range& range, const T* p, Write&& write) const;

  FrictionModel model_;  // a copy: formulas must not be shared between threads
  const Observations& observations_;
  std::vector<std::size_t> slips_;
  Options options_;
  const std::vector<Whitening>* whitening_ = nullptr;
};

}  // namespace tribofit
