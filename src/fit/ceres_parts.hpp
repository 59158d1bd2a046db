#pragma once

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <mutex>
#include <string>

#include "tribofit/fit/solver.hpp"
#include "tribofit/statistics/stop.hpp"

// How least squares are asked of Ceres.

namespace tribofit {

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

inline std::string explain(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
    case ceres::USER_SUCCESS:
      return "converged";
    case ceres::NO_CONVERGENCE:
      return "did not converge within " + std::to_string(summary.iterations.size()) + " iterations";
    default:
      return "the solver failed: " + summary.message;
  }
}

/// Ceres takes no exceptions. Work that is to stop is to it an evaluation that fails, after which it soon gives up;
/// then stop_point() throws.
inline bool evaluate_unless_stopped(const Residuals& problem, const double* p, double* residual, double* jacobian) {
  try {
    stop_point();
    return problem.evaluate(p, residual, jacobian);
  } catch (const Stopped&) {
    return false;
  }
}

inline ceres::Solver::Options ceres_options(const SolverOptions& options) {
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

}  // namespace tribofit
