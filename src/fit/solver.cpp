#include "tribofit/fit/solver.hpp"

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ceres_parts.hpp"
#include "statistics/linear_algebra.hpp"

namespace tribofit {

namespace {

/// All residuals of a problem as one cost; held parameters are left out of Ceres' parameter block.
class Cost : public ceres::CostFunction {
 public:
  Cost(const Residuals& problem, std::vector<double> p, std::vector<std::size_t> free)
      : problem_(problem), p_(std::move(p)), free_(std::move(free)) {
    set_num_residuals(static_cast<int>(problem.count()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
    if (free_.size() < p_.size()) all_.resize(problem.count() * p_.size());
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    for (std::size_t k = 0; k < free_.size(); ++k) p_[free_[k]] = blocks[0][k];
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    const bool all_free = free_.size() == p_.size();
    double* derivatives = jacobian == nullptr || all_free ? jacobian : all_.data();
    if (!evaluate_unless_stopped(problem_, p_.data(), residuals, derivatives)) return false;
    if (jacobian == nullptr) return true;
    for (std::size_t i = 0; !all_free && i < problem_.count(); ++i) {
      for (std::size_t k = 0; k < free_.size(); ++k) jacobian[i * free_.size() + k] = all_[i * p_.size() + free_[k]];
    }
    note(residuals, jacobian);
    return true;
  }

  /// A first step that was too long can throw a parameter so far out that no residual feels it any more; the cost is
  /// flat there and the solver calls it converged.
  bool ran_away() const {
    for (std::size_t k = 0; k < first_norms_.size(); ++k) {
      if (last_norms_[k] < 1e-12 * first_norms_[k]) return true;
    }
    return false;
  }

  /// Free parameters that a bound holds back where the search stands: they are on it, and beyond it the cost is less.
  std::vector<std::size_t> held_back(std::span<const double> lower, std::span<const double> upper) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < last_slope_.size() && !lower.empty(); ++k) {
      const std::size_t i = free_[k];
      if ((here_[k] <= lower[i] && last_slope_[k] > 0) || (here_[k] >= upper[i] && last_slope_[k] < 0))
        out.push_back(i);
    }
    return out;
  }

 private:
  /// Ceres asks for the Jacobian where the search stands, and only there.
  void note(const double* residuals, const double* jacobian) const {
    last_norms_.assign(free_.size(), 0.0);
    last_slope_.assign(free_.size(), 0.0);
    for (std::size_t i = 0; i < problem_.count(); ++i) {
      for (std::size_t k = 0; k < free_.size(); ++k) {
        const double derivative = jacobian[i * free_.size() + k];
        last_norms_[k] += derivative * derivative;
        last_slope_[k] += derivative * residuals[i];
      }
    }
    if (first_norms_.empty()) first_norms_ = last_norms_;
    here_.clear();
    for (const std::size_t i : free_) here_.push_back(p_[i]);
  }

  mutable std::vector<double> first_norms_, last_norms_;  ///< squared column norms of the first and last Jacobian
  mutable std::vector<double> last_slope_, here_;         ///< of the cost, and the free parameters, with the last one
  const Residuals& problem_;
  mutable std::vector<double> p_;
  std::vector<std::size_t> free_;
  mutable std::vector<double> all_;
};

/// Ends a descent with the first step that does not lower the cost while a bound holds a parameter back. The bound cut
/// that step off, and what is left of it is not the best one for the others: shorter and shorter ones would follow.
class StopAtBound : public ceres::IterationCallback {
 public:
  StopAtBound(const Cost& cost, std::span<const double> lower, std::span<const double> upper)
      : cost_(cost), lower_(lower), upper_(upper) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& step) override {
    const bool failed = step.iteration > 0 && !step.step_is_successful;
    return failed && !cost_.held_back(lower_, upper_).empty() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                              : ceres::SOLVER_CONTINUE;
  }

 private:
  const Cost& cost_;
  std::span<const double> lower_, upper_;
};

/// Gauss-Newton steps from a minimum that is known to half its digits (the cost is flat there to rounding). Each must
/// be shorter than the one before it, stay within the bounds and not raise the cost beyond rounding. Where residuals
/// are large they may shorten slowly, by nearly the same part each time: what is still to come is then taken with them
/// (D. G. Anderson, J. ACM 12 (1965) 547, doi:10.1145/321296.321305, with one step before).
void polish(const Residuals& problem, const std::vector<std::size_t>& free, std::span<const double> lower,
            std::span<const double> upper, Minimum& result) {
  constexpr int kSteps = 30;
  const auto rows = static_cast<Eigen::Index>(problem.count()), all = static_cast<Eigen::Index>(result.p.size());
  Eigen::VectorXd residual(rows), last_change, last_step;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> full(rows, all);
  double last = 1e-3;  // a longer step is no polish
  for (int count = 0; count < kSteps; ++count) {
    if (!problem.evaluate(result.p.data(), residual.data(), full.data())) return;
    Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) {
      jacobian.col(static_cast<Eigen::Index>(k)) = full.col(static_cast<Eigen::Index>(free[k]));
    }
    const Eigen::VectorXd scale = jacobian.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    jacobian *= scale.asDiagonal();
    const Eigen::VectorXd change = scale.asDiagonal() * least_squares(jacobian, -residual);
    Eigen::VectorXd step = change;
    if (count > 0) {
      const Eigen::VectorXd shorter = (change - last_change).cwiseQuotient(scale);
      const double part = shorter.dot(change.cwiseQuotient(scale)) / std::max(shorter.squaredNorm(), 1e-300);
      step -= part * (last_step + change - last_change);
    }
    std::vector<double> p = result.p;
    double length = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      p[free[k]] += step(i);
      length = std::max(length, std::abs(change(i)) / std::max(std::abs(p[free[k]]), 1e-300));
      if (!lower.empty() && (p[free[k]] < lower[free[k]] || p[free[k]] > upper[free[k]])) return;
    }
    if (!(length < last)) return;
    last = length;
    last_change = change;
    last_step = step;
    if (!problem.evaluate(p.data(), residual.data(), nullptr)) return;
    const double cost = 0.5 * residual.squaredNorm();
    if (cost > result.cost * (1 + 1e-8)) return;
    result.p = p;
    result.cost = cost;
    if (length < 1e-13) return;
  }
}

