#include "rate_state_times.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "statistics/linear_algebra.hpp"

namespace tribofit::fit {

namespace {

constexpr int kMostRounds = 8;

/// Phase that begins at a step.
std::size_t phase_behind(const RateStateData& data, std::size_t step) {
  return data.before[step] + 1;
}

void set_step_time(RateStateData& data, std::size_t step, double time) {
  const std::size_t phase = phase_behind(data, step);
  data.phases[phase].begin = time;
  data.steps[step].time = time;
  for (std::size_t i = 1; i < data.phases.size(); ++i) {
    const LoadPointPhase& before = data.phases[i - 1];
    data.phase_displacement[i] = data.phase_displacement[i - 1] + before.speed * (data.phases[i].begin - before.begin);
  }
  for (VelocityStep& s : data.steps) s.displacement = data.displacement_at(s.time);
  for (std::size_t i = 0; i < data.size(); ++i) data.displacement[i] = data.displacement_at(data.time[i]);
}

/// Change of the residuals of a step with its time: by a difference, its own rows alone.
Eigen::VectorXd by_time(const RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                        const std::vector<std::size_t>& all, const std::vector<double>& p, std::size_t step) {
  const double h = 0.02 * data.steps[step].interval;
  std::array<Eigen::VectorXd, 2> residual;
  for (std::size_t side = 0; side < 2; ++side) {
    RateStateData moved = data;
    set_step_time(moved, step, data.steps[step].time + (side == 0 ? -h : h));
    const RateStateProblem problem(moved, evolution, states, detrend, all);
    residual[side] = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.count()));
    if (!problem.evaluate(p.data(), residual[side].data(), nullptr)) return {};
  }
  Eigen::VectorXd out = (residual[1] - residual[0]) / (2 * h);
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (i < data.begins[step] || i >= data.end_of(step)) out(static_cast<Eigen::Index>(i)) = 0;
  }
  return out;
}

}  // namespace

double refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const RateStateUnknowns& unknowns, RateStateSolution& solution) {
  std::vector<std::size_t> all(data.steps.size()), free;
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const std::size_t s : all) {
    if (data.steps[s].slack > 0 && data.steps[s].hold == 0) free.push_back(s);
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
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::VectorXd column = by_time(data, evolution, states, detrend, all, solution.p, free[k]);
      if (column.size() == 0) return 0;
      design.col(n + static_cast<Eigen::Index>(k)) = column;
    }
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
