#include "slip_flow.hpp"
#include "limits.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit {

void state_conditions(const Setup& setup, double rate, bool settled, SimulatedMotion& motion) {
  const Drive& drive = setup.drive;
  motion.rate = rate;
  motion.settled = settled;
  motion.radius = drive.radius;
  if (drive.speed.constant) motion.stated_speed = setup.constant_speed;
  motion.mean_load = drive.mean_load;
  motion.mean_temperature = drive.mean_temperature;
}

void write_conditions(const Setup& setup, double t, bool disc, SimulatedMotion& motion) {
  if (disc) {
    motion.disc_speed.push_back(setup.drive.speed.speed(t));
    motion.disc_angle.push_back(setup.drive.speed.angle(t));
  }
  if (setup.drive.load) motion.load.push_back(setup.load(t));
  if (setup.drive.temperature) motion.temperature.push_back(setup.temperature(t));
}

void SlipFlow::begin(double t, const BlockState& y, double direction, double stick_time, double slid) {
  direction_ = direction;
  stick_time_ = stick_time;
  slid_before_ = slid;
  lag_before_ = setup_.disc_travel(t) - y[0] / setup_.natural_frequency;
  if (setup_.needs_strokes) strokes_.go(direction, slid);
}

double SlipFlow::slid(double t, const BlockState& y) const {
  // v_r keeps its sign, so the integral of |v_r| is the way of the disc less that of the block.
  const double lag = setup_.disc_travel(t) - y[0] / setup_.natural_frequency;
  return slid_before_ + std::abs(lag - lag_before_);
}

SlidingState<double> SlipFlow::instant(double speed, double block_acceleration, double t, const BlockState& y) const {
  const double way = setup_.needs_distance || setup_.needs_strokes ? slid(t, y) : 0;
  SlidingState<double> at = surroundings(setup_, t, direction_, stick_time_, way, strokes_);
  at.velocity = direction_ * speed;
  at.acceleration = block_acceleration;
  return at;
}

double SlipFlow::friction_at(double speed, double block_acceleration, double t, const BlockState& y,
                             BlockState* dy) const {
  const SlidingState<double> at = instant(speed, block_acceleration, t, y);
  const std::size_t memories = friction_.state_count();
  const std::span<const double> state(y.data() + 2, memories);
  if (dy != nullptr && memories > 0) friction_.rates(at, state, std::span<double>(dy->data() + 2, memories));
  return friction_.friction(at, state);
}

void SlipFlow::steady_memories(double t, BlockState& y) const {
  friction_.steady_states(instant(std::abs(slip_speed(t, y)), 0, t, y),
                          std::span<double>(y.data() + 2, friction_.state_count()));
}

double SlipFlow::acceleration(double mu, double t, const BlockState& y) const {
  const Rig& rig = setup_.rig;
  return (setup_.load(t) * mu - rig.damping * y[1]) / rig.mass - setup_.natural_frequency * y[0];
}

double SlipFlow::friction(double t, const BlockState& y) const {
  const double speed = slip_speed(t, y);
  double block_acceleration = 0;
  double mu = 0;
  // Where friction depends on the acceleration it makes, the two are found together, by iteration.
  for (int i = 0; i < kMostIterations; ++i) {
    mu = friction_at(std::abs(speed), block_acceleration, t, y, nullptr);
    if (speed < 0) mu = 2 * friction_at(0, block_acceleration, t, y, nullptr) - mu;
    const double next = acceleration(mu, t, y);
    const bool done = !setup_.needs_acceleration || std::abs(next - block_acceleration) <= 1e-13 * std::abs(next);
    block_acceleration = next;
    if (done) break;
  }
  return mu;
}

void SlipFlow::operator()(const BlockState& y, BlockState& dy, double t) const {
  dy.fill(0);
  double mu = 0;
  const double speed = slip_speed(t, y);
  if (setup_.needs_acceleration) {
    mu = friction(t, y);
    friction_at(std::abs(speed), acceleration(mu, t, y), t, y, &dy);
  } else {
    mu = friction_at(std::abs(speed), 0, t, y, &dy);
    if (speed < 0) {
      BlockState at_rest{};
      mu = 2 * friction_at(0, 0, t, y, &at_rest) - mu;
      for (std::size_t k = 2; k < dy.size(); ++k) dy[k] = 2 * at_rest[k] - dy[k];
    }
  }
  dy[0] = setup_.natural_frequency * y[1];
  dy[1] = acceleration(mu, t, y);
}

}  // namespace tribofit
