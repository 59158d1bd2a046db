#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numbers.hpp"
#include "rate_state.hpp"
#include "report_parts.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

/// "15 mm (command line)", or every step's own where they differ.
std::string condition(const Motion& motion, const ConditionInfo& which) {
  const Condition& whole = motion.conditions.*which.member;
  const auto with_source = [](std::string text, const std::string& source) {
    return source.empty() ? text : text + " (" + source + ")";
  };
  if (whole.known()) return with_source(fmt::format("{} {}", brief(whole.value / which.si), which.unit), whole.source);
  std::vector<std::string> values;
  std::string source;
  for (const Step& step : motion.steps) {
    const Condition& own = step.conditions.*which.member;
    if (!own.known()) continue;
    values.push_back(brief(own.value / which.si));
    source = own.source;
  }
  if (values.empty()) return "not known";
  return with_source(fmt::format("{} {} by step", fmt::join(values, ", "), which.unit), source);
}

std::string speed_text(const Motion& motion) {
  if (motion.disc_speed.empty()) return condition(motion, condition_infos[1]);
  const auto [low, high] = std::minmax_element(motion.disc_speed.begin(), motion.disc_speed.end());
  return fmt::format("{} to {} rpm (recorded)", brief(*low / kRpm), brief(*high / kRpm));
}

std::string cycles_text(const Segmentation& s) {
  if (s.kind == MotionKind::always_slipping) {
    return "none: the block never sticks, friction is fitted over the whole slip";
  }
  if (s.kind == MotionKind::always_sticking) return "none: the block never slips, there is no sliding friction to fit";
  const std::size_t both = count_of_cycles(s), all = s.cycles.size();
  return fmt::format("{} with a stick and a slip", both) + (both < all ? fmt::format(" ({} slips in all)", all) : "");
}

/// How many samples carry the law, and why the others do not.
std::string slip_text(const Identification& r) {
  const std::size_t slip = samples_in_slip(r.segmentation), all = r.motion.size();
  std::string text = fmt::format("{} of {} samples", grouped(slip), grouped(all));
  if (slip == all) return text;
  const double limit = r.segmentation.stick_threshold / kMillimetre;
  const std::string below = limit > 0 ? fmt::format(" below {} mm/s", significant(limit, 2)) : "";
  return text + (r.segmentation.kind == MotionKind::always_slipping
                     ? fmt::format("; the others are at rest{} and are not used in the fit", below)
                     : fmt::format("; the others stick{} and are not used for the law of sliding", below));
}

/// "72 points, |v_r| from 0.1 to 600 mm/s, in both directions".
std::string points_sentence(const Motion& motion) {
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  bool back = false, forth = false;
  for (const double v : motion.relative_velocity) {
    slowest = std::min(slowest, std::abs(v));
    fastest = std::max(fastest, std::abs(v));
    (v < 0 ? back : forth) = true;
  }
  return fmt::format("{} points, |v_r| from {} to {} mm/s{}", grouped(motion.size()), brief(slowest / kMillimetre),
                     brief(fastest / kMillimetre), back && forth ? ", in both directions" : "");
}

/// Points have no motion of their own; what there is of one are their directions.
Facts point_facts(const Motion& motion) {
  const auto back = static_cast<std::size_t>(
      std::count_if(motion.relative_velocity.begin(), motion.relative_velocity.end(), [](double v) { return v < 0; }));
  return {{"forwards", fmt::format("{} points", grouped(motion.size() - back))},
          {"backwards", fmt::format("{} points", grouped(back))},
          {"standard errors", motion.friction_std_error.empty() ? "not stated: all points weigh the same"
                                                                : "stated: points weigh against their squares"}};
}

/// "0.421 +/- 0.002 N from slip to slip 0.02".
std::string spread_text(const SlipSpread& spread, double unit, std::string_view name) {
  std::string text = with_error(spread.mean.value / unit, spread.mean.std_error / unit) + std::string(name);
  if (std::isfinite(spread.scatter)) text += fmt::format("; scatter {}", significant(spread.scatter / unit, 2));
  return text + (std::isfinite(spread.scatter) ? std::string(name) : "");
}

/// Of friction without motion.
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

/// Friction over the velocity without a law.
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
  if (const auto apart = difference_of(levels)) {
    facts.emplace_back("amplitude",
                       fmt::format("the two levels {}: they differ by {}{}", apart->agree ? "agree" : "do not agree",
                                   with_error(apart->value.value, apart->value.std_error), behind));
  }
}

