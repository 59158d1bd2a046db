#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "machines.hpp"
#include "published_studies.hpp"
#include "roots.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/study/critical_speed.hpp"
#include "tribofit/study/sweep.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit::studies {

namespace {

constexpr double kSlow = 0.5e-3, kCritical = 2.5e-3;  // m/s
constexpr double kHardly = 1.1;                       // what "hardly changes" may be over a whole sweep

/// From the valley of the displacement to the peak after it, over two settled cycles [s].
double rise_time(const Machine& machine, const Settled& settled) {
  if (settled.regime != Regime::stick_slip) return std::numeric_limits<double>::quiet_NaN();
  const SimulatedMotion motion = settled_motion(machine, settled, 2, 16);
  const auto& turns = motion.turning_points;
  const auto valley =
      std::find_if(turns.begin(), turns.end(), [](const TurningPoint& turn) { return !turn.is_maximum; });
  if (valley == turns.end() || valley + 1 == turns.end()) return std::numeric_limits<double>::quiet_NaN();
  return (valley + 1)->time - valley->time;
}

Swept swept(const Machine& machine, const std::string& variable, const std::vector<double>& values) {
  Swept out{.variable = variable, .values = values, .settled = sweep(machine, variable, values)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Machine at = with_value(machine, variable, values[i]);
    out.rise.push_back(rise_time(at, out.settled[i]));
    out.frequency_ratio.push_back(out.settled[i].frequency * 2 * M_PI / at.rig.natural_frequency());
  }
  return out;
}

std::vector<double> measure_of(const Swept& swept, double Settled::*measure) {
  std::vector<double> values;
  for (const Settled& settled : swept.settled) values.push_back(settled.*measure);
  return values;
}

std::vector<double> vibrating(const std::vector<double>& values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double x) { return x > 0; });
  return kept;
}

/// "0.567 to 1.96 mm, x3.46" along a sweep.
std::string along(const std::vector<double>& values, double si, const char* unit) {
  const std::vector<double> kept = vibrating(values);
  if (kept.empty()) return "no vibration";
  return fmt::format("{:.3g} to {:.3g}{}{}", kept.front() / si, kept.back() / si, *unit == 0 ? "" : " ", unit);
}

}  // namespace

Machine creak_machine(double decay, double viscous) {
  Machine machine = uradnicek_machine(decay, kSlow);
  if (viscous == 0) return machine;
  machine.model = FrictionModel(ExponentialLaw{}, {Viscous{}});
  machine.parameters.push_back(viscous);
  return machine;
}

CreakLaw law_with_both_figures_of_creak() {
  // c + N sigma = N (mu_s - mu_k) c_v exp(-c_v v).
  const Machine machine = uradnicek_machine(1, kCritical);
  const double drop = machine.parameters[0] - machine.parameters[1];
  const auto viscous = [&](double decay) {
    return drop * decay * std::exp(-decay * kCritical) - machine.rig.damping / machine.load;
  };
  const auto excess = [&](double decay) { return settle(creak_machine(decay, viscous(decay))).frequency - 0.28; };
  const double decay = root_of(excess, 100, 1000, 1e-6);
  return {decay, viscous(decay)};
}

double last_stick_from_rest(const Machine& machine) {
  const CriticalSpeed critical = critical_speed(machine);
  const auto sticks = [&](double velocity) {
    return settle(with_value(machine, "velocity", velocity), {.start = StartFrom::rest}).sticks ? 1.0 : -1.0;
  };
  return root_of(sticks, 0.9 * critical.linear.back(), critical.stick_vanishes, 1e-3);
}

std::vector<Swept> sweeps_of_creak(const Machine& machine) {
  const auto around = [&](const std::string& name) {
    const double own = value_of(machine, name);
    return swept(machine, name, evenly_spaced(own / 2, 2 * own, 9, true));
  };
  return {around("stiffness"), around("mass"), swept(machine, "ratio", evenly_spaced(0.1, 0.9, 9)), around("alpha"),
          swept(machine, "velocity", evenly_spaced(0.25e-3, 2.4e-3, 9))};
}

