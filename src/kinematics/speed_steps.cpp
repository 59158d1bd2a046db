#include "speed_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "limits.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

using Runs = std::span<const StickPlateau>;

std::size_t middle_of(const StickPlateau& run) {
  return (run.begin + run.end) / 2;
}

double level_of(Runs runs) {
  std::vector<double> levels;
  for (const StickPlateau& run : runs) levels.push_back(run.level);
  return median(std::move(levels));
}

/// Median distance from the median.
double scatter_of(Runs runs) {
  const double level = level_of(runs);
  std::vector<double> off;
  for (const StickPlateau& run : runs) off.push_back(std::abs(run.level - level));
  return median(std::move(off));
}

/// From the first half of the runs to the second.
double trend_of(Runs runs) {
  const std::size_t half = runs.size() / 2;
  return std::abs(level_of(runs.subspan(half)) - level_of(runs.first(half)));
}

/// Plateaus elsewhere than on the level of the others: before the first of them, or after the last.
void add_plateaus_beside(const PlateauSearch& search, std::vector<StickPlateau>& runs) {
  const std::span<const double> velocity(search.blocks.mean);
  const std::size_t first = runs.front().begin, last = runs.back().end;
  const auto find = [&](std::size_t begin, std::size_t end) {
    std::vector<StickPlateau> found;
    if (static_cast<double>(end - begin) < kStepPart * static_cast<double>(velocity.size())) return found;
    found = find_plateaus(velocity.subspan(begin, end - begin)).runs;
    for (StickPlateau& run : found) run.begin += begin, run.end += begin;
    const double rest = kStandstillPart * std::abs(search.plateaus.level);
    std::erase_if(found, [&](const StickPlateau& run) { return std::abs(run.level) < rest; });
    if (found.size() < kFewestPeriods) found.clear();
    return found;
  };
  const std::vector<StickPlateau> before = find(0, first), after = find(last, velocity.size());
  runs.insert(runs.begin(), before.begin(), before.end());
  runs.insert(runs.end(), after.begin(), after.end());
}

/// Number of runs before the step that is clearest; 0: there is none.
std::size_t find_step(Runs runs) {
  std::size_t best = 0;
  double clearest = 0;
  for (std::size_t k = kFewestPeriods; k + kFewestPeriods <= runs.size(); ++k) {
    const Runs before = runs.first(k), after = runs.subspan(k);
    const double a = level_of(before), b = level_of(after), gap = std::abs(a - b);
    if (gap < kLeastStep * std::max(std::abs(a), std::abs(b))) continue;
    const double within = std::max(scatter_of(before), scatter_of(after));
    const double trend = std::max(trend_of(before), trend_of(after));
    if (gap < kClearStep * within || gap < kSteepStep * trend) continue;
    // Where several places do, both sides are tightest at the step itself.
    double off = 0;
    for (const StickPlateau& run : before) off += std::abs(run.level - a);
    for (const StickPlateau& run : after) off += std::abs(run.level - b);
    const double clear = gap / std::max(off, 1e-12 * gap);
    if (clear > clearest) clearest = clear, best = k;
  }
  return best;
}

void split(Runs runs, std::vector<SpeedLevel>& levels) {
  const std::size_t k = find_step(runs);
  if (k == 0) {
    levels.push_back({middle_of(runs.front()), middle_of(runs.back()), level_of(runs)});
    return;
  }
  split(runs.first(k), levels);
  split(runs.subspan(k), levels);
}

}  // namespace

std::vector<SpeedLevel> find_speed_levels(const PlateauSearch& search) {
  std::vector<StickPlateau> runs = search.plateaus.runs;
  if (runs.size() < kFewestPeriods) return {};
  add_plateaus_beside(search, runs);
  std::vector<SpeedLevel> levels;
  split(runs, levels);
  if (levels.size() < 2) levels.clear();
  return levels;
}

std::vector<SampleSpan> changes_between(const std::vector<SpeedLevel>& levels, std::size_t length) {
  std::vector<SampleSpan> changes;
  for (std::size_t k = 1; k < levels.size(); ++k) {
    changes.push_back({levels[k - 1].end * length, levels[k].begin * length});
  }
  return changes;
}

std::vector<double> stepped_speed(const std::vector<SpeedLevel>& levels, std::size_t length, std::size_t samples) {
  std::vector<double> speed(samples, levels.back().level);
  std::size_t i = 0, k = 0;
  for (const SampleSpan& change : changes_between(levels, length)) {
    for (; i < std::min(samples, (change.begin + change.end) / 2); ++i) speed[i] = levels[k].level;
    ++k;
  }
  return speed;
}

HealthItem check_speed_steps(const Motion& motion, const std::vector<SpeedLevel>& levels, const BlockMeans& blocks,
                             double stated) {
  HealthItem item{health_check::kPlateauSpeed, HealthItem::Status::warning, "the speed of the disc steps: omega r is "};
  double nearest = std::abs(levels.front().level - stated);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    if (k > 0)
      item.message += fmt::format(", from {} s on ", general(static_cast<double>(levels[k].begin) * blocks.step, 4));
    item.message += fmt::format("{} mm/s", general(1e3 * levels[k].level, 4));
    nearest = std::min(nearest, std::abs(levels[k].level - stated));
  }
  item.message += " (taken from the plateaus)";
  if (stated == 0) return item;
  item.message += fmt::format("; stated is {} mm/s", general(1e3 * stated, 4));
  if (nearest > kSettled * std::abs(stated)) item.status = HealthItem::Status::problem;
  if (motion.conditions.speed.known()) item.message += ", give a column with the speed";
  return item;
}

}  // namespace tribofit::kinematics
