#include "study_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numbers.hpp"

namespace tribofit {

std::string velocity_text(double velocity, const Machine& machine) {
  return fmt::format("{} mm/s ({} rpm)", significant(velocity / kMillimetre, 4),
                     significant(velocity / machine.radius / kRpm, 4));
}

std::string measure_text(const Settled& settled, const MeasureInfo& measure) {
  return significant(settled.*measure.value / measure.si, 4);
}

std::string range_text(const Range& range, double unit) {
  if (std::isnan(range.lower95)) return "";
  return fmt::format("[{}, {}]", significant(range.lower95 / unit, 4), significant(range.upper95 / unit, 4));
}

std::string elasticity_text(double elasticity) {
  return std::isnan(elasticity) ? std::string("-") : fmt::format("{:+.3f}", elasticity);
}

std::string sharpness_text(const StudiedMachine& of) {
  return fmt::format("smoothed by an arctangent of sharpness {} s/mm", significant(1e-3 * of.sharpness, 4));
}

std::vector<std::string> machine_sentences(const StudiedMachine& of) {
  const Machine& m = of.machine;
  std::string rig = fmt::format("m = {} kg, k = {} N/mm, c = {} N s/mm (damping ratio {}), natural frequency {} Hz; ",
                                significant(m.rig.mass, 4), significant(1e-3 * m.rig.stiffness, 4),
                                significant(1e-3 * m.rig.damping, 4), significant(m.rig.damping_ratio(), 3),
                                significant(m.rig.natural_frequency() / (2 * std::numbers::pi), 4));
  rig += fmt::format("N = {} N, r = {} mm, {} rpm, omega r = {} mm/s", brief(m.load), brief(m.radius / kMillimetre),
                     brief(m.speed / kRpm), significant(m.disc_velocity() / kMillimetre, 4));
  std::string friction;
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    const Parameter& q = slot.parameter;
    friction += fmt::format("{}{}{} = {}{}", friction.empty() ? "" : ", ", slot.effect.empty() ? "" : slot.effect + ".",
                            q.name, significant(m.parameters[k] / q.si, 4), unit_behind(q.unit));
  }
  return {std::move(rig), std::move(friction)};
}

std::vector<std::string> critical_sentences(const StudiedMachine& of, const SpeedStudy& study) {
  const CriticalSpeed& c = study.critical;
  std::vector<std::string> out;
  const auto add = [&](const char* what, double value, const Range& range) {
    if (std::isnan(value)) return;
    std::string sentence = fmt::format("{} {}", what, velocity_text(value, of.machine));
    if (!std::isnan(range.lower95)) sentence += ",  " + range_text(range, kMillimetre) + " mm/s (95 %)";
    out.push_back(std::move(sentence));
  };
  for (const double v : c.linear) {
    const bool last = v == c.linear.back();
    const char* what =
        c.stable_at_highest ? "steady sliding loses its stability below" : "steady sliding is unstable from";
    add(last ? what : "steady sliding changes its stability at", v,
        last ? study.linear_range : Range{std::nan(""), std::nan("")});
  }
  const std::string searched =
      fmt::format("from {} to {} mm/s", significant(1e3 * c.lowest, 3), significant(1e3 * c.highest, 3));
  if (c.linear.empty()) {
    out.push_back(
        fmt::format("steady sliding is {} at all speeds {}", c.stable_at_highest ? "stable" : "unstable", searched));
  }
  add("on the way up stick vanishes at", c.stick_vanishes, study.vanishes_range);
  add("on the way down it comes back at", c.stick_returns, study.returns_range);
  if (!std::isnan(c.stick_vanishes) && std::isnan(c.stick_returns)) {
    out.push_back("on the way down it does not come back: sliding goes on");
  }
  if (c.below_range) out.push_back("nothing sticks " + searched);
  if (c.above_range) {
    out.push_back(
        fmt::format("it still sticks at {} mm/s, the highest speed searched", significant(1e3 * c.highest, 3)));
  }
  return out;
}

std::string bistable_sentence(const CriticalSpeed& c) {
  constexpr double kSame = 1.001;
  if (!(c.stick_vanishes > kSame * c.stick_returns)) return "";
  return fmt::format(
      "Between {} and {} mm/s it depends on the past which of the two is seen: stick-slip goes on where it has begun, "
      "sliding goes on where it has (a subcritical bifurcation).",
      significant(1e3 * c.stick_returns, 4), significant(1e3 * c.stick_vanishes, 4));
}

std::string response_sentence(const StudiedMachine& of, const Response& study) {
  const Rig& rig = of.machine.rig;
  return fmt::format("A(omega) of a force of {} N ({}): {} mm at rest, {} mm at the natural frequency",
                     significant(study.force, 4),
                     study.harmonics.empty() ? "half the drop of friction" : "the fundamental of friction",
                     significant(1e3 * study.force / rig.stiffness, 4),
                     significant(1e3 * study.force / (rig.damping * rig.natural_frequency()), 4));
}

std::string seen_sentence(const Settled& settled) {
  return settled.regime == Regime::not_settled ? "did not settle: " + settled.seen : "";
}

std::string ranking_sentence(const std::vector<Sensitivity>& study, std::size_t measure) {
  std::string list;
  for (const std::size_t i : ranked(study, measure)) {
    const double e = study[i].elasticities[measure];
    if (std::isnan(e)) continue;
    list += (list.empty() ? "" : ", ") + fmt::format("{} ({})", study[i].variable.name, elasticity_text(e));
  }
  return list.empty() ? "nothing can be said here" : list;
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> rows;
  const std::size_t shown = std::min(count, most);
  for (std::size_t i = 0; i < shown; ++i) rows.push_back(shown < 2 ? 0 : i * (count - 1) / (shown - 1));
  return rows;
}

}  // namespace tribofit
