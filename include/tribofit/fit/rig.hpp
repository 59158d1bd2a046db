#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tribofit/ingest/instruments.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// One quantity of the rig with its uncertainty, in SI.
struct RigValue {
  double value = 0;
  double std_error = std::numeric_limits<double>::infinity();  ///< statistical, from cycle to cycle
  double lower95 = -std::numeric_limits<double>::infinity();   ///< statistical 95 % interval (t distribution)
  double upper95 = std::numeric_limits<double>::infinity();
  double systematic = 0;  ///< standard uncertainty from the declared instruments
  bool determined = false;
};

/// The rig found in a record. Where no normal force is known (per_unit_load) mass, damping and stiffness are per newton
/// of it: kg/N, s/m, 1/m. Where the rig could not be identified, `reason` says why.
struct RigFit {
  bool determined = false;  ///< all three were found and can be a rig
  std::string reason;       ///< why not; empty where determined
  bool per_unit_load = false;
  double load = 1;  ///< mean normal force behind the values [N]; 1 where it is not known or friction is a force
  RigValue mass, damping, stiffness;          ///< m [kg], c [N s/m], k [N/m]
  RigValue natural_frequency, damping_ratio;  ///< sqrt(k/m)/(2 pi) [Hz], c/(2 sqrt(k m)) [1]
  std::array<double, 9> covariance{};         ///< of m, c, k (SI), row by row, statistical
  double degrees_of_freedom = 1;              ///< of the t distribution of the errors
  RigValue stick_slope_stiffness;             ///< N (dmu/dt)/(omega r) over the sticks [N/m]
  double stick_slope_difference = 0;          ///< stiffness less that one, in standard errors of the difference
  bool mass_below_declared = false;           ///< what hangs below the force sensor is declared and counted in `mass`
  RigValue mass_below;                        ///< from a declared ping frequency: k/omega_p^2 less `mass` [kg]
  RigValue delay;                             ///< friction recorded later than v_b, as the balance sees it [s]
  RigValue high_pass;                         ///< of the velocity, not undone, as the balance sees it [Hz]
  Rig without_both;               ///< mass, damping and stiffness with delay and high-pass taken into account
  bool damping_doubtful = false;  ///< one of the two is there and moves c; a message says which
  double residual_rmse = 0;       ///< of the balance after smoothing [N or N per N of load]
  double smoothing = 0;           ///< width of the test functions [s]
  std::size_t cycles = 0;         ///< units of evidence
  std::vector<std::string> messages;

  /// The rig, damping not below zero. Throws std::logic_error unless determined.
  Rig to_rig() const;
};

/// Mass, damping and stiffness from the force balance on the measured channels (physics: [C], [U] Eq 1)
///
///   N mu(t) = m dv_b/dt + c v_b + k x + f_0 + f_1 t,   x = integral of v_b,
///
/// linear in the unknowns; it holds whatever the friction law is, so that break-away scatter is no error here.
///
/// Weak form: both sides are weighted with test functions phi (quadratic B-splines a fifth of the natural period wide,
/// M. Shinbrot, Trans. ASME 79 (1957) 547, modulating functions), and the derivative goes over to phi: no noisy channel
/// is differentiated. The noise that is left on dv_b/dt is measured in stick and taken off the normal equations, so
/// that errors in the variables bias nothing. The unit of evidence is the cycle, from the middle of a stick to the
/// middle of the next; each has a constant and a straight line of its own, which take up the unknown x(0), a zero error
/// of v_b (x drifts by it: a line) and of the force, and a slow wander of either. Where a high-pass of the velocity was
/// undone its corner is known to some part only, which adds a term in the integral of x to the balance. Standard errors
/// are jackknifed over cycles, so that coloured noise does not break them.
///
/// Load: the channel, else the stated one, else none (everything per newton). v_b is what was measured: a wrong radius
/// or speed does not matter. Where v_r was measured and no speed of the disc is known, the disc is taken to turn
/// evenly. With a mass m_s below the force sensor only m - m_s can be found, unless the instruments declare m_s
/// (compute_motion() has added its inertia then) or a ping frequency, which gives the whole. Two more terms are tried
/// and reported, not used: a delay between the channels, which puts -d (m dv'/dt + c v' + k v) into the balance (slow
/// motion takes k d off c, a swing at the natural frequency hardly anything), and a high-pass f_c of the velocity that
/// was not undone, which puts 2 pi f_c k times the integral of x into it, and c gives way.
///
/// Never slipping: only the stiffness by the slope of stick. Cost: about twenty passes over the samples, memory that of
/// the longest cycle and a row for every tenth of a test function.
RigFit identify_rig(const Motion& motion, const Segmentation& segmentation, const Instruments& instruments = {});

}  // namespace tribofit
