#include "tribofit/campaign/pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "conditions.hpp"
#include "limits.hpp"
#include "statistics/meta_regression.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/campaign/compare.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// As stated beforehand, without what only says when the run was made.
ManifestRow stated(const RunResult& run) {
  ManifestRow row;
  row.conditions = run.run.conditions;
  row.others = run.run.others;
  std::erase_if(row.others, [](const OtherCondition& other) { return tells_order(other.name); });
  return row;
}

PooledGroup::OfFit pool_fits(std::span<const RunResult> runs, const std::vector<std::size_t>& members,
                             const ResultFit& like) {
  PooledGroup::OfFit out{like.law, like.protocol, {}, 0};
  for (std::size_t p = 0; p < like.parameters.size(); ++p) {
    const ResultParameter& parameter = like.parameters[p];
    std::vector<RunValue> values;
    const ResultParameter* last = nullptr;
    for (const std::size_t r : members) {
      const ResultFit* fit = runs[r].fit(like.law, like.protocol);
      if (fit == nullptr || p >= fit->parameters.size() || fit->parameters[p].name != parameter.name) continue;
      const ResultParameter& q = fit->parameters[p];
      values.push_back({q.value, q.has_error() ? q.std_error : kNaN, q.systematic, fit->degrees_of_freedom});
      if (q.has_error() && std::isfinite(q.value)) last = &q;
    }
    PooledValue& value = out.parameters.emplace_back(pool(parameter.name, parameter.unit, values));
    value.effect = parameter.effect;
    if (value.runs != 1 || last == nullptr) continue;
    value.lower95 = last->lower95;  // of the one run, with its own degrees of freedom
    value.upper95 = last->upper95;
  }
  out.best_in = static_cast<std::size_t>(std::ranges::count_if(members, [&](std::size_t r) {
    const RunResult& run = runs[r];
    return run.best < run.fits.size() && run.fits[run.best].law == like.law &&
           run.fits[run.best].protocol == like.protocol;
  }));
  return out;
}

std::vector<PooledValue> pool_measures(std::span<const RunResult> runs, const std::vector<std::size_t>& members) {
  struct Measure {
    const char *name, *unit;
    Estimate RunResult::*value;
  };
  std::vector<PooledValue> out;
  for (const Measure& measure :
       {Measure{"frequency", "Hz", &RunResult::frequency}, Measure{"amplitude", "mm/s", &RunResult::amplitude},
        Measure{"stick_time", "s", &RunResult::stick_time}, Measure{"slip_time", "s", &RunResult::slip_time}}) {
    std::vector<RunValue> values;
    for (const std::size_t r : members) {
      const Estimate& estimate = runs[r].*measure.value;
      values.push_back({estimate.value, estimate.std_error, 0, std::max(1.0, static_cast<double>(runs[r].cycles) - 1)});
    }
    out.push_back(pool(measure.name, measure.unit, values));
  }
  std::vector<RunValue> rms;  // its error is not known from one run: what runs differ by says all
  for (const std::size_t r : members)
    rms.push_back({runs[r].rms_velocity, runs[r].rms_velocity > 0 ? 1e-9 * runs[r].rms_velocity : kNaN});
  PooledValue& value = out.emplace_back(pool("rms_velocity", "mm/s", rms));
  if (value.runs < 2) value.std_error = value.lower95 = value.upper95 = kNaN;
  value.statistical = kNaN;
  return out;
}

const ResultParameter* level_of(const ResultFit& fit, std::string_view name) {
  const auto found = std::ranges::find_if(fit.parameters,
                                          [&](const ResultParameter& p) { return p.name == name && p.effect.empty(); });
  return found == fit.parameters.end() ? nullptr : &*found;
}

