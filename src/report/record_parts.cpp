#include <algorithm>
#include <cmath>
#include <limits>

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

/// "15 mm (command line)".
std::string stated(const std::string& value, std::string_view unit, const std::string& source) {
  return fmt::format("{} {}{}", value, unit, source.empty() ? "" : " (" + source + ")");
}
std::string stated(const Condition& one, double si, std::string_view unit) {
  return one.known() ? stated(brief(one.value / si), unit, one.source) : "not known";
}

/// Of the record, or of every step where they differ.
std::string condition(const Motion& motion, const ConditionInfo& which) {
  std::vector<std::string> values;
  std::string source;
  for (const Step& step : motion.steps) {
    const Condition& own = step.conditions.*which.member;
    if (!own.known()) continue;
    values.push_back(brief(own.value / which.si));
    source = own.source;
  }
  const Condition& whole = motion.conditions.*which.member;
  if (whole.known() || values.empty()) return stated(whole, which.si, which.unit);
  return stated(fmt::format("{}", fmt::join(values, ", ")), std::string(which.unit) + " by step", source);
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

/// "100 000 samples, 5.000 s at 20 kHz".
std::string record_sentence(const Identification& r) {
  if (r.motion.is_points()) return points_sentence(r.motion);
  return fmt::format("{} samples, {} s at {}", grouped(r.samples), significant(r.duration, 4), frequency_text(r.rate));
}

/// Points have no motion of their own; what there is of one are their directions.
Facts point_facts(const Motion& motion) {
  const auto back = static_cast<std::size_t>(
      std::count_if(motion.relative_velocity.begin(), motion.relative_velocity.end(), [](double v) { return v < 0; }));
  return {{"forwards", grouped(motion.size() - back) + " points"},
          {"backwards", grouped(back) + " points"},
          {"standard errors", motion.friction_std_error.empty() ? "not stated: all points weigh the same"
                                                                : "stated: points weigh against their squares"}};
}

/// Of friction without motion.
Facts force_facts(const ForceStatistics& force, const std::string& friction) {
  const auto text = [](const SlipSpread& spread, double si, const std::string& unit) {
    const bool spreads = std::isfinite(spread.scatter);
    return estimate_text(spread.mean, si, unit) +
           (spreads ? "; scatter " + significant(spread.scatter / si, 2) + unit_behind(unit) : "");
  };
  Facts facts = {{"friction", "mean " + text(force.whole, 1, friction) + " over all samples" +
                                  (force.both_directions ? ", of its size: it goes in both directions" : "")}};
  if (force.slips == 0) {
    facts.emplace_back("slips", "none: nothing falls faster than it rises");
    return facts;
  }
  facts.emplace_back("slips", grouped(force.slips) +
                                  "; means below are over slips, +/- is one standard error, scatter that from slip to "
                                  "slip");
  const auto add = [&](const char* name, const SlipSpread& spread, double si, const std::string& unit) {
    if (std::isfinite(spread.mean.value)) facts.emplace_back(name, text(spread, si, unit));
  };
  add("break-away", force.peak, 1, friction);
  add("drop", force.drop, 1, friction);
  add("period", force.period, 1, "s");
  add("slip time", force.slip_time, kMillisecond, "ms");
  return facts;
}

/// Friction over the velocity without a law.
void add_friction_levels(const FrictionLevels& levels, const std::string& unit, Facts& facts) {
  const auto speed = [](double v) { return significant(v / kMillimetre, 3); };
  for (const FrictionLevels::Bin& bin : levels.bins) {
    facts.emplace_back("at " + speed(bin.velocity) + " mm/s",
                       fmt::format("friction {} ({} slips)", estimate_text(bin.friction, 1, unit), bin.slips));
  }
  for (const FrictionLevels::Level& level : levels.levels) {
    facts.emplace_back("level",
                       fmt::format("{} in {} slips that reach {} to {} mm/s", estimate_text(level.friction, 1, unit),
                                   level.slips, speed(level.slowest_peak), speed(level.fastest_peak)));
  }
  if (const auto apart = difference_of(levels)) {
    facts.emplace_back("amplitude",
                       fmt::format("the two levels {}: they differ by {}", apart->agree ? "agree" : "do not agree",
                                   estimate_text(apart->value, 1, unit)));
  }
}

/// Of a slider on a spring: it sticks, swings about its drive, or follows it.
std::string regime_text(const Identification& r) {
  if (r.segmentation.kind == MotionKind::stick_slip) return "stick-slip";
  if (follows_drive(r.motion, r.segmentation)) return "steady: the slider follows its drive";
  const double frequency = r.spectral_peak.frequency;
  const std::string at = frequency > 0 ? fmt::format(" at {} Hz", significant(frequency, 4)) : "";
  return fmt::format("inertial: the slider swings{} without sticking", at);
}

Facts condition_facts(const Identification& r) {
  const Motion& motion = r.motion;
  const SpringDrive& s = motion.spring;
  const auto& [of_radius, of_speed, of_load] = condition_infos;
  const std::pair<std::string, std::string> load = {std::string(of_load.name), condition(motion, of_load)};
  if (motion.kind == RecordKind::spring_slider) {
    return {{"drive", stated(s.velocity, kMillimetre, "mm/s")},
            {"spring", stated(s.stiffness, 1e3, "N/mm")},
            {"moving mass", stated(s.mass, 1e-3, "g")},
            load};
  }
  if (motion.kind == RecordKind::motion_only) {
    const bool base = s.counterface == Counterface::base;
    return {{"moving mass", stated(s.mass, 1, "kg")},
            {"spring", stated(s.stiffness, 1, "N/m")},
            {"damping", stated(s.damping, 1, "N s/m")},
            {"rubs on", base ? "the moving base: v_r = x' - y'" : "ground that stands still: v_r = x'"},
            load};
  }
  if (motion.kind == RecordKind::force_only) return {load};
  if (is_driven_in_steps(motion.kind)) {
    Facts facts = load_point_facts(motion, r.rate_state ? &*r.rate_state : nullptr);
    if (!motion.load.empty()) facts.push_back(load);
    return facts;
  }
  return {{std::string(of_radius.name), condition(motion, of_radius)}, {"disc speed", speed_text(motion)}, load};
}

/// What is not in order, or that all is.
void add_health(const Motion& motion, ReportSection& section) {
  section.heading("Health");
  const std::size_t before = section.items.size();
  std::size_t made = 0;
  for (const HealthItem& check : motion.health) {
    made += health_check::was_made(check.message);
    const bool problem = check.status == HealthItem::Status::problem;
    if (check.status != HealthItem::Status::ok)
      section.text(problem ? ReportText::Kind::problem : ReportText::Kind::warning, check.check + ": " + check.message);
  }
  if (section.items.size() > before) return;
  const std::size_t not_made = motion.health.size() - made;
  const std::string others = not_made > 0 ? fmt::format(", {} not possible", not_made) : "";
  section.plain(fmt::format("no problems found ({} checks{})", made, others));
}

}  // namespace

