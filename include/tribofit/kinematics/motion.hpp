#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/instruments/static_response.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/statistics/estimate.hpp"

namespace tribofit {

/// A disc whose speed follows its angle: omega (1 + amplitude cos(order theta + phase)), omega the stated speed, theta
/// either omega t or the angle turned (their integral), whichever fits the plateaus better; theta = 0 at the trace's
/// first sample.
struct DiscRipple {
  double amplitude = 0;  ///< [1]; 0: none
  int order = 0;         ///< periods in a revolution
  double phase = 0;      ///< [rad] in (-pi, pi]
  double amplitude_std_error = 0, phase_std_error = 0;
};

/// What is made of a plateau of v_b that is not omega r.
enum class PlateauCorrection {
  none,    ///< left as it is
  radius,  ///< the radius (or the speed) is another: omega r times the ratio
  gain,    ///< the vibrometer reads too much or too little: v_b over the ratio
};

/// Which records say whether the friction channel is a low-pass.
enum class FilterSource {
  unknown,      ///< it was not looked for, or too few re-sticks show it
  this_record,  ///< its re-sticks show one, or none
  other_runs    ///< other runs of the same sensor do
};

/// Bits of Motion::faults. The motion is not known in a stretch: the cycles that reach into it are not used.
struct SampleFault {
  static constexpr std::uint8_t friction = 1, velocity = 2, stretch = 4, any = 7;
};

/// What counts as stick, where the user says it.
struct StickRule {
  bool never = false;   ///< nothing sticks: every sample slides, however slowly
  bool always = false;  ///< it sticks and slips: what is slow beside the slips is stick
  double below = 0;     ///< |v_r| below which the block sticks [m/s]; 0: found from the record
};

/// A trace turned into relative motion: instruments corrected, run-up trimmed, v_r computed.
///
/// v_r = omega r - v_b ([D] Eq 4). Points (is_points()) have no time: their samples are sorted by v_r and numbered. All
/// vectors have the same length; optional channels are empty when absent.
struct Motion {
  double step = 0;                        ///< sampling interval [s]
  std::vector<double> time;               ///< [s] from the trace's first sample (not from the trimmed start)
  std::vector<double> friction;           ///< mu [1], or force [N] (see friction_kind); positive when v_r is
  std::vector<double> relative_velocity;  ///< v_r [m/s]
  std::vector<double> disc_velocity;      ///< omega r [m/s]; empty when it is constant
  /// omega r [m/s] where disc_velocity is empty, or without its ripple where one was undone; 0 when v_r was measured
  /// without a speed.
  double constant_disc_velocity = 0;

  /// As in Trace; where a ripple of the speed was undone, disc_speed holds it and disc_angle its integral.
  std::vector<double> load, temperature, disc_speed, disc_angle;

  /// Standard error of friction [1 or N] and of v_r [m/s] at every sample, where it is stated or follows from how they
  /// were made; empty: not known.
  std::vector<double> friction_std_error, velocity_std_error;

  std::vector<double> acceleration, velocity_variance;  ///< as in Trace; of the block, of v_r within a sample
  double smoothing = 0;                                 ///< as in Trace [s]

  /// Of velocity steps and holds: how the load point moved, its first phase from the first sample on. The speed of the
  /// contact is not known there; relative_velocity is that of the load point.
  std::vector<LoadPointPhase> load_point;
  LoadPointSource load_point_source = LoadPointSource::displacement;
  Condition normal_stress;  ///< as in Trace [Pa]

  std::optional<RecordKind> kind;  ///< as in Trace
  std::string kind_source;         ///< as in Trace
  SpringDrive spring;              ///< of a spring slider
  FrictionKind friction_kind = FrictionKind::coefficient;
  VelocityKind velocity_kind = VelocityKind::block;
  Conditions conditions;    ///< speed and its source filled in, from the plateau where nobody said it
  std::vector<Step> steps;  ///< in samples of this Motion

  std::size_t trimmed = 0;      ///< samples of the run-up that were cut off
  double velocity_noise = 0;    ///< standard deviation of v_r in stick [m/s]; from local roughness where nothing sticks
  double plateau_velocity = 0;  ///< robust centre of v_r in stick [m/s]; 0 where nothing sticks
  double high_pass = 0;         ///< corner of the vibrometer high-pass that was undone [Hz]; 0: none
  double high_pass_std_error = 0;  ///< [Hz]
  bool friction_drives = false;    ///< it is negative in slip though its sign is right: its zero is not
  // What channels did to their readings, found in the record and put right; 0: none.
  Estimate velocity_zero;      ///< that was taken off v_b [m/s]
  Estimate velocity_low_pass;  ///< time constant of a first-order low-pass that was undone [s]
  /// The same of friction [s], which stays as it was read: a law is evaluated and then filtered.
  Estimate friction_low_pass;
  FilterSource friction_filter_source = FilterSource::unknown;
  UndoneResponse velocity_response, friction_response;
  Estimate clock_drift;               ///< by which friction fell behind the velocity, over time [1]
  double restick_delay = 0;           ///< by which friction jumps after v_r rests or turns round [s]; 0: not known
  bool sticks = false;                ///< the trace has a plateau of stick
  StickRule stick;                    ///< as the user said
  double clock_offset_std_error = 0;  ///< as in Trace [s]; NaN: not known
  DiscRipple speed_ripple;            ///< found on the plateaus and undone
  /// By how much omega r falls with friction, over what it is without [1 over the unit of friction], and the time
  /// constant within which it does [s]: found on the plateaus, omega r follows it. 0: none.
  Estimate drive_compliance;
  double drive_time = 0;
  Estimate velocity_crosstalk;  ///< reading of v_b for a unit of friction [m/s], taken off; 0: none

