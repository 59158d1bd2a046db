#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/law.hpp"
#include "tribofit/friction/parameter.hpp"
#include "tribofit/friction/slip.hpp"
#include "tribofit/statistics/estimate.hpp"

namespace tribofit {

enum class PlateauCorrection;  // kinematics/motion.hpp
struct Motion;

/// How to add an effect
/// --------------------
/// 1. One header in friction/effects/: a small value type with its `key`, a static `info()` and the hooks below that it
///    needs.
/// 2. Its name in the list of friction/effects/all.hpp.
/// 3. One test in tests/friction/.
/// The place in the list is the order in which effects act. viscous.hpp is a short example; a point of it stands in
/// tests/friction/effects_test.cpp (SayWhatTheirEquationSaysAtAPoint).
/// The command line, the help, the JSON, the bounds, the contract tests, the simulation and the diagnosis find it
/// through the list. All that they must know of it stands in its EffectInfo: no other file names it. The benchmark of
/// hidden effects asks for a row of sizes in tests/recovery/hidden_sizes.cpp.
///
/// An effect is one physical statement. It changes friction at one or more of these places, in this order; every
/// hook is a const member template over the number type T (double, or a dual number for derivatives), takes its own
/// parameters p in SI and is left out where it has nothing to say:
///
///   void adjust(p, const Slip&, LawValues<T>&)
///        parameters of the base law for a whole slip
///   T transform_speed(p, const T& x)
///        reduced speed x = steepness v of the base law, where it has one
///   T rim_speed(p, double disc_speed), LocalSliding<T> average_over_contact(const T& rim, const T& speed)
///        local speeds within a contact whose rim turns at that speed: f is taken at `speed`, and `share` of it acts
///        along v_r; with them T slowest_reading(const T& rim), below which a reading of v_r is noise about rest. The
///        last two see no parameters and are static
///   T renewal_distance(p)
///        contacts with an age, d theta/dt = 1 - v theta / D with this distance D: the base law is taken at D / theta
///        instead of v (see contact_age.hpp)
///   T steady(p, const SlidingState<T>&, const T& mu)
///        steady friction f(v) >= 0, before any memory
///   Relaxation<T> relaxation(p, const SlidingState<T>&, const T& steady)
///        memory: d phi/dt = rate (target - phi); phi starts at mu_s at break-away, or, where the memory acts in stick,
///        at the friction measured a little before it
///   T output(p, const SlidingState<T>&, const T& steady, const T& phi)
///        friction of that memory (default: phi)
///   T creep(p, const T& mu_s, double mu, double slope)
///        v_r in stick, where the memory acts in stick; without it, average_over_contact says at which speed the block
///        creeps
///   T modulate(p, const SlidingState<T>&, const T& mu)
///        signed friction, after any memory
///   void modulate_all(p, const Slip&, std::span<const T> velocity, std::span<T> mu)
///        the same, a whole slip at a time; an effect that has both says the same by either, and is the faster by this
///   T add_to_reading(p, const SlidingState<T>&, const T& mu)
///        what the sensor adds to it
///   void add_to_readings(p, const Slip&, std::span<T> mu)
///        the same, a whole slip at a time and faster; beside add_to_reading, never alone
///   void filter_reading(p, const Slip&, const T& level, std::span<T> mu)
///        what the sensor makes of a whole slip; `level`: signed friction at break-away, up to which the spring pulled
///        at slip.stick_slope
///   T filter_break_away_reading(p, const Slip&, const T& level)
///        and of that level (default: what add_to_reading makes of it)
///
/// All memories of the catalogue are linear in their state, which makes a step over any interval exact and stable.
///
/// What an effect changes beside friction, for simulations and for the study of an identified machine (double only):
///
///   double true_radius(p, double stated)                friction radius [m]
///   SpeedSwing speed_swing(p)                           how the speed of the disc swings with its angle
///   double velocity_gain(p), velocity_high_pass(p)      of the vibrometer [1], [Hz]
///   double velocity_zero(p), velocity_low_pass(p), clock_drift(p)
///                                                       of the vibrometer [m/s], [Hz], [1]
///   double friction_low_pass(p)                         of the friction channel [Hz]
///   StaticResponse velocity_response(p), friction_response(p)    of either channel, without its full scale
///   double load_at_contact(p, double load, double mu)   normal force [N]
///   double reading_delay(p)                             how much later than the velocity friction is read [s]
///   double mass_below_sensor(p)                         [kg]
///
/// What kinematics/ and segmentation/ find and undo before any fit:
///
///   static FoundBeforeFit found_before_fit(const Motion&, const Estimate& load_coupling)

/// Channels that an effect needs to see.
struct Channels {
  bool acceleration = false, angle = false, distance = false, load = false, temperature = false, stick_time = false;
  bool reversal_distance = false;  ///< the distance since the last reversal, in a record that reverses a few times
  bool lead = false;               ///< the last samples of the stick before each slip
  bool force = false;              ///< the normal force, or friction as a force
  bool plateau = false;            ///< v_b on the plateau of stick, with a stated speed
  /// What came before, or when: points have none of it. describe() sets it where the sketch shows the effect over
  /// anything else than speed, direction, load and temperature.
  bool time = false;