/// Of a slider on a spring: it sticks, it swings about its drive, or it follows it.
std::string regime_text(const Identification& r) {
  if (r.segmentation.kind == MotionKind::stick_slip) return "stick-slip";
  if (follows_drive(r.motion, r.segmentation)) return "steady: the slider follows its drive";
  const std::string at =
      r.spectral_peak.frequency > 0 ? fmt::format(" at {} Hz", significant(r.spectral_peak.frequency, 4)) : "";
  return fmt::format("inertial: the slider swings{} without sticking", at);
}

/// "1.1 mm/s (command line)".
std::string spring_text(const Condition& known, double unit, std::string_view name) {
  if (!known.known()) return "not known";
  return fmt::format("{} {} ({})", brief(known.value / unit), name, known.source);
}

Facts condition_facts(const Identification& r) {
  const Motion& motion = r.motion;
  const RateStateAnalysis* analysis = r.rate_state ? &*r.rate_state : nullptr;
  const SpringDrive& s = motion.spring;
  const auto& [of_radius, of_speed, of_load] = condition_infos;
  const std::pair<std::string, std::string> load = {std::string(of_load.name), condition(motion, of_load)};
  if (motion.kind == RecordKind::spring_slider) {
    return {{"drive", spring_text(s.velocity, kMillimetre, "mm/s")},
            {"spring", spring_text(s.stiffness, 1e3, "N/mm")},
            {"moving mass", spring_text(s.mass, 1e-3, "g")},
            load};
  }
  if (motion.kind == RecordKind::motion_only) {
    const bool base = s.counterface == Counterface::base;
    return {{"moving mass", spring_text(s.mass, 1, "kg")},
            {"spring", spring_text(s.stiffness, 1, "N/m")},
            {"damping", spring_text(s.damping, 1, "N s/m")},
            {"rubs on", base ? "the moving base: v_r = x' - y'" : "ground that stands still: v_r = x'"},
            load};
  }
  if (motion.kind == RecordKind::force_only) return {load};
  if (is_driven_in_steps(motion.kind)) {
    Facts facts = load_point_facts(motion, analysis);
    if (!motion.load.empty()) facts.push_back(load);
    return facts;
  }
  return {{std::string(of_radius.name), condition(motion, of_radius)}, {"disc speed", speed_text(motion)}, load};
}

/// What is not in order, or that all is.
Facts health_facts(const Motion& motion) {
  Facts facts;
  std::size_t made = 0;
  for (const HealthItem& check : motion.health) {
    made += health_check::was_made(check.message);
    if (check.status == HealthItem::Status::ok) continue;
    facts.emplace_back(fmt::format("{:<8} {}", to_string(check.status), check.check), check.message);
  }
  const std::size_t not_made = motion.health.size() - made;
  if (facts.empty()) {
    facts.emplace_back(fmt::format("no problems found ({} checks{})", made,
                                   not_made > 0 ? fmt::format(", {} not possible", not_made) : ""),
                       "");
  }
  return facts;
}

/// Level and fall of the pull over the cycles, which need no velocity.
void add_levels_of_pull(const Identification& r, Facts& facts) {
  const auto add = [&](const char* name, const Estimate& mean) {
    if (std::isfinite(mean.value))
      facts.emplace_back(name, with_error(mean.value, mean.std_error) + unit_behind(friction_unit(r.motion)));
  };
  const PullLevels levels = pull_levels(r.segmentation);
  add("break-away", levels.break_away);
  add("drop", levels.drop);
}

}  // namespace

std::string kind_text(const Identification& r) {
  std::string text(to_string(kind_of_record(r.motion, r.segmentation)));
  if (!r.motion.kind_source.empty()) text += " (" + r.motion.kind_source + ")";
  return text;
}

std::string record_sentence(const Identification& r) {
  if (r.motion.is_points()) return points_sentence(r.motion);
  return fmt::format("{} samples, {} s at {}", grouped(r.samples), significant(r.duration, 4), frequency_text(r.rate));
}

