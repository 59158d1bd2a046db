#include "simulation_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "slip_flow.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

/// "mu_s = 0.5, mu_k = 0.3, alpha = 0.05 s/mm".
std::string example_of(const Law& law) {
  std::string text;
  for (const Parameter& parameter : describe(law).parameters) {
    text += (text.empty() ? "" : ", ") + fmt::format("{} = {:g}", parameter.name, parameter.start);
    if (parameter.unit != "1") text += " " + parameter.unit;
  }
  return text;
}

void check_friction(const FrictionModel& model, std::span<const double> p) {
  require(p.size() == model.parameters().size(),
          "the model has " + std::to_string(model.parameters().size()) + " parameters, not " + std::to_string(p.size()),
          "give one value for each of model.parameters()");
  require(std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); }),
          "a parameter of the friction model is not finite", "give numbers");
  require(is_possible(model.law(), p.first(model.base_count())),
          "friction at rest is not positive, or a parameter of the law that cannot be negative is",
          "give values such as " + example_of(model.law()));
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
              q.name + " of the effect '" + info.key + "' is " + (value < 0 ? "negative" : "zero"),
              "`identify effects " + info.key + "` gives its plausible range");
    }
  }
}

bool positive(double x) {
  return std::isfinite(x) && x > 0;
}
bool not_negative(double x) {
  return std::isfinite(x) && x >= 0;
}

}  // namespace

void require(bool good, const std::string& problem, const std::string& advice) {
  if (!good) throw InputError(problem, advice);
}

void check_rig_and_drive(const Rig& rig, const Drive& drive) {
  require(positive(rig.mass), "the mass of the block is not positive", "give the moving mass in kg");
  require(positive(rig.stiffness), "the stiffness is not positive", "give the spring's stiffness, e.g. 16.2 N/mm");
  require(not_negative(rig.damping), "the damping is negative", "give zero or more");
  require(positive(drive.radius), "the friction radius is not positive", "give it as e.g. 15mm");
  require(positive(drive.mean_load), "the load is not positive", "give the normal force, e.g. 50N");
  require(drive.speed.speed && drive.speed.acceleration && drive.speed.angle, "the drive has no speed",
          "use constant_speed() or another profile");
}

void check_record(double duration, double rate, double settle, const std::optional<BlockStart>& start) {
  require(positive(duration), "the duration is not positive", "give it as e.g. 20s");
  require(not_negative(rate), "the sampling rate is negative", "give it as e.g. 20kHz");
  require(rate == 0 || duration * rate >= 2, "the record holds fewer than two samples",
          "give a longer duration or a higher rate");
  require(not_negative(settle), "the settling time is negative", "give zero or more seconds");
  require(!start || (std::isfinite(start->displacement) && std::isfinite(start->velocity)),
          "the start of the block is not finite", "give a displacement and a velocity");
}

void check_simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                      const SimulationOptions& options) {
  check_rig_and_drive(rig, drive);
  check_record(options.duration, options.rate, options.settle, options.start);
  check_friction(model, p);
  require(positive(options.tolerance), "the tolerance is not positive", "1e-10 is usual");
  require(not_negative(options.max_step), "the longest step is negative", "0 leaves it to the simulation");
  require(not_negative(options.scatter.deviation), "the break-away scatter is negative", "give zero or more");
  require(options.scatter.wander >= 0 && options.scatter.wander < 1,
          "the correlation of the break-away scatter is not within 0 (included) and 1", "0.7 is a slow wander");
}

}  // namespace tribofit
