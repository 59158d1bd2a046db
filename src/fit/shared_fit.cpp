#include "shared_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "observing.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

using sharing::Member;
using sharing::Problem;

Problem problem_of(const FrictionModel& model, std::span<const SharingRecord> records, const Bounds& bounds,
                   std::size_t common_count) {
  Problem out{model, common_count, {}, {}, {}};
  out.lower.resize(common_count);
  out.upper.resize(common_count);
  for (const SharingRecord& record : records) {
    Member& member = out.members.emplace_back(model, record);
    for (std::size_t k = 0; k < record.common.size(); ++k) {
      const bool own = record.common[k] == SharingRecord::kOwn;
      member.index.push_back(own ? out.lower.size() : record.common[k]);
      if (own) {
        out.lower.push_back(bounds.lower[k]);
        out.upper.push_back(bounds.upper[k]);
      } else {
        out.lower[record.common[k]] = bounds.lower[k];
        out.upper[record.common[k]] = bounds.upper[k];
      }
    }
  }
  return out;
}

/// The variance of a row, by what the fit of the record alone leaves: a record that does not fit in with the others
/// keeps its weight, so that it shows.
void weigh(const FrictionModel& model, Member& member) {
  constexpr double kLeast = 1e-9;  // of the largest friction: rounding
  const Observations& observations = *member.record.observations;
  member.whiten_at(member.record.values);
  double rows = 0;
  for (const auto& slip : observations.slips) rows += static_cast<double>(slip.end - slip.begin) + slip.from_stick;
  const double freedom = std::max(1.0, rows - static_cast<double>(model.parameters().size()));
  const double variance = member.residuals.white_squares(member.record.values.data()) / freedom;
  member.weight = 1 / std::max(variance, std::pow(kLeast * observations.largest_friction, 2));
}

/// Values of all records where the fits of single records are, common ones at their median.
std::vector<double> from_single_fits(const Problem& problem) {
  std::vector<double> out(problem.lower.size());
  std::vector<std::vector<double>> of_common(problem.common_count);
  for (const Member& member : problem.members) {
    for (std::size_t k = 0; k < member.index.size(); ++k) {
      const std::size_t at = member.index[k];
      if (at < problem.common_count) {
        of_common[at].push_back(member.record.values[k]);
      } else {
        out[at] = member.record.values[k];
      }
    }
  }
  for (std::size_t c = 0; c < problem.common_count; ++c) out[c] = median(std::move(of_common[c]));
  return out;
}

/// Where the search may begin: at the single fits, and at one law for all records from friction over the speeds of all
/// of them, which none of them may know.
std::vector<std::vector<double>> starts_of(const Problem& problem, const Bounds& bounds) {
  constexpr std::size_t kValuesOfRecord = 400;
  std::vector<Observations> parts;
  for (const Member& member : problem.members) {
    const Observations& observations = *member.record.observations;
    parts.push_back(reduced(observations, std::max<std::size_t>(1, observations.size() / kValuesOfRecord)));
  }
  const Observations all = join(std::move(parts));
  std::vector<std::vector<double>> out = {from_single_fits(problem)};
  for (const std::vector<double>& p : make_starts(problem.model, all, bounds, FitOptions().starts, 1)) {
    out.emplace_back(problem.lower.size());
    for (const Member& member : problem.members) {
      for (std::size_t k = 0; k < p.size(); ++k) out.back()[member.index[k]] = p[k];
    }
  }
  for (std::vector<double>& start : out) {
    for (std::size_t k = 0; k < start.size(); ++k) start[k] = std::clamp(start[k], problem.lower[k], problem.upper[k]);
  }
  return out;
}

Solution solve(const Problem& problem, const std::vector<double>& start, const SolverOptions& options) {
  std::vector<ResidualPart> parts;
  for (const Member& member : problem.members)
    parts.push_back({&member.residuals, std::sqrt(member.weight), member.index});
  return minimize(parts, start, problem.lower, problem.upper, options);
}

/// Where the best of the starts leads, compared on a part of the slips.
std::vector<double> best_of_starts(const Problem& problem, const std::vector<std::vector<double>>& starts) {
  constexpr std::size_t kValues = 20000;
  const std::size_t values = std::max<std::size_t>(100, kValues / problem.members.size());
  std::deque<ModelResiduals> residuals;
  std::vector<ResidualPart> parts;
  for (const Member& member : problem.members) {
    const Observations& observations = *member.record.observations;
    residuals.emplace_back(problem.model, observations, some_slips(observations, values));
    parts.push_back({&residuals.back(), std::sqrt(member.weight), member.index});
  }
  Solution best;
  best.cost = std::numeric_limits<double>::infinity();
  best.p = starts.front();
  for (const std::vector<double>& start : starts) {
    Solution next = minimize(parts, start, problem.lower, problem.upper, kQuickSearch);
    if (next.cost < best.cost * (1 - 1e-6)) best = std::move(next);
  }
  return best.p;
}

/// Whitens every record at the values given. False where there is nothing to whiten in any of them.
bool whiten_at(Problem& problem, const std::vector<double>& values) {
  bool any = false;
  for (Member& member : problem.members) {
    member.whiten_at(problem.of_member(member, values));
    any |= member.whitening.any();
  }
  return any;
}

}  // namespace

RecordsFit fit_sharing_records(const FrictionModel& model, std::span<const SharingRecord> records, const Bounds& bounds,
                               std::size_t common_count) {
  Problem problem = problem_of(model, records, bounds, common_count);
  for (Member& member : problem.members) weigh(model, member);
  std::vector<double> values = best_of_starts(problem, starts_of(problem, bounds));
  for (int pass = 1; whiten_at(problem, values) && pass < kMostPasses; ++pass) {
    std::vector<double> next = solve(problem, values, kQuickSearch).p;
    const bool is_settled = pass >= kFewestPasses && are_alike(values, next);
    values = std::move(next);
    if (is_settled) break;
  }
  whiten_at(problem, values);
  Solution result = solve(problem, values, {.relative_cost = 1e-13});
  RecordsFit out;
  out.converged = result.converged;
  out.message = std::move(result.message);
  if (out.converged) add_errors(problem, result.p, out);
  return out;
}

}  // namespace tribofit
