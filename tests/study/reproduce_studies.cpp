// What of the studies of [U], [C] and [D] reproduces, as Markdown: see scripts/reproduce-studies.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "machines.hpp"
#include "published_studies.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/study/critical_speed.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit::studies {
namespace {

constexpr double kMm = 1e-3, kPerMm = 1e3;

std::string listed(const std::vector<double>& values, double si, int digits) {
  std::string text;
  for (const double x : values) text += fmt::format("{}{:.{}f}", text.empty() ? "" : " and ", x / si, digits);
  return text.empty() ? "none" : text;
}

std::string described(const Settled& settled) {
  if (settled.regime == Regime::sliding) return "steady sliding";
  if (settled.regime == Regime::not_settled) return settled.seen;
  return fmt::format("{} of {:.3f} Hz and {:.2f} mm, stick {:.2f} s", to_string(settled.regime), settled.frequency,
                     settled.peak_to_peak / kMm, settled.stick_time);
}

void row(const std::string& what, const std::string& published, const std::string& ours) {
  fmt::print("| {} | {} | {} |\n", what, published, ours);
}

void sharpness_table() {
  fmt::print(
      "\n### The smoothed law beside the one with located events\n\n"
      "[U] Fig 2 with c_v = 0.33 s/mm; stick of the smoothed law: |v_r| below the crest of the law.\n\n"
      "| sharpness s [s/mm] | period [s] | stick [s] | peak-to-peak [mm] | period too short by "
      "|\n|---|---|---|---|---|\n");
  const Machine machine = uradnicek_machine(330, 0.5 * kMm);
  const Settled exact = settle(machine);
  for (const double sharpness : {50.0, 100.0, 500.0, 1e3, 1e4, 1e5, 1e6}) {
    const Settled s = settle(machine, {.sharpness = sharpness * kPerMm});
    fmt::print("| {:g} | {:.5f} | {:.4f} | {:.5f} | {:.3f} % |\n", sharpness, 1 / s.frequency, s.stick_time,
               s.peak_to_peak / kMm, 100 * (1 - exact.frequency / s.frequency));
  }
  fmt::print("| located events | {:.5f} | {:.4f} | {:.5f} | |\n", 1 / exact.frequency, exact.stick_time,
             exact.peak_to_peak / kMm);
}

void frequency_rows() {
  const auto band = [](double sharpness) {
    return fmt::format("{:.3f} ({:.3f} for 0.285 Hz to {:.3f} for 0.275 Hz)",
                       decay_for_frequency(0.28, sharpness) / kPerMm, decay_for_frequency(0.285, sharpness) / kPerMm,
                       decay_for_frequency(0.275, sharpness) / kPerMm);
  };
  row("c_v for 0.28 Hz at 0.5 mm/s [s/mm]", "not printed",
      "smoothed law, s = 500 s/mm: " + band(kPrintedSharpness) + "; located events: " + band(0));
  row("c_v for steady sliding to lose its stability at 6.99 mm/s [s/mm]", "not printed",
      listed(decays_losing_stability_at(6.99 * kMm), kPerMm, 4));
  row("c_v for stick to vanish at 6.99 mm/s on a slow way up [s/mm]", "not printed",
      listed(decays_losing_stick_at(6.99 * kMm), kPerMm, 3));
}

void unit_row() {
  const Machine tonne = uradnicek_machine(330, 0.5 * kMm), kilogram = with_value(tonne, "mass", 1);
  const auto describe = [](const Machine& m) {
    return fmt::format("natural frequency {:.3f} Hz, damping ratio {:.3f}", m.rig.natural_frequency() / 2 / M_PI,
                       m.rig.damping_ratio());
  };
  row("units", "m = 1 kg, k = 5 N/mm, c = 0.2 N/mm.s-1",
      "N, mm, s with m = 1 N s^2/mm (1 t): " + describe(tonne) + ". With 1 kg: " + describe(kilogram) +
          ": overdamped, nothing could oscillate as in Fig 3");
}

std::string begun_at_rest(const Machine& machine) {
  const FromRest r = from_rest(machine);
  const std::string growth = fmt::format("growth {:+.4f} /s: ", std::abs(r.growth_rate) < 1e-6 ? 0.0 : r.growth_rate);
  if (!std::isnan(r.first_stick))
    return growth + fmt::format("sticks after {:.0f} s, ", r.first_stick) + described(r.settled);
  return growth + fmt::format("no stick in 10 minutes; swings of {:.2f} mm are {:.2f} mm after a minute",
                              r.first_swing / kMm, r.swing_after_a_minute / kMm);
}

void portraits(const std::vector<double>& decays) {
  fmt::print("\nPortraits, begun at rest (law with located events):\n\n| | [U] Fig 3 |");
  for (const double decay : decays) fmt::print(" c_v = {:.4f} s/mm |", decay / kPerMm);
  fmt::print("\n|---|---|---|---|---|\n");
  const char* published[] = {"stick-slip", "steady oscillation without stick", "oscillation that decays"};
  const double velocities[] = {5, 6.99, 10};
  for (std::size_t i = 0; i < 3; ++i) {
    fmt::print("| {:g} mm/s | {} |", velocities[i], published[i]);
    for (const double decay : decays) fmt::print(" {} |", begun_at_rest(uradnicek_machine(decay, velocities[i] * kMm)));
    fmt::print("\n");
  }
}

void harmonics_row(const char* name, double decay, const SettleOptions& options) {
  const Lines lines = lines_of(uradnicek_machine(decay, 0.5 * kMm), options);
  std::string text =
      fmt::format("at multiples of {:.4f} Hz (between them below {:.0e} of the first): ", lines.fundamental,
                  lines.between / lines.amplitude[0]);
  for (std::size_t k = 0; k < 6; ++k) text += fmt::format("{}{:.4f}", k == 0 ? "" : ", ", lines.amplitude[k] / kMm);
  row(fmt::format("harmonics of the displacement, {} [mm]", name), "multiples of 0.28 Hz", text);
}

void uradnicek() {
  fmt::print("\n### [U]\n\n| | [U] | computed |\n|---|---|---|\n");
  unit_row();
  frequency_rows();
  const double slow = decay_for_frequency(0.28, kPrintedSharpness);
  const Readings r = readings_of_the_arctangent(slow);
  row("reading of the arctangent", "multiplies only the second term",
      fmt::format("as printed, friction at rest is {:g} ({:g} N) and does not turn with v_r; with the sign on mu_c it "
                  "jumps by {:g} ({:g} N). Smooth against printed: {:.4f} and {:.4f} Hz, {:.4f} and {:.4f} mm",
                  r.printed_at_rest, 10 * r.printed_at_rest, r.jump, 10 * r.jump, r.smooth_frequency,
                  r.printed_frequency, r.smooth_swing / kMm, r.printed_swing / kMm));
  harmonics_row("smoothed law", slow, {.sharpness = kPrintedSharpness});
  harmonics_row("located events", decay_for_frequency(0.28, 0), {});
  const std::vector<double> linear = decays_losing_stability_at(6.99 * kMm);
  portraits({linear.at(0), linear.at(1), slow});
}

void creak_claims(const std::vector<std::pair<std::string, Machine>>& machines) {
  std::vector<std::vector<Claim>> all;
  fmt::print("\n| claim |");
  for (const auto& [name, machine] : machines) {
    fmt::print(" {} |", name);
    all.push_back(claims_of_creak(machine));
  }
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < machines.size(); ++i) fmt::print("---|");
  fmt::print("\n");
  for (std::size_t k = 0; k < all.front().size(); ++k) {
    fmt::print("| {} |", all.front()[k].statement);
    for (const auto& claims : all) fmt::print(" {}: {} |", claims[k].confirmed ? "yes" : "no", claims[k].numbers);
    fmt::print("\n");
  }
}

