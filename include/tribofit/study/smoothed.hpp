#pragma once

#include <span>

#include "tribofit/friction/model.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// What the arctangent of the smoothed law multiplies.
enum class ArctangentReading {
  smooth,     ///< {mu_c + (mu_brk - mu_c) exp(-c_v |v_r|)} (2/pi) atan(s v_r): odd in v_r, as friction must be
  as_printed  ///< mu_c + (mu_brk - mu_c) exp(-c_v |v_r|) (2/pi) atan(s v_r): as [U] Eq 2 and [C] print it
};

/// Friction without a jump at rest, so that it can be integrated without events ([U] Eq 2 after Armstrong; [C] adds
/// sigma v_r). A stick is then a slow creep in which the arctangent balances the spring.
///
/// In SI; the formulae hold in any consistent units.
///
/// As printed the law is not odd: without motion it still pulls with mu_c, and against a fast backward motion it pushes
/// it on. mu_c with the sign of v_r, which it must have, jumps by 2 mu_c at rest; [C], which puts mu_H at v_r = 0,
/// jumps there from mu_c to mu_H and back. For v_r > 0 of more than a few 1/s the two readings are the same.
struct SmoothedLaw {
  double mu_brk = 0;     ///< breakaway, mu_H of [C] [1], > 0
  double mu_c = 0;       ///< kinetic, mu_G of [C] [1], >= 0
  double decay = 0;      ///< c_v [s/m], >= 0
  double sharpness = 0;  ///< s [s/m], > 0
  double viscous = 0;    ///< sigma of [C] [s/m]
  ArctangentReading reading = ArctangentReading::smooth;

  /// Signed mu at v_r [m/s].
  double friction(double relative_velocity) const;
  /// d mu/d v_r [s/m].
  double slope(double relative_velocity) const;
  /// The speed up to which friction rises, where it is largest [m/s]: below it the spring is balanced and the block
  /// creeps, above it slips. Infinite where friction never falls.
  double crest() const;
};

/// The smoothed law that tends to `model` as its sharpness [s/m] grows: of the exponential law, alone or with the
/// effect `viscous`. p: parameters of the model in SI. Throws InputError for any other model.
SmoothedLaw smoothed_law(const FrictionModel& model, std::span<const double> p, double sharpness);

struct SmoothedOptions {
  double duration = 1;      ///< of the record [s], > 0
  double rate = 20000;      ///< samples per second [Hz]; 0: no samples, events only
  double settle = 0;        ///< simulated and thrown away before the record [s]
  BlockStart start = {};    ///< at rest and unloaded, as [U] and [C] begin
  double tolerance = 1e-9;  ///< local error of the integrator, relative
  /// The block counts as stuck while |v_r| is at most this share of the speed of the disc; 0: while it is at most at
  /// the crest of the law, or half the speed of the disc where that is less. 0 <= share < 1.
  double stick_share = 0;
};

/// Simulates m x'' + c x' + k x = N mu(v_r), v_r = omega r - x', with a smoothed law, by a Rosenbrock method of order
/// 4 for stiff problems (RODAS, as Boost.Odeint has it).
///
/// The result is that of simulate(), so that whatever is measured there is measured here in the same way; but
/// break-away and re-stick are where |v_r| crosses what counts as stuck, relative_velocity is not zero in
/// stick, and `distance` counts the creep.
///
/// Beside simulate() with mu_s = mu_brk, mu_k = mu_c, alpha = c_v the block breaks away too early. The largest friction
/// of the smoothed law is below mu_brk by about sqrt(8/pi mu_brk (mu_brk - mu_c) c_v/s), so period, stick time and
/// amplitude come to those of simulate() as 1/sqrt(s).
///
/// Throws InputError for a rig, drive, law or option that cannot be, and where the integration gives up, with what was
/// seen: where the law is so sharp that doubles do not resolve the creep of a stick (s v_disc above 1.4e8).
/// Cost: about 0.5 ms a stick-slip cycle.
SimulatedMotion simulate_smoothed(const Rig& rig, const Drive& drive, const SmoothedLaw& law,
                                  const SmoothedOptions& options = {});

}  // namespace tribofit
