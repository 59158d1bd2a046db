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

 private:
  template <class T, class Write>
  bool run(const T* p, Write&& write) const;

  FrictionModel model_;  // a copy: formulas must not be shared between threads
  const Observations& observations_;
  std::vector<std::size_t> slips_;
  Options options_;
  std::vector<Span> rows_;
  std::vector<std::size_t> break_away_rows_;
  std::size_t count_ = 0;
};

}  // namespace tribofit
