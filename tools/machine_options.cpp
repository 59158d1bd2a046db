#include "machine_options.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "exit_status.hpp"
#include "settings.hpp"
#include "tribofit/friction/formula.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "typed_values.hpp"

namespace tribofit {
namespace {

/// An effect and its parameters in SI, in the order of its info().
struct RequestedEffect {
  Effect effect;
  std::vector<double> values;
};

/// Reads "KEY" or "KEY:name=value,name=value", where a form of the effect may stand first
/// (rate-state:healing,D_c=50um); a bare number is in the unit of the catalogue, what is not named keeps its start.
RequestedEffect read_effect(const std::string& text) {
  auto colon = text.find(':');
  const std::size_t first_end = std::min(text.find(',', colon), text.size());
  if (colon != std::string::npos && text.find('=', colon) > first_end &&
      !describe(effect_named(text.substr(0, colon))).forms.empty()) {
    colon = first_end;
  }
  RequestedEffect requested{effect_named(text.substr(0, colon)), {}};
  const EffectInfo info = describe(requested.effect);
  std::vector<std::string> names;
  for (const Parameter& parameter : info.parameters) {
    names.push_back(parameter.name);
    requested.values.push_back(parameter.start * parameter.si);
  }
  if (colon >= text.size()) return requested;
  const std::string form = info.spelled() + (info.option.empty() ? ":" : ",") + names.front() + "=VALUE";
  for (const auto& [name, value] : named_texts({text.substr(colon + 1)}, "--effect " + text, "written as " + form)) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw UsageError("the effect '" + info.key + "' has no parameter '" + name + "'; did you mean '" +
                       nearest_name(name, names) + "'?");
    }
    const auto k = static_cast<std::size_t>(found - names.begin());
    requested.values[k] = parameter_value(value, info.parameters[k], info.key + ":" + name);
  }
  return requested;
}

/// Effects with their values by key: the model puts them into its own order.
struct RequestedEffects {
  std::vector<Effect> effects;
  std::map<std::string, std::vector<double>> values;
};

RequestedEffects requested_effects(const MachineRequest& request, const Law& law) {
  RequestedEffects out;
  const auto add = [&](RequestedEffect requested) {
    out.values[describe(requested.effect).key] = std::move(requested.values);
    out.effects.push_back(std::move(requested.effect));
  };
  for (const std::string& text : request.effects) add(read_effect(text));
  for (const std::string& text : request.formulas) {
    RequestedEffect formula{Effect(Formula(text)), {}};
    for (const Parameter& p : describe(formula.effect).parameters) formula.values.push_back(p.start * p.si);
    add(std::move(formula));
  }
  refuse_clashes(out.effects, {law});
  return out;
}

/// "mu_s" is typed as --mu-s.
std::string flag_of(const std::string& parameter) {
  std::string flag = "--" + parameter;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

void set_law_parameters(const MachineRequest& request, const Law& law, std::vector<double>& p) {
  const std::vector<Parameter> parameters = describe(law).parameters;
  for (const auto& [name, text] : request.law_parameters) {
    if (text.empty()) continue;
    const auto found =
        std::find_if(parameters.begin(), parameters.end(),
                     [&, &wanted = name](const Parameter& parameter) { return parameter.name == wanted; });
    if (found == parameters.end()) {
      std::vector<std::string> flags;
      for (const Parameter& known : parameters) flags.push_back(flag_of(known.name));
      throw InputError("the law '" + std::string(to_string(law)) + "' has no parameter " + name +
                           ", which was given as " + flag_of(name),
                       "it takes " + listed(flags));
    }
    p[static_cast<std::size_t>(found - parameters.begin())] = parameter_value(text, *found, flag_of(name));
  }
}

void set_rig(const MachineRequest& request, Rig& rig) {
  if (!request.damping.empty() && !request.damping_ratio.empty()) {
    throw UsageError("--damping and --damping-ratio exclude each other; give one of them");
  }
  const double ratio = rig.damping_ratio();
  const bool other_block = !request.mass.empty() || !request.stiffness.empty();
  rig.mass = given_or(request.mass, Quantity::mass, "--mass", "kg", rig.mass);
  rig.stiffness = given_or(request.stiffness, Quantity::stiffness, "--stiffness", "N/mm", rig.stiffness);
  if (!request.damping.empty()) {
    rig.damping = stated_value(request.damping, Quantity::damping, "--damping", "N s/mm");
  } else if (other_block || !request.damping_ratio.empty()) {
    rig =
        rig_with_damping_ratio(rig.mass, rig.stiffness,
                               given_or(request.damping_ratio, Quantity::dimensionless, "--damping-ratio", "", ratio));
  }
}

}  // namespace
}  // namespace tribofit

