#include "tribofit/study/sweep.hpp"
#include "limits.hpp"

#include <algorithm>
#include <cmath>

#include "step_counter.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"

namespace tribofit {

namespace {

std::vector<double> default_velocities(const Machine& machine, const CriticalSpeed& critical, std::size_t count) {
  const double own = machine.disc_velocity();
  double highest = 2 * own;
  const bool vanishes = !std::isnan(critical.stick_vanishes);
  if (vanishes) highest = std::max(highest, 1.2 * critical.stick_vanishes);
  for (const double v : critical.linear) {
    // A stability that is lost far beyond the last stick would leave most of the picture empty.
    if (!vanishes || v < kFarBeyondStick * critical.stick_vanishes) highest = std::max(highest, 1.2 * v);
  }
  return evenly_spaced(0.1 * own, highest, count, highest > 20 * own);
}

double last_or_nan(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values.back();
}

}  // namespace

std::vector<double> evenly_spaced(double low, double high, std::size_t count, bool logarithmic) {
  std::vector<double> out(count, low);
  for (std::size_t i = 1; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    out[i] = logarithmic ? low * std::pow(high / low, part) : low + part * (high - low);
  }
  if (count > 1) out.back() = high;
  return out;
}

std::vector<Settled> sweep(const Machine& machine, std::string_view variable, std::span<const double> values,
                           const SettleOptions& options, int threads, const std::function<void()>& done) {
  std::vector<Settled> out(values.size());
  run_tasks(values.size(), threads, [&](std::size_t i) {
    out[i] = settle(with_value(machine, variable, values[i]), options);
    if (done) done();
  });
  return out;
}

SpeedStudy study_speed(const Machine& machine, const SpeedStudyOptions& options) {
  SpeedStudy out;
  out.own = settle(machine, options.settle);
  CriticalSpeedOptions search;
  search.sharpness = options.settle.sharpness;
  out.critical = critical_speed(machine, search);
  out.velocity =
      options.velocity.empty() ? default_velocities(machine, out.critical, options.points) : options.velocity;
  SettleOptions up = options.settle, down = options.settle;
  up.start = StartFrom::stick;
  down.start = StartFrom::sliding;
  const std::size_t drawn = options.covariance.empty() ? 0 : options.draws;
  StepCounter counter(2 * out.velocity.size() + drawn, options.progress);
  const auto step = [&] { counter.step(); };
  out.up = sweep(machine, "velocity", out.velocity, up, options.threads, step);
  out.down = sweep(machine, "velocity", out.velocity, down, options.threads, step);
  for (const double v : out.velocity) {
    out.growth_rate.push_back(steady_sliding(with_value(machine, "velocity", v)).growth_rate());
  }

  const std::vector<Machine> draws = options.covariance.empty()
                                         ? std::vector<Machine>{}
                                         : draws_of(machine, options.covariance, options.draws, options.seed);
  std::vector<CriticalSpeed> criticals(draws.size());
  std::vector<Settled> settled(draws.size());
  CriticalSpeedOptions around = search;  // other machines are not far
  around.lowest =
      std::min(out.critical.lowest, out.critical.linear.empty() ? INFINITY : out.critical.linear.front() / kFarMachine);
  around.highest = kFarMachine * out.critical.highest;
  around.tolerance = 1e-4;
  run_tasks(draws.size(), options.threads, [&](std::size_t i) {
    criticals[i] = critical_speed(draws[i], around);
    settled[i] = settle(draws[i], options.settle);
    counter.step();
  });
  const auto over_draws = [&](const auto& list, const auto& number) {
    std::vector<double> values;
    values.reserve(list.size());
    for (const auto& one : list) values.push_back(number(one));
    return interval95_of(std::move(values));
  };
  out.linear_interval = over_draws(criticals, [](const CriticalSpeed& c) { return last_or_nan(c.linear); });
  out.vanishes_interval = over_draws(criticals, [](const CriticalSpeed& c) { return c.stick_vanishes; });
  out.returns_interval = over_draws(criticals, [](const CriticalSpeed& c) { return c.stick_returns; });
  for (const MeasureInfo& measure : measures()) {
    out.own_intervals.push_back(over_draws(settled, [&](const Settled& s) { return s.*measure.value; }));
  }
  return out;
}

}  // namespace tribofit
