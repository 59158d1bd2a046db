#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "tribofit/friction/dynamics.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/segmentation/stroke_memory.hpp"

namespace tribofit {

/// Memories of a model that the simulation has room for.
inline constexpr std::size_t kMostMemories = 3;

/// State of the block: sqrt(k/m) x and x' [m/s both, so that one tolerance suits], then the memories of the law.
using BlockState = std::array<double, 2 + kMostMemories>;

/// What a simulation is of; shared by its parts.
struct Setup {
  Setup(const Rig& the_rig, Drive the_drive, const FrictionModel& model)
      : rig(the_rig),
        drive(std::move(the_drive)),
        constant_speed(drive.speed.constant ? drive.speed.speed(0) : 0),
        natural_frequency(rig.natural_frequency()),
        needs_angle(model.needs().angle),
        needs_distance(model.needs().distance),
        needs_strokes(model.needs().reversal_distance),
        needs_acceleration(model.needs().acceleration) {}

  Rig rig;
  Drive drive;
  double constant_speed;     ///< of the disc, where it is constant [rad/s]
  double natural_frequency;  ///< [rad/s]
  bool needs_angle, needs_distance, needs_strokes, needs_acceleration;

  double disc_speed(double t) const { return drive.speed.constant ? constant_speed : drive.speed.speed(t); }
  double disc_velocity(double t) const { return drive.radius * disc_speed(t); }
  double disc_acceleration(double t) const {
    return drive.speed.constant ? 0 : drive.radius * drive.speed.acceleration(t);
  }
  /// Way of the disc under the block since t = 0 [m].
  double disc_travel(double t) const { return drive.radius * drive.speed.angle(t); }
  double load(double t) const { return drive.load ? drive.load(t) : drive.mean_load; }
  double temperature(double t) const { return drive.temperature ? drive.temperature(t) : drive.mean_temperature; }
};

/// What a motion states of its drive.
void state_conditions(const Setup& setup, double rate, bool settled, SimulatedMotion& motion);
/// The sample of what drives the block, beside its own. disc: its speed and angle, too.
void write_conditions(const Setup& setup, double t, bool disc, SimulatedMotion& motion);

/// How far a motion has slid since it reversed, and the strokes before.
class StrokesSoFar {
 public:
  /// A slip begins, the same way as the one before or the other way.
  void go(double direction, double slid) {
    if (direction == direction_) return;
    if (std::isfinite(begin_)) memory_.end_stroke(slid - begin_);
    if (direction_ != 0) begin_ = slid;
    direction_ = direction;
  }
  /// Distances are counted from where `slid` was slid.
  void count_from(double slid) { begin_ -= slid; }
  /// Infinite before the first reversal.
  double gone(double slid) const { return slid - begin_; }
  std::span<const double> earlier() const { return memory_.lengths(); }

 private:
  double direction_ = 0, begin_ = -std::numeric_limits<double>::infinity();
  StrokeMemory memory_;
};

/// What friction depends on at time t, but for speed and acceleration.
inline SlidingState<double> surroundings(const Setup& setup, double t, double direction, double stick_time, double slid,
                                         const StrokesSoFar& strokes) {
  return {.velocity = 0,
          .direction = direction,
          .acceleration = 0,
          .time = std::max(t, 0.0),
          .angle = setup.needs_angle ? setup.drive.speed.angle(t) : 0,
          .distance = setup.needs_distance && t > 0 ? slid : 0,
          .reversal_distance = strokes.gone(slid),
          .earlier_strokes = strokes.earlier(),
          .stick_time = stick_time,
          .load = setup.load(t),
          .mean_load = setup.drive.mean_load,
          .temperature = setup.temperature(t),
          .mean_temperature = setup.drive.mean_temperature,
          .disc_speed = setup.disc_speed(t)};
}

/// The equations of motion while v_r keeps one direction.
///
/// Beyond v_r = 0 friction and rates are continued by point reflection, g(-w) = 2 g(0) - g(w): the right-hand side
/// keeps a continuous slope there, so a step that ends at v_r = 0 keeps the order of the integrator.
class SlipFlow {
 public:
  SlipFlow(const Setup& setup, const FrictionDynamics& friction) : setup_(setup), friction_(friction) {}

  /// Starts a slip at time t in state y: direction of v_r, stick time before it, distance slid so far [s, m].
  void begin(double t, const BlockState& y, double direction, double stick_time, double slid);

  double direction() const { return direction_; }
  double stick_time() const { return stick_time_; }
  /// Speed along the direction of the slip, d v_r [m/s].
  double slip_speed(double t, const BlockState& y) const { return direction_ * (setup_.disc_velocity(t) - y[1]); }
  /// Slid since the beginning of the simulation [m].
  double slid(double t, const BlockState& y) const;
  /// Strokes up to this slip; not kept where no effect needs them.
  const StrokesSoFar& strokes() const { return strokes_; }
  /// Their distances are counted from where `slid` was slid.
  void count_strokes_from(double slid) { strokes_.count_from(slid); }

  /// dy = dy/dt.
  void operator()(const BlockState& y, BlockState& dy, double t) const;
  /// Signed mu [1].
  double friction(double t, const BlockState& y) const;
  /// Sets the memories in y to those of steady sliding at the speed of y.
  void steady_memories(double t, BlockState& y) const;

 private:
  SlidingState<double> instant(double speed, double acceleration, double t, const BlockState& y) const;
  /// Friction at the slip speed `speed` >= 0, with the rates of the memories when asked for.
  double friction_at(double speed, double acceleration, double t, const BlockState& y, BlockState* dy) const;
  double acceleration(double mu, double t, const BlockState& y) const;

  const Setup& setup_;
  const FrictionDynamics& friction_;
  double direction_ = 1, stick_time_ = 0;
  double slid_before_ = 0, lag_before_ = 0;  ///< lag: way of the disc less that of the block
  StrokesSoFar strokes_;
};

}  // namespace tribofit
