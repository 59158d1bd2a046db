#include "tribofit/campaign/group_values.hpp"

#include <algorithm>
#include <cmath>

#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

const PooledValue* pooled_value(const std::vector<PooledValue>& values, std::string_view name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const PooledValue& v) { return v.name == name && v.effect.empty(); });
  return found == values.end() ? nullptr : &*found;
}

std::optional<Estimate> pooled_mean(const std::vector<PooledValue>& values, std::string_view name) {
  const PooledValue* value = pooled_value(values, name);
  if (value == nullptr) return std::nullopt;
  return Estimate{value->mean, value->standard_error_of_mean};
}

const PooledGroup::OfFit* fit_of(const PooledGroup& group, std::string_view law, std::string_view protocol) {
  const auto found = std::find_if(group.fits.begin(), group.fits.end(),
                                  [&](const auto& fit) { return fit.law == law && fit.protocol == protocol; });
  return found == group.fits.end() ? nullptr : &*found;
}

Estimate drop_of(std::span<const RunResult> runs, const PooledGroup& group, const PooledGroup::OfFit& pooled) {
  std::vector<double> drops;
  const auto level = [](const ResultFit& fit, std::string_view name) -> const ResultParameter* {
    const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                    [&](const ResultParameter& p) { return p.name == name && p.effect.empty(); });
    return found == fit.parameters.end() ? nullptr : &*found;
  };
  for (const std::size_t k : group.runs) {
    const ResultFit* fit = runs[k].fit(pooled.law, pooled.protocol);
    if (fit == nullptr) continue;
    const ResultParameter *mu_s = level(*fit, static_level_name), *mu_k = level(*fit, kinetic_level_name);
    if (mu_s != nullptr && mu_k != nullptr) drops.push_back(mu_s->value - mu_k->value);
  }
  return mean_of_independent(drops);
}

std::optional<Estimate> fundamental_of(const ResultReader& results, std::span<const RunResult> runs,
                                       const PooledGroup& group) {
  std::vector<double> values;
  for (const std::size_t k : group.runs) {
    const auto figures = results.figures(runs[k].position);
    if (figures && !figures->harmonics.empty()) values.push_back(figures->harmonics.front().amplitude);
  }
  if (values.empty()) return std::nullopt;
  return mean_of_independent(values);
}

std::optional<FiguresOfRun> first_figures(const ResultReader& results, std::span<const RunResult> runs,
                                          const PooledGroup& group) {
  for (const std::size_t k : group.runs) {
    if (auto figures = results.figures(runs[k].position)) return FiguresOfRun{runs[k].run.name, std::move(*figures)};
  }
  return std::nullopt;
}

std::vector<std::string> joint_laws(std::span<const PooledGroup> groups) {
  std::vector<std::string> laws;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      const bool known = std::find(laws.begin(), laws.end(), fit.law) != laws.end();
      if (fit.protocol == to_string(Protocol::joint) && !known) laws.push_back(fit.law);
    }
  }
  return laws;
}

std::vector<std::pair<std::string, std::string>> kinds_of_levels(std::span<const PooledGroup> groups) {
  std::vector<std::pair<std::string, std::string>> kinds;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      const bool published = fit.protocol == to_string(Protocol::published);
      const auto same = [&](const auto& k) { return k.second == fit.protocol && (published || k.first == fit.law); };
      if (std::none_of(kinds.begin(), kinds.end(), same)) kinds.emplace_back(fit.law, fit.protocol);
    }
  }
  return kinds;
}

std::vector<OtherParameter> other_parameters(std::span<const PooledGroup> groups) {
  std::vector<OtherParameter> out;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& v : fit.parameters) {
        const bool known = std::any_of(out.begin(), out.end(), [&](const OtherParameter& other) {
          return other.law == fit.law && other.name == v.name;
        });
        const bool is_level = v.name == static_level_name || v.name == kinetic_level_name;
        if (!known && !is_level && v.effect.empty()) out.push_back({fit.law, v.name, v.unit});
      }
    }
  }
  return out;
}

}  // namespace tribofit
