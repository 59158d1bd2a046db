#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "counts.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

bool is_constant(const std::vector<double>& channel) {
  return std::all_of(channel.begin(), channel.end(), [&](double x) { return x == channel.front(); });
}

/// A block on its spring that slides at one speed: what its velocity does is within the noise of its reading.
bool slides_at_one_speed(const Motion& motion, const Segmentation& segmentation) {
  if (segmentation.kind != MotionKind::always_slipping || motion.velocity_kind != VelocityKind::block) return false;
  const std::vector<double> some = thinned(motion.relative_velocity, kinematics::kEnough);
  const double range = quantile(some, 0.995) - quantile(some, 0.005);
  return range < std::min(segmentation::kWidthOfNoise * motion.velocity_noise,
                          segmentation::kOneSpeed * std::abs(median(some)));
}

}  // namespace

std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation, bool must_slip) {
  if (motion.is_points() && motion.size() < segmentation::kFewestPoints)
    return {fmt::format("there are only {} points: too few for any law", motion.size())};
  if (motion.is_points() && !must_slip)
    return {"these are points without time: a rig shows in the motion of a record only"};
  if (motion.kind == RecordKind::motion_only && !must_slip)
    return {"friction was made of the motion with the stated mass and stiffness: it balances them whatever the rig is"};
  if (motion.kind == RecordKind::force_only)
    return {
        "friction alone was recorded: a law needs the sliding velocity (a column v_b, v_r, x_b or the disc's speed), "
        "or of a slider on a spring --kind spring-slider with --speed and --stiffness"};
  if (is_driven_in_steps(motion.kind))
    return {
        "a contact whose load point is driven in steps has no cycles: `identify` alone fits rate-and-state friction"};
  if (motion.kind == RecordKind::spring_slider && !must_slip)
    return {"the velocity was made from the pull with the stated stiffness: the pull balances it whatever the rig is"};
  if (!motion.is_points() && motion.size() < kinematics::kFewestSamples)
    return {fmt::format("there are only {} samples: too few for any analysis", motion.size())};
  std::vector<std::string> found;
  if (is_constant(motion.friction))
    found.emplace_back("friction is the same in every sample: the channel was not recorded");
  // A sliding speed that is the same throughout is what a drive was set to.
  const bool is_set = motion.velocity_kind == VelocityKind::fixed_block ||
                      (motion.velocity_kind == VelocityKind::relative && motion.relative_velocity.front() != 0);
  if (is_constant(motion.relative_velocity) && !motion.sticks && !is_set)
    found.emplace_back("the velocity is the same in every sample: the channel was not recorded");
  if (found.empty() && must_slip && segmentation.kind == MotionKind::always_sticking)
    found.emplace_back("nothing slips in this trace: there is no friction law to fit");
  if (found.empty() && must_slip && slides_at_one_speed(motion, segmentation))
    found.emplace_back(
        "the block slides at one speed, its velocity only has noise: friction at one speed shows no law of speed; take "
        "the means of several such runs as points");
  return found;
}

}  // namespace tribofit
