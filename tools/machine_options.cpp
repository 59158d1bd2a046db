#include "machine_options.hpp"

#include <algorithm>
#include <map>

#include "settings.hpp"
#include "tribofit/friction/formula.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/output/text.hpp"
#include "typed_values.hpp"

namespace tribofit {
namespace {

/// An effect and its parameters in SI, in the order of its info().
struct RequestedEffect {
  Effect effect;
  std::vector<double> values;
};

RequestedEffect with_starts(Effect effect) {
  std::vector<double> values;
  for (const Parameter& parameter : describe(effect).parameters) values.push_back(parameter.start * parameter.si);
  return {std::move(effect), std::move(values)};
}

/// Reads "KEY" or "KEY:name=value,name=value", where a form of the effect may stand first
/// (rate-state:healing,D_c=50um); what is not named keeps its start.
RequestedEffect read_effect(const std::string& text) {
  auto colon = text.find(':');
  const std::size_t first_end = std::min(text.find(',', colon), text.size());
  if (colon != std::string::npos && text.find('=', colon) > first_end &&
      !describe(effect_named(text.substr(0, colon))).forms.empty()) {
    colon = first_end;
  }
  RequestedEffect requested = with_starts(effect_named(text.substr(0, colon)));
  const EffectInfo info = describe(requested.effect);
  std::vector<std::string> names;
  for (const Parameter& parameter : info.parameters) names.push_back(parameter.name);
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

/// "mu_s" is typed as --mu-s.
std::string flag_of(const std::string& parameter) {
  std::string flag = "--" + parameter;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

void set_law_parameters(const MachineRequest& request, const Law& law, std::vector<double>& p) {
  const std::vector<Parameter> parameters = describe(law).parameters;
  for (const auto& [name, value] : request.law_parameters) {
    const auto found = std::ranges::find(parameters, name, &Parameter::name);
    if (found == parameters.end()) {
      std::vector<std::string> flags;
      for (const Parameter& known : parameters) flags.push_back(flag_of(known.name));
      throw InputError("the law '" + std::string(to_string(law)) + "' has no parameter " + name +
                           ", which was given as " + flag_of(name),
                       "it takes " + listed(flags));
    }
    p[static_cast<std::size_t>(found - parameters.begin())] = value;
  }
}

void set_rig(const MachineRequest& request, Rig& rig) {
  if (request.damping && request.damping_ratio)
    throw UsageError("--damping and --damping-ratio exclude each other; give one of them");
  const double ratio = request.damping_ratio.value_or(rig.damping_ratio());
  const bool other_block = request.mass || request.stiffness;
  rig.mass = request.mass.value_or(rig.mass);
  rig.stiffness = request.stiffness.value_or(rig.stiffness);
  if (request.damping) {
    rig.damping = *request.damping;
  } else if (other_block || request.damping_ratio) {
    rig = rig_with_damping_ratio(rig.mass, rig.stiffness, ratio);
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
  return stated_value(text, Quantity::angular_velocity, option);
}

RequestedMachine machine_from(const MachineRequest& request) {
  const PublishedTest test = published_test(request.radius, request.law);
  Machine machine;
  machine.radius = request.radius;
  machine.load = request.load.value_or(test.load);
  machine.speed = request.speed.empty() ? test.speed : disc_speed_from(request.speed, machine.radius, "--speed");
  if (machine.speed == 0)
    throw InputError("--speed: '" + request.speed + "' is zero: the disc stands still", "give it as e.g. 4rpm");
  machine.rig = test.rig;
  set_rig(request, machine.rig);
  std::vector<Effect> effects;
  std::map<std::string, std::vector<double>> values;  // by key: the model puts effects into its own order
  const auto add = [&](const RequestedEffect& requested) {
    values[describe(requested.effect).key] = requested.values;
    effects.push_back(requested.effect);
  };
  for (const std::string& text : request.effects) add(read_effect(text));
  for (const std::string& text : request.formulas) add(with_starts(Effect(Formula(text))));
  refuse_clashes(effects, {request.law});
  machine.model = FrictionModel(request.law, effects);
  machine.parameters = test.friction;
  set_law_parameters(request, request.law, machine.parameters);
  for (const std::string& key : machine.model.effect_keys())
    machine.parameters.insert(machine.parameters.end(), values[key].begin(), values[key].end());
  return {std::move(machine), test.radius};
}

Machine with_typed(Machine machine, const MachineRequest& request) {
  set_law_parameters(request, machine.model.law(), machine.parameters);
  set_rig(request, machine.rig);
  return machine;
}

namespace {

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
    const auto read = [&r, p](const std::string& text) {
      r.law_parameters[p.name] = parameter_value(text, p, flag_of(p.name));
    };
    group.add_read(flag_of(p.name), read, capitalised(p.description + unit + " (" + laws[p.name] + ")"));
  }
}

}  // namespace

void add_machine_options(const Command& verb, MachineRequest& r) {
  const Command rig = verb.in(section::kRig);
  rig.add_number("--radius", positive(Quantity::length, "15mm"), r.radius, "Friction radius");
  rig.add_option("--speed", r.speed, "Speed of the disc, e.g. 4rpm, or under the block, e.g. 6mm/s");
  rig.add_number("--load", {Quantity::force}, r.load, "Normal force, e.g. 50N");
  add_machine_numbers(verb, r);
}

void add_machine_numbers(const Command& verb, MachineRequest& r) {
  const Command rig = verb.in(section::kRig);
  rig.add_number("--mass", {Quantity::mass}, r.mass, "Moving mass, e.g. 0.85kg");
  rig.add_number("--stiffness", {Quantity::stiffness}, r.stiffness, "Stiffness of the spring, e.g. 16.2N/mm");
  rig.add_number("--damping", {Quantity::damping}, r.damping, "Damping of the block on its spring, e.g. 0.0047Ns/mm");
  rig.add_number("--damping-ratio", {}, r.damping_ratio, "Damping as c/(2 sqrt(k m)), e.g. 0.02");
  const Command law = verb.in(section::kFriction);
  const auto read_law = [&r](const std::string& name) {
    r.law = as_usage([&] { return make_law(name); });
    r.law_is_typed = true;
  };
  law.add_read("--law", read_law, "Law of friction: " + list_of_laws() + " (default the first)");
  add_law_parameters(law, r);
  law.add_option("--effect", r.effects,
                 "KEY:name=value,... or KEY:FORM,name=value,... (repeatable; `identify effects` lists them)");
  law.add_option("--formula", r.formulas,
                 "A term of your own, e.g. 'hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s'");
}
