#include "force_alone.hpp"

#include <fmt/format.h>

#include <utility>

#include "motion_channels.hpp"
#include "statistics/local_derivatives.hpp"

namespace tribofit::kinematics {

Motion motion_of_force(Trace trace) {
  trace.velocity_kind = VelocityKind::relative;
  trace.velocity.assign(trace.size(), 0.0);
  require_channels(trace);
  Motion motion;
  motion.step = trace.interval();
  take_kinds(trace, {}, motion);
  const std::size_t lone = remove_lone_samples(trace.friction);
  if (lone > 0) motion.notes.push_back(fmt::format("{} lone samples were replaced by their neighbours", lone));
  motion.time = std::move(trace.time);
  motion.friction = std::move(trace.friction);
  motion.relative_velocity = std::move(trace.velocity);
  motion.load = std::move(trace.load);
  motion.temperature = std::move(trace.temperature);
  motion.conditions = trace.conditions;
  motion.steps = std::move(trace.steps);
  if (motion.steps.empty()) motion.steps = {{0, motion.size(), "", motion.conditions}};
  return motion;
}

}  // namespace tribofit::kinematics
