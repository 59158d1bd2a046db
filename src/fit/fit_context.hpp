#pragma once

#include <span>
#include <utility>
#include <vector>

#include "model_residuals.hpp"
#include "starts.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit {

/// One fit in the making: what all its steps share.
struct FitContext {
  const FrictionModel& model;
  std::span<const Record> records;
  const Observations& observations;
  const Instruments& instruments;
  const FitOptions& options;
  Bounds given{};                         ///< with what the user said of them
  Bounds bounds{};                        ///< `given`, but for what the protocol holds
  ModelResiduals::Options evaluation{};   ///< loss and threads
  ModelResiduals::Whitening whitening{};  ///< of every slip; without any: plain least squares

  bool by_extremes() const { return options.protocol == Protocol::published; }
  bool is_look() const { return options.starts == 0; }
  /// Sets the whitening to what the residuals at p call for; `plain` are those of all slips, not whitened.
  void whiten_at(const ModelResiduals& plain, const std::vector<double>& p, bool keep_residuals = false) {
    whitening = plain.whitening_at(p.data(), keep_residuals, std::exchange(whitening, {}));
  }
  ModelResiduals residuals(const std::vector<std::size_t>& slips, bool own_levels = true) const {
    ModelResiduals out(model, observations, slips, evaluation);
    if (whitening.any()) out.whiten(whitening, own_levels);
    return out;
  }
  SolverResult solve(const std::vector<std::size_t>& slips, const std::vector<double>& start,
                     const SolverOptions& solver, const Bounds& within) const {
    return minimize(residuals(slips), start, within.lower, within.upper, solver);
  }
  SolverResult solve(const std::vector<std::size_t>& slips, const std::vector<double>& start,
                     const SolverOptions& solver) const {
    return solve(slips, start, solver, bounds);
  }
};

/// A search that is good enough to compare.
SolverOptions quick_search();

/// Good enough for a look: what has not been found by then is far away.
SolverOptions short_search();

/// Two ends of quick searches, which stop at steps of 1e-7: no further apart than ten of those.
bool are_alike(const std::vector<double>& a, const std::vector<double>& b);

/// A value within a millionth of its range of a bound sits on it.
bool on_bound(double value, double lower, double upper);

}  // namespace tribofit