Trend trend_of(const std::vector<double>& values) {
  const std::vector<double> kept = vibrating(values);
  if (std::is_sorted(kept.begin(), kept.end())) return Trend::rises;
  if (std::is_sorted(kept.rbegin(), kept.rend())) return Trend::falls;
  return Trend::mixed;
}

double span_of(const std::vector<double>& values) {
  const std::vector<double> kept = vibrating(values);
  if (kept.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto [least, most] = std::minmax_element(kept.begin(), kept.end());
  return *most / *least;
}

std::vector<Claim> claims_of_creak(const Machine& machine) {
  const std::vector<Swept> sweeps = sweeps_of_creak(machine);
  const Swept &stiffness = sweeps[0], &mass = sweeps[1], &ratio = sweeps[2], &decay = sweeps[3], &speed = sweeps[4];
  std::vector<Claim> claims;
  const auto trend = [&](const char* statement, const std::vector<double>& values, Trend expected, double si,
                         const char* unit) {
    claims.push_back({statement, trend_of(values) == expected, along(values, si, unit)});
  };
  const auto steady = [&](const char* statement, const std::vector<double>& values, double si, const char* unit) {
    claims.push_back({statement, span_of(values) <= kHardly, along(values, si, unit)});
  };
  const auto swing = [&](const Swept& s) { return measure_of(s, &Settled::peak_to_peak); };
  const auto stick = [&](const Swept& s) { return measure_of(s, &Settled::stick_time); };
  const auto energy = [&](const Swept& s) { return measure_of(s, &Settled::energy); };

  trend("amplitude falls with stiffness", swing(stiffness), Trend::falls, 1e-3, "mm");
  trend("stick period falls with stiffness", stick(stiffness), Trend::falls, 1, "s");
  trend("amplitude rises with mass", swing(mass), Trend::rises, 1e-3, "mm");
  trend("stick period rises with mass", stick(mass), Trend::rises, 1, "s");
  trend("stick period, valley to peak, rises with mass", mass.rise, Trend::rises, 1, "s");
  trend("more mass brings fundamental and natural frequency closer", mass.frequency_ratio, Trend::rises, 1, "");
  trend("amplitude falls as mu_k/mu_s rises", swing(ratio), Trend::falls, 1e-3, "mm");
  steady("stick period hardly changes with mu_k/mu_s", stick(ratio), 1, "s");
  steady("stick period, valley to peak, hardly changes with mu_k/mu_s", ratio.rise, 1, "s");
  trend("energy rises with C_v", energy(decay), Trend::rises, 1e-3, "mJ");
  steady("stick period hardly changes with C_v", stick(decay), 1, "s");
  steady("frequency hardly changes with C_v", measure_of(decay, &Settled::frequency), 1, "Hz");
  trend("frequency approaches the natural one as speed rises", speed.frequency_ratio, Trend::rises, 1, "");
  trend("amplitude rises with speed", swing(speed), Trend::rises, 1e-3, "mm");
  trend("stick period falls with speed", stick(speed), Trend::falls, 1, "s");
  return claims;
}

std::vector<Map> maps_of_creak(const Machine& machine, std::size_t count) {
  const auto axis = [&](const char* name, double low, double high, bool logarithmic) {
    return MapAxis{variable_named(machine, name), evenly_spaced(low, high, count, logarithmic)};
  };
  const double k = machine.rig.stiffness, m = machine.rig.mass, decay = machine.parameters[2];
  const MapAxis speed = axis("velocity", 0.25e-3, 3.5e-3, false);
  std::vector<Map> maps = {{{machine, axis("mass", m / 2, 2 * m, true), axis("stiffness", k / 2, 2 * k, true)}, {}},
                           {{machine, speed, axis("ratio", 0.1, 0.9, false)}, {}},
                           {{machine, speed, axis("alpha", decay / 2, 2 * decay, true)}, {}}};
  for (Map& map : maps) {
    map.rows.resize(map.request.y.values.size());
    compute_map(map.request, {}, 0, [&](std::size_t row, const std::vector<MapCell>& cells) {
      map.rows[row] = cells;
      return true;
    });
  }
  return maps;
}

}  // namespace tribofit::studies