/// Values of a condition that differ by more than what a reading off a plateau does.
std::size_t count_of_values(std::span<const PooledGroup> groups, Condition Conditions::*which) {
  std::vector<double> values;
  for (const PooledGroup& group : groups) {
    const double value = (group.conditions.*which).value;
    if (!std::isfinite(value)) return 0;
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  std::size_t count = values.empty() ? 0 : 1;
  for (std::size_t k = 1; k < values.size(); ++k)
    count += static_cast<std::size_t>(values[k] > (1 + kSameReading) * values[k - 1]);
  return count;
}

/// The conditions of a group without one; nor those that were read off the record.
std::string without(const PooledGroup& group, Condition Conditions::*which) {
  Conditions rest = group.conditions;
  rest.*which = {};
  if (rest.speed.source == "plateau") rest.speed = {};
  const bool any = rest.radius.known() || rest.speed.known() || rest.load.known() || !group.others.empty();
  return any ? conditions_text(rest, group.others) : "";
}

/// Variances of runs under the same conditions are alike, and a run of few cycles hardly knows its own: each is taken
/// together with their mean (G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004) 3, doi:10.2202/1544-6115.1027). The
/// run that happens to have the smallest would else have all the weight.
Eigen::VectorXd variances_of(std::span<const RunValue> runs, double freedom) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(runs.size()));
  double mean = 0;
  for (const RunValue& run : runs) mean += run.freedom / freedom * run.std_error * run.std_error;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double own = runs[i].freedom * runs[i].std_error * runs[i].std_error;
    out(static_cast<Eigen::Index>(i)) = (own + kFreedomOfRepeats * mean) / (runs[i].freedom + kFreedomOfRepeats);
  }
  return out;
}

}  // namespace

PooledValue pool(std::string name, std::string unit, std::vector<RunValue> runs) {
  PooledValue out;
  out.name = std::move(name);
  out.unit = std::move(unit);
  std::erase_if(runs, [](const RunValue& run) {
    return !std::isfinite(run.value) || !std::isfinite(run.std_error) || !(run.std_error > 0);
  });
  out.runs = runs.size();
  if (runs.empty()) {
    out.value = out.std_error = out.lower95 = out.upper95 = out.statistical = kNaN;
    out.between = out.mean = out.standard_error_of_mean = kNaN;
    return out;
  }
  const auto n = static_cast<Eigen::Index>(runs.size());
  Eigen::VectorXd y(n);
  double freedom = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const RunValue& run = runs[static_cast<std::size_t>(i)];
    y(i) = run.value;
    freedom += run.freedom;
    out.systematic += run.systematic / static_cast<double>(n);  // shared by the runs, so their mean has it in full
  }
  const MetaRegression mean = meta_regression(y, variances_of(runs, freedom), Eigen::MatrixXd::Ones(n, 1));
  out.value = mean.coefficients(0);
  out.statistical = mean.statistical(0);
  out.std_error = std::max(std::sqrt(mean.covariance(0, 0)), out.statistical);
  out.between = n > 1 ? mean.between : kNaN;
  double half = t_quantile_95(freedom) * out.statistical;
  if (n > 1) half = std::max(half, t_quantile_95(mean.degrees_of_freedom) * std::sqrt(mean.covariance(0, 0)));
  out.lower95 = out.value - half;
  out.upper95 = out.value + half;
  const Estimate plain = mean_of_independent({y.data(), runs.size()});
  out.mean = plain.value;
  out.standard_error_of_mean = plain.std_error;
  return out;
}

std::vector<PooledGroup> pool_repeats(std::span<const RunResult> runs) {
  std::vector<PooledGroup> groups;
  std::vector<ManifestRow> keys;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (runs[r].run.status != RunStatus::ok || runs[r].fits.empty()) continue;
    ManifestRow key = stated(runs[r]);
    std::size_t g = 0;
    while (g < keys.size() && !same_conditions(keys[g], key)) ++g;
    if (g == keys.size()) {
      groups.push_back({runs[r].conditions, key.others, {}, {}, {}});
      keys.push_back(std::move(key));
    }
    groups[g].runs.push_back(r);
  }
  for (PooledGroup& group : groups) {
    for (const std::size_t r : group.runs) {
      for (const ResultFit& fit : runs[r].fits) {
        if (fit.parameters.empty() || group.fit(fit.law, fit.protocol) != nullptr) continue;
        group.fits.push_back(pool_fits(runs, group.runs, fit));
      }
    }
    group.measures = pool_measures(runs, group.runs);
  }
  return groups;
}

