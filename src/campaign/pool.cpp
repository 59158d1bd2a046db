#include "tribofit/campaign/pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "order.hpp"
#include "statistics/meta_regression.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// As stated beforehand, without what only says when the run was made.
ManifestRow stated(const RunResult& run) {
  ManifestRow row;
  row.conditions = run.run.conditions;
  for (const OtherCondition& other : run.run.others) {
    if (!tells_order(other.name)) row.others.push_back(other);
  }
  return row;
}

/// Columns of values and errors of one quantity over runs.
struct Column {
  std::vector<double> values, std_errors, systematic;
  void add(double value, double std_error, double of_instruments = 0) {
    values.push_back(value);
    std_errors.push_back(std_error);
    systematic.push_back(of_instruments);
  }
};

PooledGroup::OfFit pool_fits(std::span<const RunResult> runs, const std::vector<std::size_t>& members,
                             const ResultFit& like) {
  PooledGroup::OfFit out{like.law, like.protocol, {}, 0};
  for (std::size_t p = 0; p < like.parameters.size(); ++p) {
    const ResultParameter& parameter = like.parameters[p];
    Column column;
    for (const std::size_t r : members) {
      const ResultFit* fit = runs[r].fit(like.law, like.protocol);
      if (fit == nullptr || p >= fit->parameters.size() || fit->parameters[p].name != parameter.name) continue;
      const ResultParameter& q = fit->parameters[p];
      column.add(q.value, q.at_bound ? kNaN : q.std_error, q.systematic);
    }
    out.parameters.push_back(pool(parameter.name, parameter.unit, column.values, column.std_errors, column.systematic));
    PooledValue& value = out.parameters.back();
    value.effect = parameter.effect;
    if (value.runs != 1) continue;
    for (const std::size_t r : members) {  // the interval of the one run, with its own degrees of freedom
      const ResultFit* fit = runs[r].fit(like.law, like.protocol);
      if (fit == nullptr || p >= fit->parameters.size() || fit->parameters[p].value != value.mean) continue;
      value.lower95 = fit->parameters[p].lower95;
      value.upper95 = fit->parameters[p].upper95;
    }
  }
  for (const std::size_t r : members) {
    const RunResult& run = runs[r];
    const bool best = run.best < run.fits.size() && run.fits[run.best].law == like.law &&
                      run.fits[run.best].protocol == like.protocol;
    out.best_in += best ? 1 : 0;
  }
  return out;
}

std::vector<PooledValue> pool_measures(std::span<const RunResult> runs, const std::vector<std::size_t>& members) {
  Column frequency, amplitude, stick_time, slip_time, rms;
  for (const std::size_t r : members) {
    const RunResult& run = runs[r];
    frequency.add(run.frequency.value, run.frequency.std_error);
    amplitude.add(run.amplitude.value, run.amplitude.std_error);
    stick_time.add(run.stick_time.value, run.stick_time.std_error);
    slip_time.add(run.slip_time.value, run.slip_time.std_error);
    // Its error is not known from one run: what runs differ by says all.
    rms.add(run.rms_velocity, run.rms_velocity > 0 ? 1e-9 * run.rms_velocity : kNaN);
  }
  const auto all = [](const char* name, const char* unit, const Column& column) {
    return pool(name, unit, column.values, column.std_errors);
  };
  PooledValue rms_velocity = all("rms_velocity", "mm/s", rms);
  if (rms_velocity.runs < 2) rms_velocity.std_error = rms_velocity.lower95 = rms_velocity.upper95 = kNaN;
  rms_velocity.statistical = kNaN;
  return {all("frequency", "Hz", frequency), all("amplitude", "mm/s", amplitude), all("stick_time", "s", stick_time),
          all("slip_time", "s", slip_time), std::move(rms_velocity)};
}

}  // namespace

PooledValue pool(std::string name, std::string unit, std::span<const double> values, std::span<const double> std_errors,
                 std::span<const double> systematic) {
  PooledValue out;
  out.name = std::move(name);
  out.unit = std::move(unit);
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(values[k]) && std::isfinite(std_errors[k]) && std_errors[k] > 0) known.push_back(k);
  }
  out.runs = known.size();
  if (known.empty()) {
    out.value = out.std_error = out.lower95 = out.upper95 = out.statistical = kNaN;
    out.between = out.mean = out.standard_error_of_mean = kNaN;
    return out;
  }
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::VectorXd y(n), variance(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = known[static_cast<std::size_t>(i)];
    y(i) = values[k];
    variance(i) = std_errors[k] * std_errors[k];
    // Shared by the runs, so their mean has it in full.
    if (!systematic.empty()) out.systematic += systematic[k] / static_cast<double>(n);
  }
  const MetaRegression mean = meta_regression(y, variance, Eigen::MatrixXd::Ones(n, 1));
  out.value = mean.coefficients(0);
  out.std_error = std::sqrt(mean.covariance(0, 0));
  out.statistical = mean.statistical(0);
  out.between = n > 1 ? mean.between : kNaN;
  const double half = (n > 1 ? t_quantile_95(mean.degrees_of_freedom) : kNormalQuantile95) * out.std_error;
  out.lower95 = out.value - half;
  out.upper95 = out.value + half;
  const Estimate plain = mean_of_independent({y.data(), known.size()});
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
        const auto same = [&](const PooledGroup::OfFit& f) { return f.law == fit.law && f.protocol == fit.protocol; };
        if (fit.parameters.empty() || std::any_of(group.fits.begin(), group.fits.end(), same)) continue;
        group.fits.push_back(pool_fits(runs, group.runs, fit));
      }
    }
    group.measures = pool_measures(runs, group.runs);
  }
  return groups;
}

}  // namespace tribofit
