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

void set_time(RateStateData& data, const Turn& turn, double time) {
  const double later = time - data.phases[turn.phase].begin;
  data.phases[turn.phase].begin = time;
  VelocityStep& step = data.steps[turn.step];
  if (turn.ends_hold) step.hold += later;
  if (!turn.ends_hold) step.time = time;
  if (!turn.ends_hold && step.hold > 0) step.hold -= later;
  data.set_phase_displacements();
  for (VelocityStep& s : data.steps) s.displacement = data.displacement_at(s.time);
  for (std::size_t i = 0; i < data.size(); ++i) data.displacement[i] = data.displacement_at(data.time[i]);
}

}  // namespace

std::vector<Turn> free_turns(const RateStateData& data) {
  std::vector<Turn> out;
  for (std::size_t s = 0; s < data.steps.size(); ++s) {
    if (!(data.steps[s].slack > 0)) continue;
    std::size_t phase = data.before[s] + 1;
    out.push_back({s, phase});
    if (!(data.steps[s].hold > 0)) continue;
    while (phase < data.phases.size() && data.phases[phase].speed == 0) ++phase;
    if (phase < data.phases.size()) out.push_back({s, phase, true});
  }
  return out;
}

Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, const Turn& turn) {
  const double at = problem.data().phases[turn.phase].begin;
  const double h = kPartOfInterval * problem.data().steps[turn.step].interval;
  std::array<Eigen::VectorXd, 2> friction;
  for (std::size_t side = 0; side < 2; ++side) {
    RateStateData moved = problem.data();
    set_time(moved, turn, at + (side == 0 ? -h : h));
    if (!problem.on(moved).response(p.data(), friction[side], nullptr)) return {};
  }
  Eigen::VectorXd out = (friction[1] - friction[0]) / (2 * h);
  for (std::size_t k = 0; k < problem.steps().size(); ++k) {
    if (problem.steps()[k] == turn.step) continue;
    for (std::size_t i = problem.row_of(k); i < problem.row_of(k + 1); ++i) out(static_cast<Eigen::Index>(i)) = 0;
  }
  return out;
}

double refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const RateStateUnknowns& unknowns, RateStateSolution& solution) {
  std::vector<std::size_t> all(data.steps.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Turn> free = free_turns(data);
  const std::vector<LoadPointPhase> stated = data.phases;
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
      const VelocityStep& step = data.steps[free[k].step];
      const double from = stated[free[k].phase].begin, now = data.phases[free[k].phase].begin;
      const double to =
          std::clamp(now + change(n + static_cast<Eigen::Index>(k)), from - step.slack, from + step.slack);
      moved = std::max(moved, std::abs(to - now) / step.interval);
      set_time(data, free[k], to);
    }
    solution = refine(RateStateProblem(data, evolution, states, detrend, all), solution.p, unknowns);
    if (moved < 0.02) break;
  }
  double largest = 0;
  for (const Turn& turn : free)
    largest = std::max(largest, std::abs(data.phases[turn.phase].begin - stated[turn.phase].begin));
  return largest;
}

}  // namespace tribofit::fit
