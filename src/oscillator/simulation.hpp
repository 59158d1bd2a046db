#pragma once

#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "normal_stream.hpp"
#include "slip_flow.hpp"
#include "tribofit/friction/dynamics.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// One run of simulate(): rigid stick and slip by turns, with the events between them located, or, where the law acts
/// in stick, one motion in which slips are recognised.
class Simulation {
 public:
  Simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
             const SimulationOptions& options);
  SimulatedMotion run();

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  void begin_in_slip(int direction);
  void advance(double until);
  void stick(double until);
  void slip(double until);
  bool try_step(double h);
  double land_on_zero_speed(double h);
  void end_slip();
  void count_step();
  void turn_round();
  void confirm_creeping_slip(double restick_time);
  void note_extremes(double h);
  void watch_creep(double h);
  void end_creeping_slip(double restick_time);

  /// Of the slip under way.
  std::vector<double> earlier_strokes() const {
    const std::span<const double> lengths = flow_.strokes().earlier();
    return {lengths.begin(), lengths.end()};
  }

  double spring_pull(double x, double t) const;
  double gap_to_break_away(double t);
  double stuck_position(double t) const { return stick_position_ + setup_.disc_travel(t) - stick_travel_; }
  void begin_stick();
  void break_away();
  BlockState dense(double t, double h) const;
  void reserve_samples();
  void sample_stick(double until);
  void sample_slip(double h);
  void write_sample(double t, double x, double v, double friction, bool sticks);
  void write_distance(double slid);

  const SimulationOptions options_;
  Setup setup_;
  FrictionDynamics friction_;
  SlipFlow flow_;
  CorrelatedStream scatter_;
  mutable boost::numeric::odeint::runge_kutta_dopri5<BlockState> stepper_;
  SimulatedMotion motion_;

  double time_ = 0;
  bool sticking_ = true;
  double slid_ = 0;        ///< up to the last event [m]
  double peak_speed_ = 0;  ///< since the slip began [m/s]
  std::size_t next_sample_ = 0, samples_ = 0, steps_ = 0;

  // In rigid stick.
  double stick_begin_ = 0, stick_position_ = 0, stick_travel_ = 0, march_ = 0;
  double earliest_break_away_ = -std::numeric_limits<double>::infinity();

  // In slip: the last accepted state with its derivative, and what try_step() made of it.
  BlockState state_{}, derivative_{}, next_state_{}, next_derivative_{};
  double step_ = 0, most_step_ = 0, absolute_tolerance_ = 0, scaled_error_ = 0;

  // Where the law acts in stick: from the last reversal.
  double reversal_time_ = 0, slid_at_reversal_ = 0, creep_end_ = 0, friction_at_creep_end_ = 0, least_slip_ = 0;
  /// When |v_r| fell below half the disc's speed, where nothing but that ends a slip.
  double slow_again_ = kNaN;
};

}  // namespace tribofit
