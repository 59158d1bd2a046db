#include "shared_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit_context.hpp"
#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

using sharing::Member;
using sharing::Problem;

/// Evenly spread slips of a record with about so many values.
std::vector<std::size_t> some_slips(const Observations& observations, std::size_t values) {
  const std::size_t every = std::max<std::size_t>(1, observations.size() / values);
  std::vector<std::size_t> slips;
  for (std::size_t k = 0; k < observations.slips.size(); k += every) slips.push_back(k);
  return slips;
}

/// A record of these slips alone, for what is looked up over speed.
Observations part_of(const Observations& all, const std::vector<std::size_t>& slips) {
  Observations out;
  for (const std::size_t s : slips) {
    Observations::SlipObservation slip = all.slips[s];
    const auto begin = static_cast<std::ptrdiff_t>(slip.begin), end = static_cast<std::ptrdiff_t>(slip.end);
    for (const auto channel : {&Observations::time, &Observations::velocity, &Observations::friction,
                               &Observations::weight, &Observations::root_weight, &Observations::velocity_variance}) {
      const std::vector<double>& from = all.*channel;
      if (!from.empty()) (out.*channel).insert((out.*channel).end(), from.begin() + begin, from.begin() + end);
    }
    slip.end = out.time.size();
    slip.begin = slip.end - static_cast<std::size_t>(end - begin);
    slip.cycle = out.cycles++;
    slip.earlier_begin = slip.earlier_end = slip.lead_begin = slip.lead_end = 0;
    slip.stick = Observations::npos;
    out.slips.push_back(slip);
  }
  out.mean_load = all.mean_load;
  out.fastest = all.fastest;
  out.slowest = all.slowest;
  out.largest_friction = all.largest_friction;
  out.friction_scale = all.friction_scale;
  out.noise = all.noise;
  return out;
}

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

double squares_of(const Residuals& residuals, const std::vector<double>& p) {
  std::vector<double> rows(residuals.count());
  if (!residuals.evaluate(p.data(), rows.data(), nullptr)) return std::numeric_limits<double>::infinity();
  double squares = 0;
  for (const double r : rows) squares += r * r;
  return squares;
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
  const double variance = squares_of(member.residuals, member.record.values) / freedom;
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
  constexpr int kStarts = 5;
  std::vector<Observations> parts;
  for (const Member& member : problem.members) {
    const Observations& observations = *member.record.observations;
    parts.push_back(part_of(observations, some_slips(observations, kValuesOfRecord)));
  }
  const Observations all = join(std::move(parts));
  std::vector<std::vector<double>> out = {from_single_fits(problem)};
  for (const std::vector<double>& p : make_starts(problem.model, all, bounds, kStarts, 1)) {
    out.emplace_back(problem.lower.size());
    for (const Member& member : problem.members) {
      for (std::size_t k = 0; k < p.size(); ++k) out.back()[member.index[k]] = p[k];
    }
  }
  for (std::vector<double>& start : out) {
    for (std::size_t k = 0; k < start.size(); ++k) {
      start[k] = std::clamp(start[k], problem.lower[k], problem.upper[k]);
    }
  }
  return out;
}

SolverResult solve(const Problem& problem, const std::vector<double>& start, const SolverOptions& options) {
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
  SolverResult best;
  best.cost = std::numeric_limits<double>::infinity();
  best.p = starts.front();
  for (const std::vector<double>& start : starts) {
    SolverResult next = minimize(parts, start, problem.lower, problem.upper, quick_search());
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
  constexpr int kFewestPasses = 3, kMostPasses = 20;  // of whitening, as a single fit has them
  Problem problem = problem_of(model, records, bounds, common_count);
  for (Member& member : problem.members) weigh(model, member);
  std::vector<double> values = best_of_starts(problem, starts_of(problem, bounds));
  for (int pass = 1; whiten_at(problem, values) && pass < kMostPasses; ++pass) {
    std::vector<double> next = solve(problem, values, quick_search()).p;
    const bool is_settled = pass >= kFewestPasses && are_alike(values, next);
    values = std::move(next);
    if (is_settled) break;
  }
  whiten_at(problem, values);
  SolverOptions careful;
  careful.relative_cost = 1e-13;
  SolverResult result = solve(problem, values, careful);
  RecordsFit out;
  out.converged = result.converged;
  out.message = std::move(result.message);
  if (out.converged) add_errors(problem, result.p, out);
  return out;
}

}  // namespace tribofit