Facts stick_slip_facts(const Identification& r) {
  if (r.motion.is_points()) return point_facts(r.motion);
  if (is_driven_in_steps(r.motion.kind)) return {};
  if (r.force_statistics) return force_facts(*r.force_statistics, friction_unit(r.motion));
  const Segmentation& s = r.segmentation;
  Facts facts = {{"cycles", cycles_text(s)}};
  if (s.kind != MotionKind::always_sticking) facts.emplace_back("in slip", slip_text(r));
  const auto add = [&](const char* name, const Estimate& m, double unit, const char* unit_name,
                       const std::string& more = "") {
    if (!std::isfinite(m.value) || s.kind != MotionKind::stick_slip) return;
    facts.emplace_back(name, with_error(m.value / unit, m.std_error / unit) + " " + unit_name + more);
  };
  add("frequency", s.frequency, 1, "Hz");
  add("amplitude of v_r", s.amplitude, kMillimetre, "mm/s");
  const LongSticks sticks = long_sticks(s);
  add("stick time", s.stick_time, kMillisecond, "ms",
      has_uneven_sticks(s)
          ? fmt::format("; the longest {} s, {} over 1 s", significant(sticks.longest, 3), sticks.count)
          : "");
  add("slip time", s.slip_time, kMillisecond, "ms");
  const Estimate& branches = s.branch_difference;
  const Interval interval = branches.interval95();
  if (std::isfinite(branches.std_error) && (interval.lower > 0 || interval.upper < 0)) {
    facts.emplace_back(
        "branches",
        fmt::format("at the same speed friction is {} by {}{} while speeding up than while slowing down",
                    branches.value > 0 ? "higher" : "lower", with_error(std::abs(branches.value), branches.std_error),
                    unit_behind(friction_unit(r.motion))));
  }
  if (r.motion.kind == RecordKind::spring_slider) {
    add_levels_of_pull(r, facts);
    facts.emplace_back("regime", regime_text(r));
  }
  if (r.friction_levels) add_friction_levels(*r.friction_levels, friction_unit(r.motion), facts);
  if (s.rms_velocity > 0) facts.emplace_back("RMS of v_b", significant(s.rms_velocity / kMillimetre, 4) + " mm/s");
  if (const SpectralPeak& peak = r.spectral_peak; peak.frequency > 0 && s.kind == MotionKind::stick_slip) {
    facts.emplace_back(
        "spectrum of v_r",
        fmt::format("peak at {} Hz; a plain FFT would say {} Hz, in bins of {} Hz", significant(peak.frequency, 4),
                    significant(peak.bin_frequency, 4), significant(peak.bin_width, 3)));
  }
  return facts;
}

Facts facts_of(const Identification& r) {
  Facts facts = {{"kind of record", kind_text(r)}, {"record", record_sentence(r)}};
  for (const Facts& more : {condition_facts(r), stick_slip_facts(r)}) {
    facts.insert(facts.end(), more.begin(), more.end());
  }
  return facts;
}

ReportTable health_table(std::span<const Identification> traces) {
  const bool several = traces.size() > 1;
  constexpr std::array<const char*, 3> kSigns = {"✓ ", "! ", "✕ "};  // in the order of the status
  ReportTable table("Health of the data");
  if (several) table.text({"trace"});
  table.text({"check", "status", "what was found"});
  const auto add = [&](HealthItem::Status status, bool made) {
    for (const Identification& trace : traces) {
      for (const HealthItem& item : trace.motion.health) {
        if (item.status != status || health_check::was_made(item.message) != made) continue;
        std::vector<std::string> row = {
            item.check, kSigns.at(static_cast<std::size_t>(status)) + std::string(to_string(status)), item.message};
        if (!made) row = {item.check, "– not checked", item.message.substr(health_check::kNotChecked.size())};
        if (several) row.insert(row.begin(), trace.path);
        table.rows.push_back(std::move(row));
      }
    }
  };
  for (const HealthItem::Status status :
       {HealthItem::Status::problem, HealthItem::Status::warning, HealthItem::Status::ok}) {
    add(status, true);
  }
  add(HealthItem::Status::ok, false);
  return table;
}

ReportSection record_section(const Identification& r) {
  const Motion& m = r.motion;
  ReportSection section{"record", "", {}, Medium::terminal};
  section.text(ReportText::Kind::title, fmt::format("tribofit {}  {}: {}", version, printable(r.path), kind_text(r)));
  std::string line = record_sentence(r);
  if (m.trimmed > 0) {
    line += fmt::format("; the first {} s (run-up) left out", significant(static_cast<double>(m.trimmed) * m.step, 3));
  }
  section.plain(line);
  const std::vector<std::string>& elsewhere = r.segmentation.notes;  // they stand with the stick-slip
  for (const std::string& note : r.notes) {
    if (std::find(elsewhere.begin(), elsewhere.end(), note) == elsewhere.end()) section.plain(note);
  }
  section.heading("Conditions");
  Facts conditions = condition_facts(r);
  if (m.friction_kind == FrictionKind::force) {
    conditions.emplace_back("friction", "is a force in newtons: no normal force is known");
  }
  section.add(ReportFacts{std::move(conditions)});
  if (is_driven_in_steps(m.kind)) return section;
  section.heading("Health");
  section.add(ReportFacts{health_facts(m), 26});
  return section;
}

}  // namespace tribofit
