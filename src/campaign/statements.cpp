#include "tribofit/campaign/pooled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "statistics/reductions.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

/// ln(held-out error of `second` over that of `first`), joint protocol; nothing where either is not known.
std::optional<double> advantage(const RunResult& run, const std::string& first, const std::string& second) {
  const ResultFit *a = run.fit(first, to_string(Protocol::joint)), *b = run.fit(second, to_string(Protocol::joint));
  if (a == nullptr || b == nullptr || !(a->error.held_out_rmse > 0) || !(b->error.held_out_rmse > 0)) return std::nullopt;
  return std::log(b->error.held_out_rmse / a->error.held_out_rmse);
}

/// Two-sided p-value of the mean over all runs against the scatter of repeats: the conditions are those that were
/// chosen, and the advantage may differ between them (Welch and Satterthwaite). Conditions of which there is one run
/// only are taken as repeats of each other, or of all where there is one.
double p_value_of(const std::vector<std::vector<double>>& conditions, const std::vector<double>& all) {
  std::vector<std::vector<double>> strata;
  std::vector<double> single;
  for (const std::vector<double>& values : conditions) {
    if (values.size() > 1) strata.push_back(values);
    if (values.size() == 1) single.push_back(values.front());
  }
  if (single.size() > 1) strata.push_back(single);
  if (single.size() == 1) strata = {all};
  double total = 0, over_freedom = 0;  // variance of the sum; its square over its degrees of freedom
  for (const std::vector<double>& values : strata) {
    const double n = static_cast<double>(values.size()), mean = mean_of(values);
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double variance = n * squares / (n - 1);
    total += variance;
    over_freedom += variance * variance / (n - 1);
  }
  const double sum = mean_of(all) * static_cast<double>(all.size());
  if (!(total > 0)) return sum == 0 ? 1 : 0;
  return t_p_value(sum / std::sqrt(total), total * total / over_freedom);
}

LawPreference preference_of(const std::vector<std::vector<double>>& conditions, const std::string& first,
                            const std::string& second) {
  std::vector<double> advantages;
  for (const auto& values : conditions) advantages.insert(advantages.end(), values.begin(), values.end());
  LawPreference out;
  out.runs = advantages.size();
  out.p_value = std::numeric_limits<double>::quiet_NaN();
  if (advantages.empty()) return out;
  const double mean = mean_of(advantages);
  const bool first_better = mean >= 0;
  out.better = first_better ? first : second;
  out.other = first_better ? second : first;
  out.better_in = static_cast<std::size_t>(
      std::count_if(advantages.begin(), advantages.end(), [&](double a) { return first_better ? a > 0 : a < 0; }));
  out.ratio = std::exp(std::abs(mean));
  if (out.runs > 1) out.p_value = p_value_of(conditions, advantages);
  return out;
}

void add_preferences(std::span<const RunResult> runs, std::span<const PooledGroup> groups, Statements& out) {
  std::vector<std::string> laws;
  for (const ResultFit* fit : joint_fits(runs)) {
    const std::optional<Law> law = find_law(fit->law);
    if (!law || !constant_in_slip(*law)) laws.push_back(fit->law);
  }
  if (laws.size() != 2) return;
  std::vector<std::vector<double>> all;
  for (const PooledGroup& group : groups) {
    std::vector<double> own;
    for (const std::size_t k : group.runs) {
      if (const auto a = advantage(runs[k], laws[0], laws[1])) own.push_back(*a);
    }
    out.preference.push_back(preference_of({own}, laws[0], laws[1]));
    all.push_back(std::move(own));
  }
  out.overall = preference_of(all, laws[0], laws[1]);
}

/// Sums over the runs of a group: each mean times what it is one over.
struct ErrorSums {
  ErrorStatement sum;
  double samples = 0, bins = 0;
};

void add_run(const RunFigures& figures, std::size_t group, std::vector<ErrorSums>& sums) {
  const double samples = static_cast<double>(figures.slip_samples());
  const double bins = static_cast<double>(std::ranges::count_if(figures.bin_samples, [](auto n) { return n > 0; }));
  for (const ErrorCurve& curve : figures.errors) {
    auto at = std::ranges::find_if(
        sums, [&](const ErrorSums& s) { return s.sum.law == curve.law && s.sum.protocol == curve.protocol; });
    if (at == sums.end()) at = sums.insert(at, ErrorSums{{{curve.law, curve.protocol}, group}});
    ErrorStatement& sum = at->sum;
    at->samples += samples;
    at->bins += bins;
    ++sum.runs;
    sum.below_limit += samples * curve.below_limit;
    sum.mean_relative += samples * curve.mean_relative;
    sum.bins_below_limit += bins * curve.bins_below_limit;
    sum.largest_of_bins = std::max(sum.largest_of_bins, curve.largest_of_bins);
    sum.max_relative = std::max(sum.max_relative, curve.max_relative);
  }
}

}  // namespace

Statements statements_of(const ResultReader& results, std::span<const RunResult> runs,
                         std::span<const PooledGroup> groups) {
  Statements out;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<ErrorSums> sums;
    for (const std::size_t k : groups[g].runs) {
      if (const auto figures = results.figures(runs[k].position)) add_run(*figures, g, sums);
    }
    for (ErrorSums& s : sums) {
      s.sum.below_limit /= s.samples;
      s.sum.mean_relative /= s.samples;
      s.sum.bins_below_limit /= s.bins;
      out.errors.push_back(std::move(s.sum));
    }
  }
  add_preferences(runs, groups, out);
  return out;
}

}  // namespace tribofit
