#include "tribofit/campaign/trends.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>

#include "conditions.hpp"
#include "limits.hpp"
#include "statistics/meta_regression.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Whether a line over a condition means anything: it takes two values, and where its scale is known they are further
/// apart than readings of one value.
bool varies(const ConditionColumn& column) {
  std::set<double> values;
  std::ranges::copy_if(column.number, std::inserter(values, values.end()), [](double x) { return !std::isnan(x); });
  if (values.size() < 2) return false;
  const double low = *values.begin(), high = *values.rbegin();
  return column.unit.empty() || high - low > kVaries * std::max(std::abs(low), std::abs(high));
}

/// omega r, by which the surfaces pass one another while the block sticks.
ConditionColumn sliding_speed(const std::vector<ConditionColumn>& columns, std::size_t runs) {
  ConditionColumn out{"sliding speed", "mm/s", {}, std::vector<double>(runs, std::nan(""))};
  const auto radius = std::ranges::find(columns, "radius", &ConditionColumn::name);
  const auto speed = std::ranges::find(columns, "speed", &ConditionColumn::name);
  if (radius == columns.end() || speed == columns.end()) return out;
  for (std::size_t r = 0; r < runs; ++r) out.number[r] = radius->number[r] * speed->number[r] * kRpm;
  return out;
}

/// Conditions that are numbers and take at least two values.
std::vector<ConditionColumn> numbers_of(std::span<const RunResult> runs) {
  std::vector<ConditionColumn> all = condition_columns(runs);
  all.push_back(sliding_speed(all, runs.size()));
  ConditionColumn order{"order", "", {}, {}};
  for (const RunResult& run : runs) order.number.push_back(run.order.value_or(std::nan("")));
  all.push_back(std::move(order));
  std::erase_if(all, [](const ConditionColumn& column) { return !varies(column); });
  return all;
}

/// Of the sizes of the numbers of a column.
double largest(const ConditionColumn& column) {
  double most = 0;
  for (const double number : column.number) most = std::max(most, std::isnan(number) ? 0 : std::abs(number));
  return most > 0 ? most : 1;
}

double correlation(const ConditionColumn& a, const ConditionColumn& b) {
  const double unit_a = largest(a), unit_b = largest(b);  // squares of the numbers themselves might overflow
  std::vector<double> both_a, both_b;
  for (std::size_t r = 0; r < a.number.size(); ++r) {
    if (std::isnan(a.number[r] + b.number[r])) continue;
    both_a.push_back(a.number[r] / unit_a);
    both_b.push_back(b.number[r] / unit_b);
  }
  const auto mean = [](const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  };
  const double mean_a = mean(both_a), mean_b = mean(both_b);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t r = 0; r < both_a.size(); ++r) {
    const double off_a = both_a[r] - mean_a, off_b = both_b[r] - mean_b;
    aa += off_a * off_a;
    bb += off_b * off_b;
    ab += off_a * off_b;
  }
  return both_a.size() > 2 && aa > 0 && bb > 0 ? ab / (std::sqrt(aa) * std::sqrt(bb)) : 0;
}

std::optional<Trend> trend_of(std::span<const RunResult> runs, const ResultFit& like, std::size_t parameter,
                              const ConditionColumn& column) {
  const double unit = largest(column);
  std::vector<double> x, y, variance;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const ResultFit* fit = runs[r].fit(like.law, like.protocol);
    if (fit == nullptr || parameter >= fit->parameters.size() || std::isnan(column.number[r])) continue;
    const ResultParameter& p = fit->parameters[parameter];
    if (p.name != like.parameters[parameter].name || !p.has_error()) continue;
    x.push_back(column.number[r] / unit);
    y.push_back(p.value);
    variance.push_back(p.std_error * p.std_error);
  }
  if (std::set<double>(x.begin(), x.end()).size() < kFewestValuesOfTrend || x.size() < 4) return std::nullopt;
  const auto n = static_cast<Index>(x.size());
  const Eigen::Map<const VectorXd> at(x.data(), n), value(y.data(), n), errors(variance.data(), n);
  Eigen::MatrixXd design = Eigen::MatrixXd::Ones(n, 2);
  const double middle = at.mean(), scale = std::sqrt((at.array() - middle).square().mean());
  design.col(1) = (at.array() - middle) / scale;
  const MetaRegression line = meta_regression(value, errors, design);
  const ResultParameter& p = like.parameters[parameter];
  Trend out{like.law, full_name(p.name, p.effect), p.unit, column.name, column.unit, x.size()};
  out.slope = line.coefficients(1) / scale / unit;
  const double error = std::sqrt(line.covariance(1, 1));
  out.std_error = error / scale / unit;
  const double half = t_quantile_95(line.degrees_of_freedom) * out.std_error;
  out.lower95 = out.slope - half;
  out.upper95 = out.slope + half;
  out.p_value = error > 0 ? t_p_value(line.coefficients(1) / error, line.degrees_of_freedom) : 1;
  return out;
}