std::string kind_text(const Identification& r) {
  const std::string source = r.motion.kind_source.empty() ? "" : " (" + r.motion.kind_source + ")";
  return std::string(to_string(kind_of_record(r.motion, r.segmentation))) + source;
}

Facts stick_slip_facts(const Identification& r) {
  const std::string friction = friction_unit(r.motion);
  const Segmentation& s = r.segmentation;
  if (r.motion.is_points()) return point_facts(r.motion);
  if (is_driven_in_steps(r.motion.kind)) return {};
  if (r.force_statistics) return force_facts(*r.force_statistics, friction);
  const bool sticks = s.kind == MotionKind::stick_slip;
  Facts facts = {{"cycles", cycles_text(s)}};
  const auto add = [&](const char* name, const Estimate& m, double si, const std::string& unit,
                       const std::string& more = "") {
    if (std::isfinite(m.value)) facts.emplace_back(name, estimate_text(m, si, unit) + more);
  };
  if (s.kind != MotionKind::always_sticking) facts.emplace_back("in slip", slip_text(r));
  if (sticks) {
    const LongSticks longest = long_sticks(s);
    add("frequency", s.frequency, 1, "Hz");
    add("amplitude of v_r", s.amplitude, kMillimetre, "mm/s");
    add("stick time", s.stick_time, kMillisecond, "ms",
        has_uneven_sticks(s)
            ? fmt::format("; the longest {} s, {} over 1 s", significant(longest.longest, 3), longest.count)
            : "");
    add("slip time", s.slip_time, kMillisecond, "ms");
  }
  const Estimate& branches = s.branch_difference;
  const Interval interval = branches.interval95();
  if (std::isfinite(branches.std_error) && (interval.lower > 0 || interval.upper < 0)) {
    facts.emplace_back("branches",
                       fmt::format("at the same speed friction is {} by {} while speeding up than while slowing down",
                                   branches.value > 0 ? "higher" : "lower",
                                   estimate_text({std::abs(branches.value), branches.std_error}, 1, friction)));
  }
  if (r.motion.kind == RecordKind::spring_slider) {
    const PullLevels levels = pull_levels(s);  // need no velocity
    add("break-away", levels.break_away, 1, friction);
    add("drop", levels.drop, 1, friction);
    facts.emplace_back("regime", regime_text(r));
  }
  if (r.friction_levels) add_friction_levels(*r.friction_levels, friction, facts);
  if (s.rms_velocity > 0) facts.emplace_back("RMS of v_b", significant(s.rms_velocity / kMillimetre, 4) + " mm/s");
  if (const SpectralPeak& peak = r.spectral_peak; peak.frequency > 0 && sticks) {
    facts.emplace_back(
        "spectrum of v_r",
        fmt::format("peak at {} Hz; a plain FFT would say {} Hz, in bins of {} Hz", significant(peak.frequency, 4),
                    significant(peak.bin_frequency, 4), significant(peak.bin_width, 3)));
  }
  return facts;
}

