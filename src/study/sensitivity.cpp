#include "tribofit/study/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "step_counter.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/study/sweep.hpp"

namespace tribofit {

namespace {

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