  bool operator==(const Channels&) const = default;
};

/// What must happen in a record before it can show an effect, beyond that the channels it needs vary.
struct Excitation {
  bool both_directions = false;    ///< the block slides both ways
  double revolutions = 0;          ///< of the disc
  bool stated_plateau = false;     ///< speed and radius are stated, so that the plateau can be compared with omega r
  bool stated_disc_speed = false;  ///< the speed of the disc is stated, and not recorded
  bool changing_speed = false;     ///< break-away, a reversal, or a sliding speed that changes by more than its noise
  /// Break-away, and what it is needed for, as the end of "there is no break-away ..."; empty: not needed.
  std::string break_away = {};
};

/// Where an effect has its place.
enum class EffectGroup {
  friction,     ///< what the contact does
  rig,          ///< what the machine does to the contact
  measurement,  ///< what the instruments make of it
  user,         ///< the user's own formula
};
/// "friction", "rig", "measurement", "your own".
std::string_view to_string(EffectGroup group);

/// A value of the instruments file that is about an effect. Once it is declared it is corrected, and the first
/// parameter of the effect can only be what its uncertainty leaves; the bandwidth is a lower bound instead.
enum class InstrumentValue {
  none,
  force_zero,        ///< force_sensor.zero
  force_crosstalk,   ///< force_sensor.crosstalk
  force_mass_below,  ///< force_sensor.mass_below
  force_bandwidth,   ///< force_sensor.bandwidth
  vibrometer_delay,  ///< vibrometer.delay
};

/// Over which variable the sketch of an effect is drawn (see study/fingerprint.hpp).
enum class SketchView {
  loop,            ///< what the bare law leaves over v_r, both branches of one slip
  curve,           ///< mu over v_r, with the effect and without
  directions,      ///< |mu| over |v_r|, both directions
  creep,           ///< v_r in stick over mu
  stick_time,      ///< friction at break-away over stick time
  time,            ///< what the bare law leaves of each slip, over time
  distance,        ///< the same over sliding distance
  since_reversal,  ///< |mu| over the distance since the last reversal
  angle,           ///< over the angle of the disc
  load,            ///< over the load
  temperature,     ///< over temperature
  since_break_away,
  acceleration,
  load_channel,  ///< the load channel over mu
  plateau,       ///< v_b in stick over time
  ripple,        ///< v_b in stick over the angle of the disc
  line,          ///< what the bare law leaves in stick over time
};

/// How an effect is drawn where it shows best.
struct Sketch {
  SketchView view = SketchView::loop;
  std::vector<double> values = {};  ///< of its parameters, in their units; empty: 0.3 of the way between their bounds
};

/// An effect that looks the same in most records, and the experiment that distinguishes the two, as one imperative
/// sentence without a full stop.
struct LookAlike {
  std::string key;
  std::string test;
};
/// Look-alikes are stated in the header of one of the two, which names the other by its type.
template <class Other>
LookAlike looks_like(std::string_view test) {
  return {std::string(Other::key), std::string(test)};
}

/// Another form of an effect, which is asked for as KEY:NAME.
struct EffectForm {
  std::string name;
  std::string statement;  ///< in what it differs
};

/// What an effect says about itself.
struct EffectInfo {
  std::string key;         ///< name on the command line and in JSON
  std::string statement;   ///< physical meaning in one sentence
  std::string equation;    ///< in plain text
  std::string source;      ///< with DOI where there is one
  std::string experiment;  ///< which test shows it best
  std::vector<Parameter> parameters;
  Channels needs = {};
  Excitation excitation = {};
  EffectGroup group = EffectGroup::friction;
  InstrumentValue declared_by = InstrumentValue::none;
  /// The correction of the plateau that this effect stands for; PlateauCorrection::none for most.
  PlateauCorrection plateau_correction = {};
  bool proportional_to_speed = false;  ///< adds sigma v to a law, as friction rises at the end of a Stribeck curve
  bool creeps_like_sag = false;  ///< its creep in stick, in proportion to its parameter, is like a plateau that sags
  bool needs_full_resolution = false;  ///< a spectral line, which means of a few samples do not show
  Sketch sketch = {};
  /// Stated here for one of each two; describe() completes them for both.
  std::vector<LookAlike> pairs = {};
  bool kinematic_effect = false;  ///< see is_kinematic(); filled in by describe()
  std::string option = {};        ///< of an effect that is a form of another: the name of that form
  std::vector<EffectForm> forms = {};

  /// As the command line takes it: "rate-state", "rate-state:healing".
  std::string spelled() const { return option.empty() ? key : key + ":" + option; }
};

/// How friction of a contact is put together from points that slide at different velocities.
template <class T>
struct LocalSliding {
  T share;  ///< of the local friction that acts along v_r [1], 0 to 1
  T speed;  ///< at which local friction is taken [m/s]
};

/// A first-order memory: d phi/dt = rate (target - phi).
template <class T>
struct Relaxation {
  T rate;    ///< [1/s], >= 0
  T target;  ///< what phi would become if nothing changed
};

/// The speed of the disc over its angle: omega (1 + amplitude cos(order theta + phase)).
struct SpeedSwing {
  double amplitude = 0, order = 1, phase = 0;  ///< [1], [1], [rad]
};

/// The parameters of an effect that was found and undone before any fit, and where it showed, as one sentence without a
/// full stop. No values: it was not found.
struct FoundBeforeFit {
  std::vector<Estimate> values = {};
  std::string_view reason = {};
};

}  // namespace tribofit