/// One descent from a start.
struct Descent {
  Minimum result;
  bool ran_away = false;               ///< a parameter ended where no residual feels it (see Cost)
  std::vector<std::size_t> held_back;  ///< by bounds where it ended
};

Descent descend(const Residuals& problem, std::span<const double> start, const std::vector<std::size_t>& free,
                std::span<const double> lower, std::span<const double> upper, const SolverOptions& options) {
  Descent out;
  Minimum& result = out.result;
  result.p.assign(start.begin(), start.end());
  std::vector<double> x;
  for (const std::size_t k : free) x.push_back(start[k]);
  ceres::Problem ceres_problem;
  auto* cost = new Cost(problem, result.p, free);  // owned by the problem
  ceres_problem.AddResidualBlock(cost, nullptr, x.data());
  for (std::size_t j = 0; j < free.size() && !lower.empty(); ++j) {
    const int index = static_cast<int>(j);
    if (std::isfinite(lower[free[j]])) ceres_problem.SetParameterLowerBound(x.data(), index, lower[free[j]]);
    if (std::isfinite(upper[free[j]])) ceres_problem.SetParameterUpperBound(x.data(), index, upper[free[j]]);
  }
  ceres::Solver::Options solver = ceres_options(options);
  solver.linear_solver_type = ceres::DENSE_QR;
  StopAtBound at_bound(*cost, lower, upper);
  if (options.hold_at_bounds) solver.callbacks.push_back(&at_bound);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  stop_point();

  for (std::size_t j = 0; j < free.size(); ++j) result.p[free[j]] = x[j];
  result.cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
  const bool at_minimum = summary.termination_type == ceres::CONVERGENCE;
  result.converged = at_minimum || summary.termination_type == ceres::USER_SUCCESS;
  result.iterations = static_cast<int>(summary.iterations.size());
  result.message = explain(summary);
  out.ran_away = cost->ran_away();
  out.held_back = cost->held_back(lower, upper);
  if (options.careful && at_minimum && out.held_back.empty()) polish(problem, free, lower, upper, result);
  return out;
}

/// What is returned where there is nothing to solve, or too little to solve it with.
Minimum unsolved(const Residuals& problem, std::span<const double> start, bool nothing_free) {
  Minimum result;
  result.p.assign(start.begin(), start.end());
  std::vector<double> r(problem.count());
  const bool finite = problem.evaluate(result.p.data(), r.data(), nullptr);
  for (const double x : r) result.cost += 0.5 * x * x;
  result.converged = finite && nothing_free;
  result.message = nothing_free ? "nothing to fit" : "fewer observations than parameters";
  return result;
}

/// What bounds hold back is held there, and the others go on.
void finish_beside_bounds(const Residuals& problem, std::vector<std::size_t> free, std::span<const double> lower,
                          std::span<const double> upper, const SolverOptions& options, Descent& last) {
  while (!last.held_back.empty() && last.held_back.size() < free.size()) {
    std::erase_if(free, [&](std::size_t k) {
      return std::find(last.held_back.begin(), last.held_back.end(), k) != last.held_back.end();
    });
    Descent next = descend(problem, last.result.p, free, lower, upper, options);
    if (next.ran_away || !(next.result.cost <= last.result.cost)) return;
    last = std::move(next);
  }
}

}  // namespace

Minimum minimize(const Residuals& problem, std::span<const double> start, std::span<const double> lower,
                 std::span<const double> upper, const SolverOptions& options) {
  const QuietLogging quiet;
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (lower.empty() || lower[k] < upper[k]) free.push_back(k);
  }
  if (free.empty() || problem.count() < free.size()) return unsolved(problem, start, free.empty());

  Descent found = descend(problem, start, free, lower, upper, options);
  if (options.careful && (!found.result.converged || found.ran_away)) {
    SolverOptions cautious = options;
    cautious.trust_radius = 1e-4;
    Descent retry = descend(problem, start, free, lower, upper, cautious);
    if (retry.result.cost < found.result.cost) found = std::move(retry);
  }
  finish_beside_bounds(problem, std::move(free), lower, upper, options, found);
  return std::move(found.result);
}

}  // namespace tribofit
