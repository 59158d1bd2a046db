#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tribofit {

/// Residuals r(p) of a least-squares problem with their derivatives.
class Residuals {
 public:
  virtual ~Residuals() = default;
  virtual std::size_t count() const = 0;
  virtual std::size_t parameter_count() const = 0;
  /// Writes count() residuals and, unless `jacobian` is null, count() x parameter_count() derivatives by rows.
  /// Returns false where the model is not finite at p.
  virtual bool evaluate(const double* p, double* residual, double* jacobian) const = 0;
};

struct SolverOptions {
  int max_iterations = 5000;
  double relative_step = 1e-12;  ///< stop when a step changes p by less than this part
  double relative_cost = 1e-15;  ///< stop when a step lowers the cost by less than this part
  double trust_radius = 1e4;     ///< of the first step
  /// Take the last digits by plain Gauss-Newton steps, which the rounding of the cost does not stop, and start again
  /// with short steps where a parameter ran away. Costs a few more evaluations.
  bool careful = true;
  /// Hold what a bound holds back as soon as the bound cuts off a step that does not lower the cost, without trying
  /// shorter ones. Takes far fewer evaluations, and now and then ends in another minimum: for searches of which the
  /// best is compared.
  bool hold_at_bounds = false;
};

/// Where a search ended.
struct Solution {
  std::vector<double> p;
  double cost = 0;  ///< half the sum of squares
  bool converged = false;
  std::string message;  ///< of the solver, for a person
};

/// Least squares by Levenberg-Marquardt (Ceres, dense QR), within bounds where they are given.
/// Parameters with lower == upper are held. A problem that cannot be solved is a result with converged == false.
/// Throws Stopped within a StopScope that says so, and so does the other.
Solution minimize(const Residuals& problem, std::span<const double> start, std::span<const double> lower = {},
                  std::span<const double> upper = {}, const SolverOptions& options = {});

/// Residuals that know a part of all values only, as those of one record do of several that share parameters.
struct ResidualPart {
  const Residuals* residuals = nullptr;
  double root_weight = 1;           ///< by which each residual is multiplied
  std::vector<std::size_t> values;  ///< the value that each of its parameters takes; no two of them the same
};

/// Least squares of all parts together, within bounds. Values that one part alone depends on are eliminated part by
/// part (Schur complement), and of its residuals a part keeps as many rows as it has parameters, and one: cost and
/// memory are linear in parts.
Solution minimize(std::span<const ResidualPart> parts, std::span<const double> start, std::span<const double> lower,
                  std::span<const double> upper, const SolverOptions& options = {});

}  // namespace tribofit
