#include "simulation_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "slip_flow.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

namespace {

void check_law(const Law& law, std::span<const double> p) {
  if (is_possible(law, p)) return;
  const std::vector<Parameter> parameters = describe(law).parameters;
  throw InputError("friction at rest is not positive, or a parameter of the law that cannot be negative is: " +
                       list_of(parameters, [&](std::size_t k) { return p[k] / parameters[k].si; }),
                   "give values such as " + list_of(parameters, [&](std::size_t k) { return parameters[k].start; }));
}

void check_friction(const FrictionModel& model, std::span<const double> p) {
  require(p.size() == model.parameters().size(),
          "the model has " + std::to_string(model.parameters().size()) + " parameters, not " + std::to_string(p.size()),
          "give one value for each of model.parameters()");
  require(std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); }),
          "a parameter of the friction model is not finite", "give numbers");
  check_law(model.law(), p.first(model.base_count()));
  require(model.state_count() <= kMostMemories,
          "the model has " + std::to_string(model.state_count()) + " effects with a memory",
          "simulate with at most " + std::to_string(kMostMemories));
  for (std::size_t k = 0; k < model.effects().size(); ++k) {
    const EffectInfo info = describe(model.effects()[k]);
    if (info.group == EffectGroup::user) continue;
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
      const double value = p[model.offset(k) + i];
      const Parameter& q = info.parameters[i];
      require(q.lower > 0 ? value > 0 : q.lower < 0 || value >= 0,
              fmt::format("{} of the effect '{}' is {}", q.name, info.key,
                          value < 0 ? "negative: " + general(value / q.si) : "zero"),
              "`identify effects " + info.key + "` gives its plausible range");
    }
  }
}

void require_positive(double x, const char* unit, const char* what, const char* advice) {
  require(std::isfinite(x) && x > 0, fmt::format("{} is not positive: {}{}", what, general(x), unit), advice);
}

}  // namespace

std::string list_of(const std::vector<Parameter>& parameters, const std::function<double(std::size_t)>& value) {
  std::string text;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    text += (text.empty() ? "" : ", ") + parameters[k].name + " = " + general(value(k));
    if (parameters[k].unit != "1") text += " " + parameters[k].unit;
  }
  return text;
}

void require(bool good, const std::string& problem, const std::string& advice) {
  if (!good) throw InputError(problem, advice);
}

void require_not_negative(double x, const char* unit, const char* what, const char* advice) {
  require(std::isfinite(x) && x >= 0, fmt::format("{} is negative: {}{}", what, general(x), unit), advice);
}

void check_rig_and_drive(const Rig& rig, const Drive& drive) {
  require_positive(rig.mass, " kg", "the mass of the block", "give the moving mass in kg");
  require_positive(rig.stiffness, " N/m", "the stiffness", "give the spring's stiffness, e.g. 16.2 N/mm");
  require_not_negative(rig.damping, " N s/m", "the damping", "give zero or more");
  require_positive(drive.radius, " m", "the friction radius", "give it as e.g. 15mm");
  require_positive(drive.mean_load, " N", "the load", "give the normal force, e.g. 50N");
  require(drive.speed.speed && drive.speed.acceleration && drive.speed.angle, "the drive has no speed",
          "use constant_speed() or another profile");
}

void check_record(double duration, double rate, double settle, const std::optional<BlockStart>& start) {
  require_positive(duration, " s", "the duration", "give it as e.g. 20s");
  require_not_negative(rate, " Hz", "the sampling rate", "give it as e.g. 20kHz");
  require(rate == 0 || duration * rate >= 2, "the record holds fewer than two samples",
          "give a longer duration or a higher rate");
  require_not_negative(settle, " s", "the settling time", "give zero or more seconds");
  require(!start || (std::isfinite(start->displacement) && std::isfinite(start->velocity)),
          "the start of the block is not finite", "give a displacement and a velocity");
}

void check_simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                      const SimulationOptions& options) {
  check_rig_and_drive(rig, drive);
  check_record(options.duration, options.rate, options.settle, options.start);
  check_friction(model, p);
  require_positive(options.tolerance, "", "the tolerance", "1e-10 is usual");
  require_not_negative(options.max_step, " s", "the longest step", "0 leaves it to the simulation");
  require_not_negative(options.scatter.deviation, "", "the break-away scatter", "give zero or more");
  require(options.scatter.wander >= 0 && options.scatter.wander < 1,
          "the correlation of the break-away scatter is not within 0 (included) and 1", "0.7 is a slow wander");
}

}  // namespace tribofit