const PooledGroup::OfFit* PooledGroup::fit(std::string_view law, std::string_view protocol) const {
  const auto found = std::ranges::find_if(fits, [&](const OfFit& f) { return f.law == law && f.protocol == protocol; });
  return found == fits.end() ? nullptr : &*found;
}

const PooledValue* pooled_value(const std::vector<PooledValue>& values, std::string_view name) {
  const auto found =
      std::ranges::find_if(values, [&](const PooledValue& v) { return v.name == name && v.effect.empty(); });
  return found == values.end() ? nullptr : &*found;
}

std::optional<Estimate> pooled_mean(const std::vector<PooledValue>& values, std::string_view name) {
  const PooledValue* value = pooled_value(values, name);
  if (value == nullptr) return std::nullopt;
  return Estimate{value->mean, value->standard_error_of_mean};
}

Estimate drop_of(std::span<const RunResult> runs, const PooledGroup& group, const PooledGroup::OfFit& pooled) {
  std::vector<double> drops;
  for (const std::size_t k : group.runs) {
    const ResultFit* fit = runs[k].fit(pooled.law, pooled.protocol);
    if (fit == nullptr) continue;
    const ResultParameter *mu_s = level_of(*fit, static_level_name), *mu_k = level_of(*fit, kinetic_level_name);
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

std::vector<std::pair<std::string, std::string>> kinds_of_levels(std::span<const PooledGroup> groups) {
  std::vector<std::pair<std::string, std::string>> kinds;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      const bool published = fit.protocol == to_string(Protocol::published);
      const auto same = [&](const auto& k) { return k.second == fit.protocol && (published || k.first == fit.law); };
      if (std::ranges::none_of(kinds, same)) kinds.emplace_back(fit.law, fit.protocol);
    }
  }
  return kinds;
}

std::vector<OtherParameter> other_parameters(std::span<const PooledGroup> groups) {
  std::vector<OtherParameter> out;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& v : fit.parameters) {
        const auto same = [&](const OtherParameter& other) { return other.law == fit.law && other.name == v.name; };
        const bool is_level = v.name == static_level_name || v.name == kinetic_level_name;
        if (!is_level && v.effect.empty() && std::ranges::none_of(out, same)) out.push_back({fit.law, v.name, v.unit});
      }
    }
  }
  return out;
}

OverConditions::OverConditions(std::span<const PooledGroup> groups) {
  std::size_t most = 1;
  const ConditionInfo* most_varied = nullptr;
  for (const ConditionInfo& condition : condition_infos) {
    const std::size_t count = count_of_values(groups, condition.member);
    if (count > most) most = count, most_varied = &condition;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    x.push_back(most_varied != nullptr ? (groups[g].conditions.*(most_varied->member)).value / most_varied->si
                                       : static_cast<double>(g));
    const std::string name = most_varied != nullptr ? without(groups[g], most_varied->member) : "";
    auto found = std::find_if(series.begin(), series.end(), [&](const Series& s) { return s.name == name; });
    if (found == series.end()) found = series.insert(series.end(), {name, {}, {}});
    found->groups.push_back(g);
  }
  for (Series& one : series) {
    std::stable_sort(one.groups.begin(), one.groups.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    for (const std::size_t g : one.groups) one.x.push_back(x[g]);
  }
  if (most_varied != nullptr) {
    quantity = most_varied->meaning;
    unit = most_varied->unit;
    return;
  }
  for (const PooledGroup& group : groups) names.push_back(conditions_text(group));
}

std::vector<std::size_t> OverConditions::some(std::size_t most) const {
  std::vector<std::size_t> all, out;
  for (const Series& one : series) all.insert(all.end(), one.groups.begin(), one.groups.end());
  for (const std::size_t k : thinned(all.size(), most)) out.push_back(all[k]);
  return out;
}

}  // namespace tribofit
