#include "tribofit/study/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "limits.hpp"
#include "step_counter.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

std::vector<double> default_velocities(const Machine& machine, const CriticalSpeed& critical, std::size_t count) {
  const double own = machine.disc_velocity();
  double highest = 2 * own;
  const bool vanishes = !std::isnan(critical.stick_vanishes);
  if (vanishes) highest = std::max(highest, 1.2 * critical.stick_vanishes);
  for (const double v : critical.linear) {
    // A stability that is lost far beyond the last stick would leave most of the picture empty.
    if (!vanishes || v < kFarSpeed * critical.stick_vanishes) highest = std::max(highest, 1.2 * v);
  }
  return evenly_spaced(0.1 * own, highest, count, highest > 20 * own);
}

/// 2.5 % and 97.5 % quantile of the values that are not NaN. Both ends are NaN where there are none or more than a
/// tenth of `values` is NaN.
Interval interval95_of(std::vector<double> values) {
  const std::size_t all = values.size();
  std::erase_if(values, [](double x) { return std::isnan(x); });
  const double missing = static_cast<double>(all - values.size());
  if (values.empty() || missing > kMostMissing * static_cast<double>(all)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  std::sort(values.begin(), values.end());
  return {quantile_of_sorted(values, 0.025), quantile_of_sorted(values, 0.975)};
}

std::vector<std::string> default_variables(const Machine& machine) {
  std::vector<std::string> out = {"stiffness", "mass", "damping", "load", "velocity"};
  const bool two_levels = describe(machine.model.law()).two_levels;
  if (two_levels) out.emplace_back("ratio");
  for (std::size_t k = two_levels ? 2 : 0; k < machine.parameters.size(); ++k) {
    out.push_back(machine.model.parameters()[k].full_name());
  }
  // What is zero cannot be varied in proportion.
  std::erase_if(out, [&](const std::string& name) { return value_of(machine, name) == 0; });
  return out;
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

  const std::vector<Machine> draws = draws_of(machine, options.covariance, drawn, options.seed);
  std::vector<CriticalSpeed> criticals(draws.size());
  std::vector<Settled> settled(draws.size());
  CriticalSpeedOptions around = search;  // other machines are not far
  around.lowest =
      std::min(out.critical.lowest, out.critical.linear.empty() ? INFINITY : out.critical.linear.front() / kFarSpeed);
  around.highest = kFarSpeed * out.critical.highest;
  around.tolerance = 1e-4;
  run_tasks(draws.size(), options.threads, [&](std::size_t i) {
    criticals[i] = critical_speed(draws[i], around);
    settled[i] = settle(draws[i], options.settle);
    counter.step();
  });
  const auto over_draws = [&](const auto& list, const auto& number) {
    std::vector<double> values;
    for (const auto& one : list) values.push_back(number(one));
    return interval95_of(std::move(values));
  };
  out.linear_interval =
      over_draws(criticals, [](const CriticalSpeed& c) { return c.linear.empty() ? std::nan("") : c.linear.back(); });
  out.vanishes_interval = over_draws(criticals, [](const CriticalSpeed& c) { return c.stick_vanishes; });
  out.returns_interval = over_draws(criticals, [](const CriticalSpeed& c) { return c.stick_returns; });
  for (const MeasureInfo& measure : measures()) {
    out.own_intervals.push_back(over_draws(settled, [&](const Settled& s) { return s.*measure.value; }));
  }
  return out;
}

std::vector<Sensitivity> study_sensitivity(const Machine& machine, const SensitivityOptions& options) {
  if (!(options.factor > 1) || options.count < 2) {
    throw InputError("a sweep needs a factor above 1 and at least two values", "give e.g. a factor of 2 and 21 values");
  }
  std::vector<Sensitivity> out;
  const std::vector<std::string> names = options.variables.empty() ? default_variables(machine) : options.variables;
  StepCounter counter(names.size() * (options.count + 2), options.progress);
  const auto step = [&] { counter.step(); };
  for (const std::string& name : names) {
    Sensitivity one;
    one.variable = variable_named(machine, name);
    one.base = value_of(machine, name);
    if (one.base == 0) {
      throw InputError("'" + name + "' is zero and cannot be varied in proportion", "give it a value first");
    }
    one.values = evenly_spaced(one.base / options.factor, one.base * options.factor, options.count, true);
    if (name == "ratio") std::erase_if(one.values, [](double r) { return r > 1; });
    one.settled = sweep(machine, name, one.values, options.settle, options.threads, step);
    constexpr double kStep = 0.01;
    const std::vector<double> beside = {one.base / (1 + kStep), one.base * (1 + kStep)};
    const std::vector<Settled> at = sweep(machine, name, beside, options.settle, options.threads, step);
    for (const MeasureInfo& measure : measures()) {
      const double below = at[0].*measure.value, above = at[1].*measure.value;
      const bool comparable = at[0].regime == at[1].regime && below > 0 && above > 0;
      one.elasticities.push_back(comparable ? std::log(above / below) / (2 * std::log1p(kStep))
                                            : std::numeric_limits<double>::quiet_NaN());
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<std::size_t> ranked(const std::vector<Sensitivity>& all, std::size_t measure) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto size = [&](std::size_t i) {
    const double e = std::abs(all[i].elasticities[measure]);
    return std::isnan(e) ? -1 : e;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  return order;
}

}  // namespace tribofit