void add_facts(const Identification& r, Report& report) {
  report.facts.insert(report.facts.end(), {{"kind of record", kind_text(r)}, {"record", record_sentence(r)}});
  for (const Facts& more : {condition_facts(r), stick_slip_facts(r)}) {
    report.facts.insert(report.facts.end(), more.begin(), more.end());
  }
}

ReportTable health_table(std::span<const Identification> traces) {
  const bool several = traces.size() > 1;
  ReportTable table("Health of the data");
  if (several) table.text({"trace"});
  table.text({"check", "status", "what was found"});
  using enum HealthItem::Status;
  const auto add = [&](HealthItem::Status status, const char* shown, bool made = true) {
    for (const Identification& trace : traces) {
      for (const HealthItem& item : trace.motion.health) {
        if (item.status != status || health_check::was_made(item.message) != made) continue;
        auto& row = table.rows.emplace_back();
        if (several) row.push_back(trace.path);
        row.insert(row.end(), {item.check, shown, item.message.substr(made ? 0 : health_check::kNotChecked.size())});
      }
    }
  };
  add(problem, "✕ problem");
  add(warning, "! warning");
  add(ok, "✓ ok");
  add(ok, "– not checked", false);
  return table;
}

ReportSection record_section(const Identification& r) {
  const Motion& m = r.motion;
  ReportSection section{"record", "", {}, Medium::terminal};
  section.text(ReportText::Kind::title, fmt::format("tribofit {}  {}: {}", version, printable(r.path), kind_text(r)));
  const double trimmed = static_cast<double>(m.trimmed) * m.step;
  section.plain(record_sentence(r) +
                (trimmed > 0 ? fmt::format("; the first {} s (run-up) left out", significant(trimmed, 3)) : ""));
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
  if (!is_driven_in_steps(m.kind)) add_health(m, section);
  return section;
}

}  // namespace tribofit
