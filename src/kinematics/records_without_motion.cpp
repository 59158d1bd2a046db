#include "records_without_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "corrections.hpp"
#include "health_checks.hpp"
#include "motion_channels.hpp"
#include "plateau_search.hpp"
#include "statistics/derivatives.hpp"
#include "tribofit/kinematics/health.hpp"

namespace tribofit::kinematics {

namespace {

/// What of the instruments bears on points: nothing that is a delay.
Instruments without_delays(Instruments instruments) {
  instruments.vibrometer.delay = instruments.vibrometer.low_pass = std::nullopt;
  instruments.force_sensor.bandwidth = std::nullopt;
  return instruments;
}

/// Gives friction the sign of v_r, where it was written as a size in both directions or with the other sign throughout.
void settle_signs(Motion& motion) {
  const auto& v = motion.relative_velocity;
  const auto any = [](const std::vector<double>& x, auto is) { return std::any_of(x.begin(), x.end(), is); };
  const auto below = [](double x) { return x < 0; };
  const auto above = [](double x) { return x > 0; };
  if (any(v, below) && any(v, above) && !any(motion.friction, below)) {
    for (std::size_t i = 0; i < v.size(); ++i) motion.friction[i] = std::copysign(motion.friction[i], v[i]);
    motion.notes.emplace_back("friction: written as a size in both directions; it was given the sign of v_r");
    return;
  }
  settle_friction_sign(motion, largest_of(v));
}

/// By v_r, then friction: at rest friction shows the direction.
void sort(Motion& motion) {
  std::vector<std::size_t> order(motion.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(motion.relative_velocity[a], motion.friction[a]) <
           std::pair(motion.relative_velocity[b], motion.friction[b]);
  });
  for (auto* channel :
       {&motion.friction, &motion.relative_velocity, &motion.friction_std_error, &motion.load, &motion.temperature}) {
    if (channel->empty()) continue;
    std::vector<double> sorted;
    for (const std::size_t i : order) sorted.push_back((*channel)[i]);
    *channel = std::move(sorted);
  }
}

/// Points that are one and the same are no more evidence than one of them.
HealthItem check_copies(const Motion& motion) {
  std::size_t copies = 0;
  for (std::size_t i = 1; i < motion.size(); ++i) {
    copies +=
        motion.relative_velocity[i] == motion.relative_velocity[i - 1] && motion.friction[i] == motion.friction[i - 1]
            ? 1U
            : 0U;
  }
  HealthItem item{health_check::kCopies, HealthItem::Status::ok, "no two points are the same"};
  if (copies == 0) return item;
  item.message = fmt::format("{} of {} points repeat another exactly", copies, motion.size());
  if (10 * copies > motion.size()) {
    item.status = HealthItem::Status::warning;
    item.message += ": copies are no further evidence, and the errors of the parameters come out too small";
  }
  return item;
}

}  // namespace

Motion motion_of_points(Trace trace, const Instruments& instruments, const MotionOptions& options) {
  require_channels(trace);
  take_conditions_from_instruments(trace.conditions, instruments.rig);
  Motion motion;
  motion.step = 1;
  take_kinds(trace, options.stick, motion);
  correct_declared(trace, without_delays(instruments), motion.step, motion.notes);
  motion.friction_std_error = std::move(trace.friction_std_error);
  take_channels(trace, motion);
  motion.conditions.speed = {};
  motion.steps = {{0, motion.size(), "", motion.conditions}};
  settle_signs(motion);
  sort(motion);
  motion.health = {check_copies(motion)};
  return motion;
}

Motion motion_of_force(Trace trace) {
  trace.velocity_kind = VelocityKind::relative;
  trace.velocity.assign(trace.size(), 0.0);
  require_channels(trace);
  Motion motion;
  motion.step = trace.interval();
  take_kinds(trace, {}, motion);
  const std::size_t lone = remove_lone_samples(trace.friction);
  if (lone > 0) motion.notes.push_back(fmt::format("{} lone samples were replaced by their neighbours", lone));
  take_channels(trace, motion);
  return motion;
}

}  // namespace tribofit::kinematics
