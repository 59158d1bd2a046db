#include "tribofit/fit/solver.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "statistics/linear_algebra.hpp"
#include "tribofit/execution/stop.hpp"

namespace tribofit {

namespace {

/// Ceres reports trouble through glog, on stderr; a fit reports it in its result. While any fit is being solved glog
/// keeps quiet; then it is as the program had it.
class QuietLogging {
 public:
  QuietLogging() {
    const std::lock_guard lock(guard_);
    if (solving_++ > 0) return;
    level_ = FLAGS_minloglevel;
    FLAGS_minloglevel = google::GLOG_FATAL;
  }
  ~QuietLogging() {
    const std::lock_guard lock(guard_);
    if (--solving_ == 0) FLAGS_minloglevel = level_;
  }
  QuietLogging(const QuietLogging&) = delete;
  QuietLogging& operator=(const QuietLogging&) = delete;

 private:
  static inline std::mutex guard_;
  static inline int solving_ = 0, level_ = 0;
};

/// Ceres takes no exceptions. Work that is to stop is to it an evaluation that fails, after which it soon gives up;
/// then stop_point() throws.
bool evaluate_unless_stopped(const Residuals& problem, const double* p, double* residual, double* jacobian) {
  try {
    stop_point();
    return problem.evaluate(p, residual, jacobian);
  } catch (const Stopped&) {
    return false;
  }
}

ceres::Solver::Options ceres_options(const SolverOptions& options) {
  ceres::Solver::Options solver;
  solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  solver.initial_trust_region_radius = options.trust_radius;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.relative_cost;
  solver.parameter_tolerance = options.relative_step;
  solver.gradient_tolerance = 0;  // residuals have no common scale; steps and cost decide
  // Where there are bounds Ceres would try every step by a line search first, which takes the Jacobian once more each
  // time: half of all evaluations. A step that a bound cuts off and that does not lower the cost is taken back anyway.
  solver.max_num_line_search_step_size_iterations = 0;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

/// What a run of Ceres came to, but for the values.
Solution solution_of(const ceres::Solver::Summary& summary) {
  Solution out;
  out.cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
  out.converged = summary.termination_type == ceres::CONVERGENCE || summary.termination_type == ceres::USER_SUCCESS;
  out.message = out.converged ? "converged" : "the solver failed: " + summary.message;
  if (summary.termination_type == ceres::NO_CONVERGENCE)
    out.message = "did not converge within " + std::to_string(summary.iterations.size()) + " iterations";
  return out;
}

void set_bounds(ceres::Problem& problem, double* block, int index, double lower, double upper) {
  if (std::isfinite(lower)) problem.SetParameterLowerBound(block, index, lower);
  if (std::isfinite(upper)) problem.SetParameterUpperBound(block, index, upper);
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// All residuals of a problem as one cost; held parameters are left out of Ceres' parameter block.
class Cost : public ceres::CostFunction {
 public:
  Cost(const Residuals& problem, std::vector<double> p, std::vector<std::size_t> free)
      : problem_(problem), p_(std::move(p)), free_(std::move(free)) {
    set_num_residuals(static_cast<int>(problem.count()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
    if (free_.size() < p_.size()) all_.resize(Eigen::Index(problem.count()), Eigen::Index(p_.size()));
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    for (std::size_t k = 0; k < free_.size(); ++k) p_[free_[k]] = blocks[0][k];
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    double* derivatives = jacobian == nullptr || all_.size() == 0 ? jacobian : all_.data();
    if (!evaluate_unless_stopped(problem_, p_.data(), residuals, derivatives)) return false;
    if (jacobian == nullptr) return true;
    Eigen::Map<RowMajor> own(jacobian, Eigen::Index(problem_.count()), Eigen::Index(free_.size()));
    if (all_.size() > 0) own = all_(Eigen::all, free_);
    // Ceres asks for the Jacobian where the search stands, and only there.
    last_norms_ = own.colwise().squaredNorm().transpose();
    last_slope_ = own.transpose() * Eigen::Map<const Eigen::VectorXd>(residuals, own.rows());
    if (first_norms_.size() == 0) first_norms_ = last_norms_;
    here_ = p_;
    return true;
  }

  /// A first step that was too long can throw a parameter so far out that no residual feels it any more; the cost is
  /// flat there and the solver calls it converged.
  bool ran_away() const { return (last_norms_.array() < 1e-12 * first_norms_.array()).any(); }

  /// Free parameters that a bound holds back where the search stands: they are on it, and beyond it the cost is less.
  std::vector<std::size_t> held_back(std::span<const double> lower, std::span<const double> upper) const {
    std::vector<std::size_t> out;
    for (Eigen::Index k = 0; k < last_slope_.size() && !lower.empty(); ++k) {
      const std::size_t i = free_[static_cast<std::size_t>(k)];
      if ((here_[i] <= lower[i] && last_slope_(k) > 0) || (here_[i] >= upper[i] && last_slope_(k) < 0))
        out.push_back(i);
    }
    return out;
  }

 private:
  mutable Eigen::VectorXd first_norms_, last_norms_;  ///< squared column norms of the first and last Jacobian
  mutable Eigen::VectorXd last_slope_;                ///< of the cost, and the parameters, with the last one
  mutable std::vector<double> here_;
  const Residuals& problem_;
  mutable std::vector<double> p_;
  std::vector<std::size_t> free_;
  mutable RowMajor all_;
};

/// Ends a search with the first step that does not lower the cost while a bound holds a parameter back. The bound cut
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
            std::span<const double> upper, Solution& result) {
  constexpr int kSteps = 30;
  RowMajor full(problem.count(), result.p.size());
  Eigen::VectorXd residual(full.rows()), last_change, last_step;
  double last = 1e-3;  // a longer step is no polish
  for (int count = 0; count < kSteps; ++count) {
    if (!problem.evaluate(result.p.data(), residual.data(), full.data())) return;
    Eigen::MatrixXd jacobian = full(Eigen::all, free);
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

/// One search from a start.
struct Search {
  Solution found;
  bool ran_away = false;               ///< a parameter ended where no residual feels it (see Cost)
  std::vector<std::size_t> held_back;  ///< by bounds where it ended
};

Search search_from(const Residuals& problem, std::span<const double> start, const std::vector<std::size_t>& free,
                   std::span<const double> lower, std::span<const double> upper, const SolverOptions& options) {
  std::vector<double> x, p(start.begin(), start.end());
  for (const std::size_t k : free) x.push_back(start[k]);
  ceres::Problem ceres_problem;
  auto* cost = new Cost(problem, p, free);  // owned by the problem
  ceres_problem.AddResidualBlock(cost, nullptr, x.data());
  for (std::size_t j = 0; j < free.size() && !lower.empty(); ++j)
    set_bounds(ceres_problem, x.data(), static_cast<int>(j), lower[free[j]], upper[free[j]]);
  ceres::Solver::Options solver = ceres_options(options);
  solver.linear_solver_type = ceres::DENSE_QR;
  StopAtBound at_bound(*cost, lower, upper);
  if (options.hold_at_bounds) solver.callbacks.push_back(&at_bound);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  stop_point();
  for (std::size_t j = 0; j < free.size(); ++j) p[free[j]] = x[j];
  Search out{solution_of(summary), cost->ran_away(), cost->held_back(lower, upper)};
  out.found.p = std::move(p);
  if (options.careful && summary.termination_type == ceres::CONVERGENCE && out.held_back.empty())
    polish(problem, free, lower, upper, out.found);
  return out;
}

/// What is returned where there is nothing to solve, or too little to solve it with.
Solution unsolved(const Residuals& problem, std::span<const double> start, bool nothing_free) {
  Solution out{.p = {start.begin(), start.end()},
               .message = nothing_free ? "nothing to fit" : "fewer observations than parameters"};
  Eigen::VectorXd residual(problem.count());
  out.converged = problem.evaluate(out.p.data(), residual.data(), nullptr) && nothing_free;
  out.cost = 0.5 * residual.squaredNorm();
  return out;
}

/// The residuals of one part as one cost of several parameter blocks: R of the QR of [J r].
class PartCost : public ceres::CostFunction {
 public:
  /// blocks: parameters of the part in each block of Ceres; the others stay at `p`.
  PartCost(const ResidualPart& part, std::vector<double> p, std::vector<std::vector<std::size_t>> blocks)
      : part_(part), p_(std::move(p)), blocks_(std::move(blocks)) {
    set_num_residuals(static_cast<int>(p_.size() + 1));
    for (const auto& block : blocks_) mutable_parameter_block_sizes()->push_back(static_cast<int>(block.size()));
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    std::vector<double> p = p_;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (std::size_t k = 0; k < blocks_[b].size(); ++k) p[blocks_[b][k]] = blocks[b][k];
    }
    const auto rows = static_cast<Eigen::Index>(part_.residuals->count()), n = static_cast<Eigen::Index>(p.size());
    Eigen::VectorXd residual(rows);
    RowMajor jacobian(jacobians == nullptr ? 0 : rows, n);
    double* derivatives = jacobians == nullptr ? nullptr : jacobian.data();
    if (!evaluate_unless_stopped(*part_.residuals, p.data(), residual.data(), derivatives)) return false;
    if (jacobians == nullptr) {
      std::fill_n(residuals, num_residuals(), 0.0);
      residuals[0] = part_.root_weight * residual.norm();
      return true;
    }
    Eigen::MatrixXd all(rows, n + 1);
    all << jacobian, residual;
    const Eigen::MatrixXd kept = part_.root_weight * triangular_factor(all);
    Eigen::Map<Eigen::VectorXd>(residuals, n + 1) = kept.col(n);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] != nullptr)
        Eigen::Map<RowMajor>(jacobians[b], n + 1, Eigen::Index(blocks_[b].size())) = kept(Eigen::all, blocks_[b]);
    }
    return true;
  }

 private:
  const ResidualPart& part_;
  std::vector<double> p_;
  std::vector<std::vector<std::size_t>> blocks_;
};

/// The values as blocks of Ceres: those that one part alone depends on as one block of it, each other by itself.
class Blocks {
 public:
  Blocks(std::span<const ResidualPart> parts, std::span<const double> start, std::span<const double> lower,
         std::span<const double> upper)
      : all_(start.begin(), start.end()), lower_(lower), upper_(upper), users_(start.size(), 0) {
    for (const ResidualPart& part : parts) {
      for (const std::size_t value : part.values) ++users_[value];
    }
    own_.resize(parts.size());
    for (std::size_t r = 0; r < parts.size(); ++r) {
      for (const std::size_t value : parts[r].values) {
        if (is_free(value) && users_[value] == 1) own_[r].push_back(all_[value]);
      }
    }
  }

  void add(const ResidualPart& part, std::size_t r, ceres::Problem& problem, ceres::ParameterBlockOrdering& order) {
    std::vector<std::vector<std::size_t>> blocks;
    std::vector<double*> data;
    if (!own_[r].empty()) {
      blocks.emplace_back();
      data.push_back(own_[r].data());
    }
    std::vector<double> p;
    for (std::size_t k = 0; k < part.values.size(); ++k) {
      const std::size_t value = part.values[k];
      p.push_back(all_[value]);
      if (!is_free(value)) continue;
      if (users_[value] == 1) {
        blocks.front().push_back(k);
        continue;
      }
      blocks.push_back({k});
      data.push_back(&all_[value]);
    }
    if (data.empty()) return;
    const std::size_t first_common = own_[r].empty() ? 0 : 1;
    problem.AddResidualBlock(new PartCost(part, p, blocks), nullptr, data);  // owned by the problem
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      order.AddElementToGroup(data[b], b < first_common ? 0 : 1);
      for (std::size_t k = 0; k < blocks[b].size(); ++k) {
        const std::size_t value = part.values[blocks[b][k]];
        set_bounds(problem, data[b], static_cast<int>(k), lower_[value], upper_[value]);
      }
    }
  }

  bool any_own() const {
    return std::any_of(own_.begin(), own_.end(), [](const auto& own) { return !own.empty(); });
  }

  std::vector<double> values(std::span<const ResidualPart> parts) const {
    std::vector<double> out = all_;
    for (std::size_t r = 0; r < parts.size(); ++r) {
      std::size_t k = 0;
      for (const std::size_t value : parts[r].values) {
        if (is_free(value) && users_[value] == 1) out[value] = own_[r][k++];
      }
    }
    return out;
  }

 private:
  bool is_free(std::size_t value) const { return lower_[value] < upper_[value]; }

  std::vector<double> all_;
  std::span<const double> lower_, upper_;
  std::vector<int> users_;
  std::vector<std::vector<double>> own_;  // of each part
};

}  // namespace

Solution minimize(const Residuals& problem, std::span<const double> start, std::span<const double> lower,
                  std::span<const double> upper, const SolverOptions& options) {
  const QuietLogging quiet;
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (lower.empty() || lower[k] < upper[k]) free.push_back(k);
  }
  if (free.empty() || problem.count() < free.size()) return unsolved(problem, start, free.empty());

