#include "rate_state_times.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "statistics/linear_algebra.hpp"

namespace tribofit::fit {

namespace {

constexpr int kMostRounds = 8;
/// By which a step is moved to see what changes, over the sampling interval.
constexpr double kPartOfInterval = 0.02;

/// Phase that begins at a step.
std::size_t phase_behind(const RateStateData& data, std::size_t step) {
  return data.before[step] + 1;
}

void set_step_time(RateStateData& data, std::size_t step, double time) {
  const std::size_t phase = phase_behind(data, step);
  data.phases[phase].begin = time;
  data.steps[step].time = time;
  data.set_phase_displacements();
  for (VelocityStep& s : data.steps) s.displacement = data.displacement_at(s.time);
  for (std::size_t i = 0; i < data.size(); ++i) data.displacement[i] = data.displacement_at(data.time[i]);
}

}  // namespace

bool has_free_time(const VelocityStep& step) {
  return step.slack > 0 && step.hold == 0;
}

Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, std::size_t step) {
  const VelocityStep& at = problem.data().steps[step];
  const double h = kPartOfInterval * at.interval;
  std::array<Eigen::VectorXd, 2> friction;
  for (std::size_t side = 0; side < 2; ++side) {
    RateStateData moved = problem.data();
    set_step_time(moved, step, at.time + (side == 0 ? -h : h));
    if (!problem.on(moved).response(p.data(), friction[side], nullptr)) return {};
  }
  Eigen::VectorXd out = (friction[1] - friction[0]) / (2 * h);
  for (std::size_t k = 0; k < problem.steps().size(); ++k) {
    if (problem.steps()[k] == step) continue;
    for (std::size_t i = problem.row_of(k); i < problem.row_of(k + 1); ++i) out(static_cast<Eigen::Index>(i)) = 0;
  }
  return out;
}

double refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const RateStateUnknowns& unknowns, RateStateSolution& solution) {
  std::vector<std::size_t> all(data.steps.size()), free;
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const std::size_t s : all) {
    if (has_free_time(data.steps[s])) free.push_back(s);
  }
  std::vector<double> stated;
  for (const VelocityStep& step : data.steps) stated.push_back(step.time);
  for (int round = 0; round < kMostRounds && !free.empty() && solution.found; ++round) {
    const RateStateProblem problem(data, evolution, states, detrend, all);
    const auto rows = static_cast<Eigen::Index>(problem.count()), n = static_cast<Eigen::Index>(solution.p.size());
    Eigen::VectorXd residual(rows);
    RowMatrix jacobian(rows, n);
    if (!problem.evaluate(solution.p.data(), residual.data(), jacobian.data())) break;
    Eigen::MatrixXd design(rows, n + static_cast<Eigen::Index>(free.size()));
    design.leftCols(n) = jacobian;
    RowMatrix by_times(rows, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::VectorXd column = response_by_time(problem, solution.p, free[k]);
      if (column.size() == 0) return 0;
      by_times.col(static_cast<Eigen::Index>(k)) = column;
    }
    problem.weigh(by_times);
    design.rightCols(by_times.cols()) = by_times;
    const Eigen::VectorXd scale = design.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    const Eigen::VectorXd change =
        scale.asDiagonal() * least_squares_of_any_rank(design * scale.asDiagonal(), -residual).x;
    double moved = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const VelocityStep& step = data.steps[free[k]];
      const double from = stated[free[k]];
      const double to =
          std::clamp(step.time + change(n + static_cast<Eigen::Index>(k)), from - step.slack, from + step.slack);
      moved = std::max(moved, std::abs(to - step.time) / step.interval);
      set_step_time(data, free[k], to);
    }
    solution = refine(RateStateProblem(data, evolution, states, detrend, all), solution.p, unknowns);
    if (moved < 0.02) break;
  }
  double largest = 0;
  for (const std::size_t s : all) largest = std::max(largest, std::abs(data.steps[s].time - stated[s]));
  return largest;
}

}  // namespace tribofit::fit
