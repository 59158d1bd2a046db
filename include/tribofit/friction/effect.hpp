#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/law.hpp"
#include "tribofit/friction/parameter.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// How to add an effect
/// --------------------
/// 1. One header in friction/effects/: a small value type with a static `info()` and the hooks below that it needs.
/// 2. Its name in the list of friction/effects/all.hpp.
/// 3. One test in tests/friction/.
/// The command line, the help, the JSON, the bounds, the contract tests and the diagnosis find it through the list.
///
/// An effect is one physical statement. It changes friction at one or more of these places, in this order; every
/// hook is a const member template over the number type T (double, or a dual number for derivatives), takes its own
/// parameters p in SI and is left out where it has nothing to say:
///
///   void adjust(p, const Slip&, LawParameters<T>&)        levels of the base law for a whole slip
///   T    transform_speed(p, const T& x)                            reduced speed x = decay v of the base law
///   LocalSliding<T> average_over_contact(p, const SlidingState<T>&)                local speeds within the contact: f
///   is taken at `speed`, and
///        `share` of it acts along v_r
///   T    contact_renewal_rate(p, const V& v), equivalent_speed(p, const T& theta)   contacts with an age, d theta/dt =
///   1 - contact_renewal_rate theta:
///        the base law is taken at equivalent_speed instead of v (see contact_age.hpp)
///   T    steady(p, const SlidingState<T>&, const T& mu)        steady friction f(v) >= 0, before any memory
///   Relaxation<T> relaxation(p, const SlidingState<T>&, const T& steady)   memory: d phi/dt = rate (target - phi)
///   T    output(p, const SlidingState<T>&, const T& steady, const T& phi)  friction of that memory (default: phi)
///        (phi starts at mu_s at break-away; where the memory acts in stick, at the friction measured a little before
///        it)
///   T    creep(p, const T& mu_s, double mu, double slope)  v_r in stick, where the memory acts in stick; without it,
///        `average_over_contact` says at which speed the block creeps
///   T    modulate(p, const SlidingState<T>&, const T& mu)      signed friction, after any memory
///   void modulate_all(p, const Slip&, std::span<const T> velocity, std::span<T> mu)   the same, a whole slip at a time
///   T    add_to_reading(p, const SlidingState<T>&, const T& mu)          what the sensor adds to it
///   void filter_reading(p, const Slip&, const T& level, std::span<T> mu)   what the sensor makes of a whole slip;
///   `level`:
///        signed friction at break-away, up to which the spring pulled at slip.stick_slope
///   T    filter_break_away_reading(p, const Slip&, const T& level)  and of that level (default: what `read` makes of
///   it)
///
/// All memories of the catalogue are linear in their state, which makes a step over any interval exact and stable.

/// Channels that an effect needs to see.
struct Channels {
  bool acceleration = false, angle = false, distance = false, load = false, temperature = false, stick_time = false;
  bool lead = false;     ///< the last samples of the stick before each slip
  bool force = false;    ///< the normal force, or friction as a force
  bool plateau = false;  ///< v_b on the plateau of stick, with a stated speed
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

/// An effect that looks the same in most records, and the experiment that tells the two apart.
struct LookAlike {
  std::string key;
  std::string test;
};

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
  EffectGroup group = EffectGroup::friction;
  bool kinematic_effect = false;      ///< see is_kinematic(); filled in by describe()
  std::vector<LookAlike> pairs = {};  ///< filled in by describe(), see effect_pairs.hpp
  std::string option = {};            ///< of an effect that is a form of another: the name of that form
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

}  // namespace tribofit