  Search end = search_from(problem, start, free, lower, upper, options);
  if (options.careful && (!end.found.converged || end.ran_away)) {
    SolverOptions cautious = options;
    cautious.trust_radius = 1e-4;
    Search retry = search_from(problem, start, free, lower, upper, cautious);
    if (retry.found.cost < end.found.cost) end = std::move(retry);
  }
  while (!end.held_back.empty() && end.held_back.size() < free.size()) {  // the others go on
    for (const std::size_t k : end.held_back) std::erase(free, k);
    Search next = search_from(problem, end.found.p, free, lower, upper, options);
    if (next.ran_away || !(next.found.cost <= end.found.cost)) break;
    end = std::move(next);
  }
  return std::move(end.found);
}

Solution minimize(std::span<const ResidualPart> parts, std::span<const double> start, std::span<const double> lower,
                  std::span<const double> upper, const SolverOptions& options) {
  const QuietLogging quiet;
  Blocks blocks(parts, start, lower, upper);
  ceres::Problem problem;
  auto order = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t r = 0; r < parts.size(); ++r) blocks.add(parts[r], r, problem, *order);
  if (problem.NumResidualBlocks() == 0) return {.p = {start.begin(), start.end()}, .message = "nothing to fit"};
  ceres::Solver::Options solver = ceres_options(options);
  solver.linear_solver_type = blocks.any_own() ? ceres::DENSE_SCHUR : ceres::DENSE_QR;
  if (blocks.any_own()) solver.linear_solver_ordering = order;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  stop_point();
  Solution out = solution_of(summary);
  out.p = blocks.values(parts);
  return out;
}

}  // namespace tribofit