/// Holm's step-down correction.
void correct(std::vector<Trend>& trends) {
  std::vector<std::size_t> by_p(trends.size());
  std::iota(by_p.begin(), by_p.end(), std::size_t(0));
  std::stable_sort(by_p.begin(), by_p.end(),
                   [&](std::size_t a, std::size_t b) { return trends[a].p_value < trends[b].p_value; });
  double largest = 0;
  for (std::size_t k = 0; k < by_p.size(); ++k) {
    largest = std::max(largest, trends[by_p[k]].p_value * static_cast<double>(by_p.size() - k));
    trends[by_p[k]].p_corrected = std::min(1.0, largest);
  }
}

std::string sentence(const Confounded& pair) {
  const bool order = pair.b == "order";
  const std::string both = fmt::format("{} and {} change together (correlation {}): ", pair.a,
                                       order ? "the order of the runs" : pair.b, fixed(pair.correlation, 2));
  if (order)
    return both + "wear or running-in may look like a trend over " + pair.a + "; make the runs in random order";
  return both + "a trend over one may be one over the other; " +
         (pair.b == "sliding speed" ? "run the same sliding speed at two radii" : "vary one while the other stays");
}

}  // namespace

Trends find_trends(std::span<const RunResult> runs) {
  Trends out;
  const std::vector<ConditionColumn> columns = numbers_of(runs);
  for (const ResultFit* law : joint_fits(runs)) {
    for (std::size_t p = 0; p < law->parameters.size(); ++p) {
      for (const ConditionColumn& column : columns) {
        if (auto trend = trend_of(runs, *law, p, column)) out.trends.push_back(std::move(*trend));
      }
    }
  }
  correct(out.trends);
  for (std::size_t a = 0; a < columns.size(); ++a) {
    for (std::size_t b = a + 1; b < columns.size(); ++b) {
      const double r = correlation(columns[a], columns[b]);
      if (std::abs(r) < kConfounded) continue;
      out.confounded.push_back({columns[a].name, columns[b].name, r});
      out.warnings.push_back(sentence(out.confounded.back()));
    }
  }
  const bool ordered = std::ranges::any_of(runs, [](const RunResult& run) { return run.order.has_value(); });
  if (!ordered && !out.trends.empty()) {
    out.warnings.push_back(
        "the order of the runs is not stated: wear may look like a trend; add a column 'order' or 'date' to the "
        "manifest");
  }
  return out;
}

std::string Trend::slope_unit() const {
  const std::string per = condition == "order" ? "run" : condition_unit, own = unit == "1" ? "" : unit;
  return per.empty() ? own : own + (own.empty() ? "per " : " per ") + per;
}

std::vector<Trend> significant_trends(const Trends& trends) {
  std::vector<Trend> out;
  for (const Trend& t : trends.trends) {
    const bool said = std::ranges::any_of(trends.confounded, [&](const Confounded& pair) {
      return pair.b == t.condition && std::abs(pair.correlation) > kSameCondition;
    });
    if (t.p_corrected <= kSignificant && !said) out.push_back(t);
  }
  return out;
}

}  // namespace tribofit