  /// Plateau of v_b over the stated omega r, creep of the contact taken off, and its standard error from stick to
  /// stick. Radius (or speed) and gain of the vibrometer show in it alike. NaN where no radius and speed were stated,
  /// where v_r was measured, or where too little sticks.
  double plateau_ratio = std::numeric_limits<double>::quiet_NaN();
  double plateau_ratio_std_error = std::numeric_limits<double>::quiet_NaN();
  /// The same of v_r as it stands: near 1 where a high-pass was undone, whose integration constant was set to omega r.
  double plateau_ratio_in_motion = std::numeric_limits<double>::quiet_NaN();
  PlateauCorrection plateau_correction = PlateauCorrection::none;  ///< what was done about it
  double corrected_ratio = 1;                                      ///< the ratio that was corrected; 1: none

  /// Of every sample, which of its channels a fault of the recording spoilt (bits of SampleFault); empty: none. Values
  /// there are straight lines between good neighbours, so that the rest of the record is not disturbed; they take no
  /// part in a fit.
  std::vector<std::uint8_t> faults;

  std::vector<HealthItem> health;  ///< in a fixed order, one per check
  std::vector<std::string> notes;  ///< corrections made and conventions settled, for the report

  std::size_t size() const { return time.size(); }
  bool is_points() const { return kind == RecordKind::points; }
  bool has_fault(std::size_t i, std::uint8_t kinds) const { return !faults.empty() && (faults[i] & kinds) != 0; }
  double disc_velocity_at(std::size_t i) const {
    return disc_velocity.empty() ? constant_disc_velocity : disc_velocity[i];
  }
  double duration() const { return time.empty() ? 0 : time.back() - time.front() + step; }
};

struct MotionOptions {
  bool trim = true;            ///< cut the run-up where the plateau is not within 2 % of its final value
  bool undo_high_pass = true;  ///< undo a first-order high-pass found on the velocity
  bool undo_speed_ripple =
      true;  ///< let omega r follow a ripple, or a drive that friction slows, found on the plateaus
  bool undo_distortions =
      true;  ///< zero, crosstalk, low-pass and response of the velocity, response of friction, clocks
  /// Move friction by the delay of a declared bandwidth; false: the model that is fitted holds the filter itself.
  bool undo_bandwidth = true;
  PlateauCorrection plateau = PlateauCorrection::none;
  StickRule stick = {};
  int threads = 1;  ///< that look at friction and velocity side by side; 0: as many as there are
  /// Of the friction channel, as other runs of the same sensor show it [s] (0: they show none); nothing: looked for.
  std::optional<Estimate> friction_low_pass = {};
};

/// Computes the motion: declared instrument corrections first, then high-pass, zero and speed, v_r, health. Samples
/// that the recording spoilt (markers, spikes, frozen and clipped stretches, standstill) are marked in `faults`. A
/// block on a spring goes nowhere: a mean of v_b that agrees with a plateau off omega r is a wrong zero and is taken
/// off. Steps of the disc's speed that nobody stated follow from the plateaus, each with its own level.
///
/// The plateau of stick (the level on which v_b rests, found as the half-sample mode of block means) gives the speed
/// where nobody said it, the noise of v_r, the direction of the vibrometer and, by its sag dv_m/dt = -2 pi f_c v_m, an
/// undeclared high-pass. A high-pass is undone by v_b = v_m + 2 pi f_c integral(v_m) dt; the integration constant comes
/// from omega r, or from no net displacement of the block, and a straight drift from the levels of the plateaus.
///
/// Where the speed of the disc is stated and not recorded, and two revolutions are, the levels of the plateaus over the
/// angle omega t show a ripple of the speed (kinematics/rest_model.hpp says when it counts); omega r, the disc's speed
/// and angle then follow it. The plateau against the stated omega r is reported as plateau_ratio: a wrong radius and a
/// wrong gain of the vibrometer look alike in it, so that it is only corrected when asked (options.plateau). Order:
/// sign, high-pass, ripple, run-up, plateau. Behind a high-pass the level of the plateau is not in the record; the
/// ratio then follows from no net displacement of the block.
///
/// `trace` is consumed so that no channel is held twice. Throws InputError when v_r cannot be made: channels missing,
/// or neither speed and radius nor a plateau. Of points only v_r and the declared zero, gain and crosstalk of the force
/// sensor are settled. A spring slider is a block on its spring, seen from the driven end
/// (kinematics/spring_slider.hpp). Cost: about six passes over the samples.
Motion compute_motion(Trace trace, const Instruments& instruments = {}, const MotionOptions& options = {});

/// Puts the plateau of a motion right whose plateau was left as it is, as compute_motion() does with
/// MotionOptions::plateau: `radius` scales omega r, `gain` divides v_b. Says so in its notes; without a known ratio
/// nothing is done. Cost: one pass over the samples.
void correct_plateau(Motion& motion, PlateauCorrection correction);

/// Block acceleration a_b = -dv_r/dt + d(omega r)/dt [m/s^2] by a Savitzky-Golay derivative (quadratic, 2*half_window+1
/// samples).
std::vector<double> block_acceleration(const Motion& motion, std::size_t half_window = 10);

/// Disc angle [rad] of every sample: measured where there is a channel, else the integral of the disc speed from
/// the trace's first sample. Empty when neither is known.
std::vector<double> disc_angle(const Motion& motion);

/// Sliding distance [m]: the integral of |v_r| from the first sample, without stick (|v_r| below the noise).
std::vector<double> sliding_distance(const Motion& motion);

}  // namespace tribofit
