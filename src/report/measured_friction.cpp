#include "measured_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "numbers.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

/// "0.421 +/- 0.002 N from slip to slip 0.02".
std::string spread_text(const SlipSpread& spread, double unit, std::string_view name) {
  std::string text = with_error(spread.mean.value / unit, spread.mean.std_error / unit) + std::string(name);
  if (std::isfinite(spread.scatter)) text += fmt::format("; scatter {}", significant(spread.scatter / unit, 2));
  return text + (std::isfinite(spread.scatter) ? std::string(name) : "");
}

Json spread_json(const SlipSpread& spread) {
  return object("mean", spread.mean.value, "std_error", spread.mean.std_error, "scatter", spread.scatter);
}

Json estimate_json(const Estimate& estimate) {
  const Interval ci = interval_of(estimate);
  return object("value", estimate.value, "std_error", estimate.std_error, "ci95", interval_json(ci.lower, ci.upper));
}

}  // namespace

Facts force_facts(const ForceStatistics& force, const std::string& unit) {
  const std::string behind = unit_behind(unit);
  Facts facts = {{"friction", "mean " + spread_text(force.whole, 1, behind) + " over all samples" +
                                  (force.both_directions ? ", of its size: it goes in both directions" : "")}};
  if (force.slips == 0) {
    facts.emplace_back("slips", "none: nothing falls faster than it rises");
    return facts;
  }
  facts.emplace_back("slips",
                     fmt::format("{}; means below are over slips, +/- is one standard error, scatter that from "
                                 "slip to slip",
                                 grouped(force.slips)));
  const auto add = [&](const char* name, const SlipSpread& spread, double size, const std::string& size_name) {
    if (std::isfinite(spread.mean.value)) facts.emplace_back(name, spread_text(spread, size, size_name));
  };
  add("break-away", force.peak, 1, behind);
  add("drop", force.drop, 1, behind);
  add("period", force.period, 1, " s");
  add("slip time", force.slip_time, kMillisecond, " ms");
  return facts;
}

Json force_json(const ForceStatistics& force) {
  return object("friction", spread_json(force.whole), "slips", force.slips, "peak", spread_json(force.peak), "drop",
                spread_json(force.drop), "period_s", spread_json(force.period), "slip_time_s",
                spread_json(force.slip_time), "both_directions", force.both_directions);
}

void add_friction_levels(const FrictionLevels& levels, const std::string& unit, Facts& facts) {
  const std::string behind = unit_behind(unit);
  for (const FrictionLevels::Bin& bin : levels.bins) {
    facts.emplace_back(fmt::format("at {} mm/s", significant(bin.velocity / kMillimetre, 3)),
                       fmt::format("friction {}{} ({} slips)", with_error(bin.friction.value, bin.friction.std_error),
                                   behind, bin.slips));
  }
  for (const FrictionLevels::Level& level : levels.levels) {
    facts.emplace_back("level", fmt::format("{}{} in {} slips that reach {} to {} mm/s",
                                            with_error(level.friction.value, level.friction.std_error), behind,
                                            level.slips, significant(level.slowest_peak / kMillimetre, 3),
                                            significant(level.fastest_peak / kMillimetre, 3)));
  }
  if (levels.levels.size() < 2) return;
  const Estimate &small = levels.levels[0].friction, &large = levels.levels[1].friction;
  const double error = std::hypot(small.std_error, large.std_error);
  if (!std::isfinite(error)) return;
  constexpr double kAlike = 0.02;  // of the level: smoothing and the stated mass and stiffness are no better
  const double apart = std::abs(large.value - small.value);
  const bool agree = apart < std::max(2 * error, kAlike * std::abs(small.value));
  facts.emplace_back("amplitude",
                     fmt::format("the two levels {}: they differ by {}{}", agree ? "agree" : "do not agree",
                                 with_error(large.value - small.value, error), behind));
}

Json friction_levels_json(const FrictionLevels& levels) {
  return object("bins",
                list_of(levels.bins,
                        [](const FrictionLevels::Bin& bin) {
                          return object("velocity_mm_s", bin.velocity / kMillimetre, "friction",
                                        estimate_json(bin.friction), "slips", bin.slips);
                        }),
                "levels", list_of(levels.levels, [](const FrictionLevels::Level& level) {
                  return object("slowest_peak_mm_s", level.slowest_peak / kMillimetre, "fastest_peak_mm_s",
                                level.fastest_peak / kMillimetre, "friction", estimate_json(level.friction), "slips",
                                level.slips);
                }));
}

}  // namespace tribofit
