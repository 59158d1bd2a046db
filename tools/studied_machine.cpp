#include "studied_machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "inputs.hpp"
#include "options.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/study/identified.hpp"

using namespace tribofit;

namespace {

/// An effect that does nothing until it has a size would be studied in vain.
void refuse_effects_without_size(const std::vector<std::string>& effects) {
  for (const std::string& text : effects) {
    if (text.find('=') != std::string::npos) continue;
    const EffectInfo info = describe(effect_named(text));
    const Parameter& size = info.parameters.front();
    if (size.start == size.neutral) {
      throw CLI::ValidationError("--effect " + text + " has no size; write it as " + text + ":" + size.name + "=VALUE");
    }
  }
}

StudiedMachine given(const Settings& settings, MachineRequest typed) {
  refuse_effects_without_size(typed.effects);
  if (!settings.radius.empty()) typed.radius = settings.radius;
  typed.speed = settings.speed;
  typed.load = settings.load;
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

void forget_typed(const MachineRequest& typed, MachineCovariance& covariance) {
  if (!typed.mu_s.empty()) set_exact(covariance.friction, 0);
  if (!typed.mu_k.empty()) set_exact(covariance.friction, 1);
  if (!typed.alpha.empty() || !typed.beta.empty()) set_exact(covariance.friction, 2);
  if (!typed.mass.empty()) set_exact(covariance.rig, 0);
  if (!typed.damping.empty() || !typed.damping_ratio.empty()) set_exact(covariance.rig, 1);
  if (!typed.stiffness.empty()) set_exact(covariance.rig, 2);
}

StudiedMachine identified(const Settings& settings, const MachineRequest& typed) {
  Settings of_trace = settings;
  for (const std::string& effect : typed.effects) {
    if (effect.find('=') != std::string::npos) {
      throw CLI::ValidationError("--effect " + effect +
                                 ": beside a trace its values are identified; name the key alone");
    }
  }
  of_trace.effects = typed.effects;
  of_trace.formulas = typed.formulas;
  if (!typed.law.empty()) of_trace.laws = {typed.law};
  of_trace.protocol = "joint";
  IdentifyOptions options = options_from(of_trace);
  const Input input = only_input(of_trace, options.read, "study");
  options.read = input.trace.read;
  Identification trace = identify(input.trace.path, options);
  const auto refuse = [&](const std::string& reason) {
    throw std::runtime_error(input.trace.path + ": no machine can be identified: " + reason);
  };
  if (!trace.analysed || trace.fits.empty())
    refuse(trace.warnings.empty() ? "nothing was fitted" : trace.warnings.back());
  const Fit& fit = trace.fits[trace.best];
  if (!fit.converged) refuse("the fit of the law did not converge");
  if (trace.motion.disc_velocity.empty() && !(trace.motion.constant_disc_velocity > 0)) {
    refuse("the disc does not turn forwards, or its speed is not known");
  }
  const bool placed = trace.motion.conditions.radius.known();
  if (!placed) trace.motion.conditions.radius.value = 1;
  constexpr double kOther = 0.15;
  if (std::abs(trace.motion.plateau_ratio - 1) > kOther) {
    throw InputError("the plateau of stick is not that of --speed and --radius, which describe the record",
                     "leave --speed out; --range and --at study other speeds", {input.trace.path, 0, ""});
  }
  RigFit rig = rig_beside(fit, trace.motion, trace.segmentation, options.instruments);
  const bool any_typed = !typed.mass.empty() || !typed.stiffness.empty() || !typed.damping.empty();
  if (rig.per_unit_load && any_typed) {
    throw InputError("no normal force is known, and a mass, stiffness or damping was given", "state --load");
  }
  const bool damping_typed = !typed.damping.empty() || !typed.damping_ratio.empty();
  if (!rig.determined && !typed.mass.empty() && !typed.stiffness.empty() && damping_typed) {
    rig.determined = true;  // all of it is given
    rig.mass.value = rig.stiffness.value = rig.damping.value = 1;
    rig.covariance = {};
  }
  IdentifiedMachine found = identified_machine(fit, rig, trace.motion, trace.segmentation);
  if (!found.reason.empty()) refuse(found.reason);

  StudiedMachine out;
  out.machine = std::move(found.machine);
  out.covariance = std::move(found.covariance);
  out.notes = std::move(found.notes);
  out.machine = with_typed(std::move(out.machine), typed);
  forget_typed(typed, out.covariance);
  out.source = "identified from " + input.trace.path;
  if (rig.per_unit_load) {
    out.notes.push_back(
        "no normal force is known: forces, mass, damping, stiffness and energy are per newton of it "
        "(state --load)");
  }
  if (!placed) out.notes.push_back("no radius is known: speeds of the disc are omega r, rotational ones mean nothing");
  out.record = std::make_shared<const Identification>(std::move(trace));
  return out;
}

}  // namespace

StudiedMachine studied_machine(const Settings& settings, const MachineRequest& typed) {
  return settings.traces.empty() ? given(settings, typed) : identified(settings, typed);
}

std::vector<std::string> shared_arguments(const CLI::App& kind) {
  static constexpr std::array<std::string_view, 11> kOwn = {"--range",     "--at",      "--points", "--cycles",
                                                            "--harmonics", "--vary",    "--factor", "--x",
                                                            "--y",         "--measure", "--threads"};
  std::vector<std::string> out;
  const std::vector<std::string> all = own_options(kind);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::find(kOwn.begin(), kOwn.end(), all[i]) != kOwn.end()) {
      ++i;  // and its value
    } else {
      out.push_back(all[i]);
    }
  }
  return out;
}