void creak_portraits(const Machine& machine) {
  fmt::print(
      "\n| v_disc [mm/s] | begun at rest | begun in stick | growth of small vibrations [1/s] |\n|---|---|---|---|\n");
  for (const double v : {0.5, 1.0, 2.0, 2.75}) {
    const Machine at = with_value(machine, "velocity", v * kMm);
    const FromRest r = from_rest(at);
    fmt::print("| {:g} | {} | {} | {:+.4f} |\n", v, described(r.settled), described(settle(at)), r.growth_rate);
  }
}

void print_map(const Map& map) {
  const auto& [machine, x, y, settle] = map.request;
  for (const char* name : {"peak-to-peak", "stick-time", "energy"}) {
    const MeasureInfo& measure = measure_named(name);
    const auto k = static_cast<std::size_t>(&measure - measures().data());
    fmt::print("\n{} [{}] over {} [{}] and, downwards, {} [{}]\n\n| |", measure.name, measure.unit, x.variable.name,
               x.variable.unit, y.variable.name, y.variable.unit);
    for (const double value : x.values) fmt::print(" {:.3g} |", value / x.variable.si);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < x.values.size(); ++i) fmt::print("---|");
    fmt::print("\n");
    for (std::size_t row = y.values.size(); row-- > 0;) {
      fmt::print("| {:.3g} |", y.values[row] / y.variable.si);
      for (const MapCell& cell : map.rows[row]) {
        cell.regime == Regime::sliding ? fmt::print(" - |") : fmt::print(" {:.3g} |", cell.values[k] / measure.si);
      }
      fmt::print("\n");
    }
  }
}

