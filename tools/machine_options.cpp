#include "machine_options.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "exit_status.hpp"
#include "parameter_options.hpp"
#include "stated_value.hpp"
#include "tribofit/friction/formula.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"

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
  std::size_t begin = colon == std::string::npos ? text.size() : colon + 1;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const auto equals = part.find('=');
    if (equals == std::string::npos) {
      throw UsageError("'" + part + "' in --effect " + text + " is not name=value; write it as " + info.spelled() +
                       (info.option.empty() ? ":" : ",") + names.front() + "=VALUE");
    }
    const auto found = std::find(names.begin(), names.end(), part.substr(0, equals));
    if (found == names.end()) {
      throw UsageError("the effect '" + info.key + "' has no parameter '" + part.substr(0, equals) +
                       "'; did you mean '" + nearest_name(part.substr(0, equals), names) + "'?");
    }
    const auto k = static_cast<std::size_t>(found - names.begin());
    const Parameter& parameter = info.parameters[k];
    const std::optional<Unit> unit = find_unit(parameter.unit);
    requested.values[k] = stated_value(part.substr(equals + 1), unit ? unit->quantity : Quantity::dimensionless,
                                       info.key + ":" + parameter.name, parameter.unit);
  }
  return requested;
}

Law read_law(const std::string& name) {
  try {
    return make_law(name);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

/// Effects with their values by key: the model puts them into its own order.
struct RequestedEffects {
  std::vector<Effect> effects;
  std::map<std::string, std::vector<double>> values;
};

RequestedEffects requested_effects(const MachineRequest& request, const Law& law) {
  RequestedEffects out;
  for (const std::string& text : request.effects) {
    const RequestedEffect requested = read_effect(text);
    out.effects.push_back(requested.effect);
    out.values[describe(requested.effect).key] = requested.values;
  }
  for (const std::string& text : request.formulas) {
    const Formula formula(text);
    const EffectInfo info = formula.info();
    out.effects.emplace_back(formula);
    out.values[info.key] = {};  // it may have no parameters
    for (const Parameter& parameter : info.parameters) out.values[info.key].push_back(parameter.start * parameter.si);
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
      std::string list;
      for (const Parameter& known : parameters) list += (list.empty() ? "" : ", ") + flag_of(known.name);
      throw InputError("the law '" + std::string(to_string(law)) + "' has no parameter " + name +
                           ", which was given as " + flag_of(name),
                       "it takes " + list);
    }
    const Unit unit = find_unit(found->unit).value_or(Unit{Quantity::dimensionless, 1, 0});
    p[static_cast<std::size_t>(found - parameters.begin())] =
        stated_value(text, unit.quantity, flag_of(name), found->unit == "1" ? "" : found->unit);
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
  const std::size_t end = text.find_last_of("0123456789.");
  const std::string unit = end == std::string::npos ? "" : text.substr(end + 1);
  const std::optional<Unit> known = find_unit(unit);
  return !unit.empty() && known && known->quantity == Quantity::velocity;
}

double disc_speed_from(const std::string& text, double radius, const std::string& option) {
  if (is_linear_speed(text)) return stated_value(text, Quantity::velocity, option) / radius;
  return stated_value(text, Quantity::angular_velocity, option, "rpm");
}

RequestedMachine machine_from(const MachineRequest& request) {
  const Law law = request.law.empty() ? law_catalogue().front() : read_law(request.law);
  const double radius = stated_value(request.radius, Quantity::length, "--radius", "mm");
  const PublishedTest test = published_test(radius, law);
  RequestedMachine out;
  out.preset_radius = test.radius;
  Machine& machine = out.machine;
  machine.radius = radius;
  machine.load = given_or(request.load, Quantity::force, "--load", "N", test.load);
  if (!(radius > 0)) throw InputError("--radius: '" + request.radius + "' is not greater than zero", "give it as 15mm");
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
void add_law_parameters(const Command& verb, const char* group, MachineRequest& r) {
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
    verb.add_option(flag_of(p.name), r.law_parameters[p.name], help).group(group);
  }
}

}  // namespace

void add_machine_options(const Command& verb, MachineRequest& r) {
  verb.add_option("--radius", r.radius, "Friction radius").show_default().group(kRigGroup);
  verb.add_option("--speed", r.speed, "Speed of the disc, e.g. 4rpm, or under the block, e.g. 6mm/s").group(kRigGroup);
  verb.add_option("--load", r.load, "Normal force, e.g. 50N").group(kRigGroup);
  add_machine_numbers(verb, r);
}

void add_machine_numbers(const Command& verb, MachineRequest& r) {
  const auto group = [&verb](const char* name, const char* flag, auto& value, const std::string& help) {
    return verb.add_option(flag, value, help).group(name);
  };
  const char* rig = kRigGroup;
  group(rig, "--mass", r.mass, "Moving mass, e.g. 0.85kg");
  group(rig, "--stiffness", r.stiffness, "Stiffness of the spring, e.g. 16.2N/mm");
  group(rig, "--damping", r.damping, "Damping of the block on its spring, e.g. 0.0047Ns/mm");
  group(rig, "--damping-ratio", r.damping_ratio, "Damping as c/(2 sqrt(k m)), e.g. 0.02");
  const char* law = "Friction (default: the published values at the nearest radius)";
  group(law, "--law", r.law, "Law of friction: " + list_of_laws() + " (default the first)");
  add_law_parameters(verb, law, r);
  group(law, "--effect", r.effects,
        "KEY:name=value,... or KEY:FORM,name=value,... (repeatable; `identify effects` lists them)")
      .one_value_each();
  group(law, "--formula", r.formulas,
        "A term of your own, e.g. 'hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s'")
      .one_value_each();
}