using namespace tribofit;

bool is_linear_speed(const std::string& text) {
  const std::string unit = unit_of(text);
  return !unit.empty() && find_unit(unit, Quantity::velocity);
}

double disc_speed_from(const std::string& text, double radius, const std::string& option) {
  if (is_linear_speed(text)) return stated_value(text, Quantity::velocity, option) / radius;
  return stated_value(text, Quantity::angular_velocity, option, "rpm");
}

RequestedMachine machine_from(const MachineRequest& request) {
  const Law law = request.law.empty() ? law_catalogue().front() : law_named(request.law);
  const double radius = positive_value(request.radius, Quantity::length, "--radius", "mm");
  const PublishedTest test = published_test(radius, law);
  RequestedMachine out;
  out.preset_radius = test.radius;
  Machine& machine = out.machine;
  machine.radius = radius;
  machine.load = given_or(request.load, Quantity::force, "--load", "N", test.load);
  machine.speed = request.speed.empty() ? test.speed : disc_speed_from(request.speed, radius, "--speed");
  if (machine.speed == 0) {
    throw InputError("--speed: '" + request.speed + "' is zero: the disc stands still", "give it as e.g. 4rpm");
  }
  machine.rig = test.rig;
  set_rig(request, machine.rig);
  const RequestedEffects requested = requested_effects(request, law);
  machine.model = FrictionModel(law, requested.effects);
  machine.parameters = test.friction;
  set_law_parameters(request, law, machine.parameters);
  for (const std::string& key : machine.model.effect_keys()) {
    const std::vector<double>& values = requested.values.at(key);
    machine.parameters.insert(machine.parameters.end(), values.begin(), values.end());
  }
  return out;
}

Machine with_typed(Machine machine, const MachineRequest& request) {
  set_law_parameters(request, machine.model.law(), machine.parameters);
  set_rig(request, machine.rig);
  return machine;
}

namespace {

constexpr const char* kRigGroup = "Rig (default: the published test of the nearest radius, 4 rpm, 50 N)";

/// An option for every parameter that a law of the list has.
void add_law_parameters(const Command& group, MachineRequest& r) {
  std::vector<Parameter> parameters;
  std::map<std::string, std::string> laws;  // that have it
  for (const Law& law : law_catalogue()) {
    for (const Parameter& parameter : describe(law).parameters) {
      std::string& known = laws[parameter.name];
      if (known.empty()) parameters.push_back(parameter);
      known += (known.empty() ? "" : ", ") + std::string(to_string(law));
    }
  }
  for (const Parameter& p : parameters) {
    const std::string unit = p.unit == "1" ? "" : " [" + p.unit + "]";
    std::string help = p.description + unit + " (" + laws[p.name] + ")";
    help[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(help[0])));
    group.add_option(flag_of(p.name), r.law_parameters[p.name], help);
  }
}

}  // namespace

void add_machine_options(const Command& verb, MachineRequest& r) {
  const Command rig = verb.in(kRigGroup);
  rig.add_option("--radius", r.radius, "Friction radius").show_default();
  rig.add_option("--speed", r.speed, "Speed of the disc, e.g. 4rpm, or under the block, e.g. 6mm/s");
  rig.add_option("--load", r.load, "Normal force, e.g. 50N");
  add_machine_numbers(verb, r);
}

void add_machine_numbers(const Command& verb, MachineRequest& r) {
  const Command rig = verb.in(kRigGroup);
  rig.add_option("--mass", r.mass, "Moving mass, e.g. 0.85kg");
  rig.add_option("--stiffness", r.stiffness, "Stiffness of the spring, e.g. 16.2N/mm");
  rig.add_option("--damping", r.damping, "Damping of the block on its spring, e.g. 0.0047Ns/mm");
  rig.add_option("--damping-ratio", r.damping_ratio, "Damping as c/(2 sqrt(k m)), e.g. 0.02");
  const Command law = verb.in("Friction (default: the published values at the nearest radius)");
  law.add_option("--law", r.law, "Law of friction: " + list_of_laws() + " (default the first)");
  add_law_parameters(law, r);
  law.add_option("--effect", r.effects,
                 "KEY:name=value,... or KEY:FORM,name=value,... (repeatable; `identify effects` lists them)");
  law.add_option("--formula", r.formulas,
                 "A term of your own, e.g. 'hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s'");
}
