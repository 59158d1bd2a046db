#include "studied_machine.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "inputs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/terminal.hpp"
#include "tribofit/study/identified.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

/// An effect without a size changes nothing.
void refuse_effects_without_size(const std::vector<std::string>& effects) {
  for (const std::string& text : effects) {
    if (text.find('=') != std::string::npos) continue;
    const EffectInfo info = describe(effect_named(text));
    const Parameter& size = info.parameters.front();
    if (size.start == size.neutral) {
      throw UsageError("--effect " + text + " has no size; write it as " + text + ":" + size.name + "=VALUE");
    }
  }
}

StudiedMachine given(const Settings& settings, MachineRequest typed) {
  refuse_effects_without_size(typed.effects);
  if (!settings.radius.empty()) typed.radius = positive_value(settings.radius, Quantity::length, "--radius");
  typed.speed = settings.speed;
  const Condition& load = settings.identify.read.conditions.load;
  if (load.known()) typed.load = load.value;
  StudiedMachine out;
  out.machine = machine_from(typed).machine;
  out.source = "given values";
  return out;
}

/// Rows and columns of a covariance that are known exactly now.
void set_exact(std::vector<double>& covariance, std::size_t k) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(covariance.size()))));
  for (std::size_t i = 0; k < n && i < n; ++i) covariance[i * n + k] = covariance[k * n + i] = 0;
}

void forget_typed(const MachineRequest& typed, const FrictionModel& model, MachineCovariance& covariance) {
  for (std::size_t k = 0; k < model.base_count(); ++k) {
    if (typed.law_parameters.contains(model.parameters()[k].parameter.name)) set_exact(covariance.friction, k);
  }
  if (typed.mass) set_exact(covariance.rig, 0);
  if (typed.damping || typed.damping_ratio) set_exact(covariance.rig, 1);
  if (typed.stiffness) set_exact(covariance.rig, 2);
}

[[noreturn]] void refuse(const Identification& trace, const std::string& reason) {
  throw std::runtime_error(trace.path + ": no machine can be identified: " + reason);
}

/// The settings of a trace with law and effects as typed for the machine.
Settings settings_of_trace(Settings settings, const MachineRequest& typed) {
  for (const std::string& effect : typed.effects) {
    if (effect.find('=') == std::string::npos) continue;
    throw UsageError("--effect " + effect + ": beside a trace its values are identified; name the key alone");
  }
  settings.effects = typed.effects;
  settings.formulas = typed.formulas;
  if (typed.law_is_typed) settings.identify.laws = {typed.law};
  settings.protocol = to_string(Protocol::joint);
  return settings;
}

/// Refuses a trace of which no machine can be made.
void require_machine(const Identification& trace) {
  constexpr double kLargestGap = 0.15;  // of the plateau; beyond it the stated speed or radius is another
  if (!trace.analysed || trace.fits.empty())
    refuse(trace, trace.warnings.empty() ? "nothing was fitted" : trace.warnings.back());
  if (!trace.fits[trace.best].converged) refuse(trace, "the fit of the law did not converge");
  if (trace.motion.is_points()) refuse(trace, "points without time show no machine; give its numbers instead");
  if (trace.motion.disc_velocity.empty() && !(trace.motion.constant_disc_velocity > 0))
    refuse(trace, "the disc does not turn forwards, or its speed is not known");
  if (std::abs(trace.motion.plateau_ratio - 1) > kLargestGap) {
    throw InputError("the plateau of stick does not agree with --speed and --radius, which describe the record",
                     "leave --speed out; --range and --at study other speeds", {trace.path, 0, ""});
  }
}

/// The rig beside a law; one that could not be identified counts where all of it is typed.
RigFit rig_of(const Fit& fit, const Identification& trace, const Instruments& instruments,
              const MachineRequest& typed) {
  RigFit rig = rig_beside(fit, trace.motion, trace.segmentation, instruments);
  if (rig.per_unit_load && (typed.mass || typed.stiffness || typed.damping))
    throw InputError("no normal force is known, and a mass, stiffness or damping was given", "state --load");
  if (!rig.determined && typed.mass && typed.stiffness && (typed.damping || typed.damping_ratio)) {
    rig.determined = true;
    rig.mass.value = rig.stiffness.value = rig.damping.value = 1;
    rig.covariance = {};
  }
  return rig;
}

/// The diagnosis of the record, with the options that say how it is read and what is known of it.
std::string diagnose_command(const std::string& path, const Command& kind) {
  const auto of_record = [](const Command::Typed& option) {
    return option.section == section::kConditions || option.section == section::kReading || option.name == "--law" ||
           option.name == "--effect" || option.name == "--formula";
  };
  std::string command = "identify diagnose";
  for (const std::string& word : kind.own_options(of_record)) command += " " + shell_quoted(word);
  return command + " " + shell_quoted(path);
}

StudiedMachine identified(const Settings& settings, const MachineRequest& typed, const Command& kind) {
  const Settings of_trace = settings_of_trace(settings, typed);
  IdentifyOptions options = options_from(of_trace);
  const Input input = only_input(of_trace, options.read, "study");
  options.read = input.trace.read;
  Identification trace = identify(input.trace.path, options);
  require_machine(trace);
  const bool placed = trace.motion.conditions.radius.known();
  if (!placed) trace.motion.conditions.radius.value = 1;
  const Fit& fit = trace.fits[trace.best];
  const RigFit rig = rig_of(fit, trace, options.instruments, typed);
  IdentifiedMachine found = identified_machine(fit, rig, trace.motion, trace.segmentation);
  if (!found.reason.empty()) refuse(trace, found.reason);

  StudiedMachine out;
  out.machine = with_typed(std::move(found.machine), typed);
  out.covariance = std::move(found.covariance);
  forget_typed(typed, out.machine.model, out.covariance);
  out.source = "identified from " + input.trace.path;
  if (std::isfinite(found.law_over_floor)) {
    out.warnings.push_back(
        other_machine_warning("these answers do", fit, found.law_over_floor, diagnose_command(input.trace.path, kind)));
  }
  out.notes = std::move(found.notes);
  if (rig.per_unit_load) {
    out.notes.push_back(
        "no normal force is known: forces, mass, damping, stiffness and energy are per newton of it "
        "(state --load)");
  }
  if (!placed)
    out.notes.push_back("no radius is known: disc speeds are given as omega r; rotational speeds have no meaning");
  out.record = std::make_shared<const Identification>(std::move(trace));
  return out;
}

}  // namespace

StudiedMachine studied_machine(const Settings& settings, const MachineRequest& typed, const Command& kind) {
  return settings.traces.empty() ? given(settings, typed) : identified(settings, typed, kind);
}

std::vector<std::string> shared_arguments(const Command& kind) {
  return kind.own_options([](const Command::Typed& option) { return option.section != section::kStudy; });
}
