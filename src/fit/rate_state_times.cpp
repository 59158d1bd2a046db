#include "rate_state_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "statistics/linear_algebra.hpp"

namespace tribofit::fit {

namespace {

constexpr int kMostRounds = 8;
/// By which a step is moved to see what changes, over the sampling interval.
constexpr double kPartOfInterval = 0.02;
/// Of what is known of a time, beyond which it was held by it.
constexpr double kAtLimit = 0.999;

void set_time(RateStateData& data, const Turn& turn, double time) {
  const double later = time - data.phases[turn.first].begin;
  for (std::size_t i = turn.first; i <= turn.last; ++i) data.phases[i].begin += later;
  VelocityStep& step = data.steps[turn.step];
  if (turn.ends_hold) step.hold += later;
  if (!turn.ends_hold) step.time = time;
  if (!turn.ends_hold && step.hold > 0) step.hold -= later;
  data.set_phase_displacements();
  for (VelocityStep& s : data.steps) s.displacement = data.displacement_at(s.time);
  for (std::size_t i = 0; i < data.size(); ++i) data.displacement[i] = data.displacement_at(data.time[i]);
}

/// Between its neighbours, and within what is known of it.
double clamped(const RateStateData& data, const Turn& turn, double stated, double time) {
  const VelocityStep& step = data.steps[turn.step];
  const double passage = data.phases[turn.last].begin - data.phases[turn.first].begin;
  const double end = turn.last + 1 < data.phases.size() ? data.phases[turn.last + 1].begin : step.to;
  const double low = std::max(stated - step.slack, data.phases[turn.first - 1].begin + step.interval);
  const double high = std::min(stated + step.slack, end - passage - step.interval);
  return low < high ? std::clamp(time, low, high) : data.phases[turn.first].begin;
}

}  // namespace

std::vector<Turn> free_turns(const RateStateData& data) {
  std::vector<Turn> out;
  for (std::size_t s = 0; s < data.steps.size(); ++s) {
    const VelocityStep& step = data.steps[s];
    const std::size_t first = data.leaving[s];
    const std::size_t last = data.behind[s];
    if (!(step.slack > 0)) continue;
    std::size_t rest = first, on = last;
    while (rest < last && data.phases[rest].speed != 0) ++rest;
    while (on > first && data.phases[on - 1].speed != 0) --on;
    if (step.hold > 0 && rest < last) {
      out.push_back({s, first, rest, false});
      out.push_back({s, on, last, true});
    } else {
      out.push_back({s, first, last, false});
    }
  }
  return out;
}

Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, const Turn& turn) {
  const double at = problem.data().phases[turn.first].begin;
  const double h = kPartOfInterval * problem.data().steps[turn.step].interval;
  std::array<Eigen::VectorXd, 2> friction;
  for (std::size_t side = 0; side < 2; ++side) {
    RateStateData moved = problem.data();
    set_time(moved, turn, at + (side == 0 ? -h : h));
    if (!problem.with_data(moved).response(p.data(), friction[side], nullptr)) return {};
  }
  Eigen::VectorXd out = (friction[1] - friction[0]) / (2 * h);
  for (std::size_t k = 0; k < problem.steps().size(); ++k) {
    if (problem.steps()[k] == turn.step) continue;
    for (std::size_t i = problem.row_of(k); i < problem.row_of(k + 1); ++i) out(static_cast<Eigen::Index>(i)) = 0;
  }
  return out;
}

MovedSteps refine_step_times(RateStateData& data, const RateStateModel& model, const RateStateUnknowns& unknowns,
                             Solution& minimum) {
  std::vector<std::size_t> all(data.steps.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Turn> free = free_turns(data);
  const std::vector<LoadPointPhase> stated = data.phases;
  for (int round = 0; round < kMostRounds && !free.empty() && minimum.converged; ++round) {
    const RateStateProblem problem(data, model, all);
    const auto rows = static_cast<Eigen::Index>(problem.count()), n = static_cast<Eigen::Index>(minimum.p.size());
    Eigen::VectorXd residual(rows);
    RowMatrix jacobian(rows, n);
    if (!problem.evaluate(minimum.p.data(), residual.data(), jacobian.data())) break;
    Eigen::MatrixXd design(rows, n + static_cast<Eigen::Index>(free.size()));
    design.leftCols(n) = jacobian;
    RowMatrix by_times(rows, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::VectorXd column = response_by_time(problem, minimum.p, free[k]);
      if (column.size() == 0) return {};
      by_times.col(static_cast<Eigen::Index>(k)) = column;
    }
    problem.weigh(by_times);
    design.rightCols(by_times.cols()) = by_times;
    const Eigen::VectorXd scale = design.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    const Eigen::VectorXd change =
        scale.asDiagonal() * least_squares_of_any_rank(design * scale.asDiagonal(), -residual).x;
    double moved = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const double now = data.phases[free[k].first].begin;
      const double to =
          clamped(data, free[k], stated[free[k].first].begin, now + change(n + static_cast<Eigen::Index>(k)));
      moved = std::max(moved, std::abs(to - now) / data.steps[free[k].step].interval);
      set_time(data, free[k], to);
    }
    minimum = refine(RateStateProblem(data, model, all), minimum.p, unknowns);
    if (moved < 0.02) break;
  }
  MovedSteps out;
  for (const Turn& turn : free) {
    const VelocityStep& step = data.steps[turn.step];
    const double by = std::abs(data.phases[turn.first].begin - stated[turn.first].begin);
    out.largest = std::max(out.largest, by);
    if (by > kAtLimit * step.slack) out.at_limit.push_back(turn.step);
  }
  return out;
}

}  // namespace tribofit::fit