void creak(bool maps) {
  const CreakLaw both = law_with_both_figures_of_creak();
  const double slow = decay_for_frequency(0.28, 0);
  const Machine machine = creak_machine(both.decay, both.viscous);
  const CriticalSpeed critical = critical_speed(machine), of_slow = critical_speed(creak_machine(slow, 0));
  fmt::print(
      "\n### [C]\n\n"
      "[C] prints speeds, 0.28 Hz and a critical speed of about 2.5 mm/s, no other value. With the values of [U] "
      "and sigma = 0 no c_v gives both: 0.28 Hz at 0.5 mm/s takes c_v = {:.3f} s/mm, with which sliding loses its "
      "stability at {:.2f} and stick vanishes at {:.2f} mm/s. With [C]'s viscous term both come out: "
      "c_v = {:.4f} s/mm, sigma = {:.5f} s/mm (begun at rest it comes to stick up to {:.2f}, and stick that is there "
      "goes on up to {:.2f} mm/s).\n",
      slow / kPerMm, critical_speed(creak_machine(slow, 0)).linear.back() / kMm, of_slow.stick_vanishes / kMm,
      both.decay / kPerMm, both.viscous / kPerMm, last_stick_from_rest(machine) / kMm, critical.stick_vanishes / kMm);
  creak_claims({{fmt::format("c_v = {:.3f}, sigma = {:.4f} s/mm", both.decay / kPerMm, both.viscous / kPerMm), machine},
                {fmt::format("c_v = {:.3f} s/mm", slow / kPerMm), creak_machine(slow, 0)},
                {"c_v = 0.045 s/mm", creak_machine(44.6, 0)},
                {"c_v = 1.45 s/mm", creak_machine(1450, 0)}});
  creak_portraits(machine);
  if (!maps) return;
  for (const Map& map : maps_of_creak(machine, 7)) print_map(map);
}

void radii() {
  fmt::print("\n### [D]\n");
  for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
    std::vector<CalibratedRadius> all;
    for (const PublishedRadius& p : kPublishedRadii) all.push_back(calibrated_radius(p, law, p.frequency));
    const std::array<double, 4> off_centre = frequencies_with_published_ratios(law);
    fmt::print(
        "\nThe {} law; k and m calibrated to frequency and amplitude at a damping ratio of 0.02:\n\n"
        "| radius | k [N/mm] | m [kg] | frequency [Hz] | amplitude of v_r [mm/s] | its fundamental | [D]'s line | "
        "frequency with [D]'s line [Hz] | RMS of v_b [mm/s] | events in 1 s | [D] |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n",
        to_string(law));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const CalibratedRadius& c = all[i];
      const PublishedRadius& p = kPublishedRadii[i];
      fmt::print(
          "| {:g} mm | {:.3f} | {:.4f} | {:.3f} | {:.1f} | {:.2f} | {:.2f} | {:.3f} | {:.2f} | {} or {} | {} |\n",
          p.radius / kMm, c.machine.rig.stiffness / kPerMm, c.machine.rig.mass, c.settled.frequency,
          c.settled.peak_speed / kMm, c.line / all[2].line, p.line / kPublishedRadii[2].line, off_centre[i],
          c.rms_block / kMm, c.least_events, c.most_events, p.events);
    }
  }
}

}  // namespace
}  // namespace tribofit::studies

int main(int argc, char** argv) {
  const bool maps = argc > 1 && std::string(argv[1]) == "--maps";
  tribofit::studies::sharpness_table();
  tribofit::studies::uradnicek();
  tribofit::studies::creak(maps);
  tribofit::studies::radii();
}
