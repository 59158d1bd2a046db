#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include "altered_cases.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit::altered {
namespace {

/// A record under a load that moves, which its friction channel shows as Ft over the nominal load.
Trace under_unrecorded_load(const truth::Rig& rig, const UnrecordedLoad& load) {
  const Rig machine{rig.mass, 2 * rig.zeta * std::sqrt(rig.mass * rig.stiffness), rig.stiffness};
  Drive drive;
  drive.speed = constant_speed(rig.speed());
  drive.radius = rig.radius, drive.mean_load = rig.load;
  drive.load = [=](double t) {
    const double w = 2 * std::numbers::pi / load.period;
    return rig.load * (1 + load.swing * std::sin(w * t) + (t > 0.5 * rig.duration ? load.step : 0));
  };
  const std::vector<double> truth = {rig.static_friction, rig.kinetic_friction, rig.decay};
  SimulationOptions options;
  options.duration = rig.duration, options.rate = rig.rate, options.seed = rig.seed;
  options.scatter = {rig.scatter, 0};
  const FrictionModel model{Law(ExponentialLaw{})};
  const SimulatedMotion motion = simulate(machine, drive, model, truth, options);
  Sensors sensors;
  sensors.friction_noise = rig.friction_noise, sensors.velocity_noise = rig.velocity_noise;
  sensors.seed = rig.seed + 1000;
  Trace trace = record(motion, model, truth, sensors).trace;
  for (std::size_t i = 0; i < trace.load.size(); ++i) trace.friction[i] *= trace.load[i] / rig.load;
  trace.load.clear();
  trace.disc_speed.clear();
  trace.conditions.radius = {rig.radius, "file"};
  trace.conditions.speed = {rig.speed(), "file"};
  trace.conditions.load = {rig.load, "file"};
  trace.steps = {{0, trace.size(), "", {}}};
  return trace;
}

Trace slowed(Trace trace, double s) {
  for (double& t : trace.time) t *= s;
  for (double& v : trace.velocity) v /= s;
  trace.conditions.speed.value /= s;
  return trace;
}

/// What is off beyond three standard errors, and whether by more than two per cent.
struct Off {
  std::string text;
  bool far = false;
  int inside = 0;  ///< of the 95 % intervals
};

Off off(const Fit& fit, const AlteredCase& what) {
  Off out;
  const double truth[] = {what.rig.static_friction, what.rig.kinetic_friction, what.rig.decay * what.slower};
  for (std::size_t k = 0; k < 3; ++k) {
    const FitParameter& p = fit.parameters[k];
    const double error = p.value - truth[k];
    out.inside += p.lower95 <= truth[k] && truth[k] <= p.upper95 ? 1 : 0;
    if (std::abs(error) < 3 * p.std_error) continue;
    out.far = out.far || std::abs(error) > 0.02 * truth[k];
    out.text += fmt::format(" {} {:+.2f} % ({:.1f} se);", p.parameter.name, 100 * error / truth[k],
                            std::abs(error) / p.std_error);
  }
  return out;
}

std::string problems(const Identification& trace, HealthItem::Status at_least) {
  std::string text;
  for (const HealthItem& item : trace.motion.health) {
    if (item.status >= at_least) text += fmt::format(" [{}: {}]", item.check, item.message);
  }
  return text;
}

/// A warning that says which parameter is off.
bool says_unreliable(const Identification& trace) {
  return std::any_of(trace.motion.health.begin(), trace.motion.health.end(), [](const HealthItem& item) {
    return item.status != HealthItem::Status::ok &&
           (item.message.find("is unreliable") != std::string::npos || item.message.find("alpha") != std::string::npos);
  });
}

/// Effects that are named and are not what was done, "" where there are none.
std::string wrong_names(const Diagnosis& diagnosis, const std::vector<std::string>& may_name) {
  const auto may = [&](const std::string& key) {
    return std::find(may_name.begin(), may_name.end(), key) != may_name.end();
  };
  std::string text;
  for (std::size_t k = 1; k < diagnosis.ladder.size(); ++k) {
    const Rung& rung = diagnosis.ladder[k];
    const bool is_right = may(rung.added) || std::any_of(rung.equivalent.begin(), rung.equivalent.end(), may);
    if (!is_right) text += " " + rung.added;
  }
  return text;
}

}  // namespace

Judged judge(const AlteredCase& what) {
  Judged judged;
  Trace trace = what.load.swing != 0 || what.load.step != 0 ? under_unrecorded_load(what.rig, what.load)
                                                            : truth::simulate(what.rig).trace;
  Random random(what.rig.seed);
  if (what.apply) what.apply(trace, random);
  trace = slowed(std::move(trace), what.slower);
  const auto begin = std::chrono::steady_clock::now();
  IdentifyOptions options;
  options.instruments = what.instruments;
  options.threads = 1;
  options.laws = {Law(ExponentialLaw{})};
  DiagnoseOptions more;
  more.diagnosis.threads = 1;
  try {
    const DiagnosedTraces found =
        diagnose({{what.name, {}, std::make_shared<const Trace>(std::move(trace))}}, options, more);
    judged.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Identification& one = found.traces[0];
    if (!found.analysed || found.fits.empty()) {
      judged.outcome = Outcome::refused;
      judged.text = one.warnings.empty() ? "" : one.warnings.back();
      return judged;
    }
    const std::string wrong = wrong_names(found.diagnosis, what.may_name);
    const bool by_exponential = found.diagnosis.law == Law(ExponentialLaw{}) && !found.rungs.empty();
    const Off parameters = off(by_exponential ? found.rungs.back() : found.fits[0], what);
    judged.strict = parameters.text.empty();
    judged.inside = parameters.inside;
    const std::string problem = problems(one, HealthItem::Status::problem);
    bool is_named = !problem.empty() || says_unreliable(one);
    for (const EffectFinding& effect : found.diagnosis.effects) {
      const bool is_fault = std::find(what.may_name.begin(), what.may_name.end(), effect.key) != what.may_name.end();
      is_named = is_named || (is_fault && effect.status <= EffectStatus::possible);
      if (effect.status != EffectStatus::possible) continue;
      judged.possible.push_back(effect.key);
      judged.text += " (possible " + effect.key + ")";
    }
    judged.outcome = !wrong.empty()    ? Outcome::wrong
                     : !parameters.far ? Outcome::right
                     : is_named        ? Outcome::named
                                       : Outcome::wrong;
    judged.text += fmt::format("{}{}; {}; {}", wrong.empty() ? "" : " NAMED" + wrong, parameters.text,
                               to_string(found.diagnosis.verdict), problems(one, HealthItem::Status::warning));
  } catch (const InputError& error) {
    judged.outcome = Outcome::refused;
    judged.text = error.what();
  }
  return judged;
}

}  // namespace tribofit::altered
