#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plateau.hpp"
#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// What the plateaus say about a disc whose speed follows its angle.
struct RippleEstimate {
  DiscRipple ripple;
  double level = 0;          ///< of the plateaus without the ripple, at the middle of the record [m/s]
  double drift = 0;          ///< of that level [m/s^2]
  double middle = 0;         ///< the time of `level` [s]
  double explained = 0;      ///< share of the variance of the levels (without drift) that the ripple explains
  std::size_t plateaus = 0;  ///< used
  bool true_angle = false;   ///< the ripple runs with the angle the disc has turned, not with omega t
  bool significant = false;  ///< clearly there and large enough to matter
};

/// Ripple of the disc's speed from the levels of the plateaus over the angle omega t.
///
/// The level of a plateau from t1 to t2 is level (1 + A <cos(n omega t + phase)>), <> the mean over the plateau; orders
/// 1 to 6 are tried by least squares beside a constant and a straight drift, plateaus far from the line left out. It
/// counts when two revolutions are recorded, A is at least 0.5 % and six standard errors (for levels correlated from
/// plateau to plateau), it explains half of the variance of the levels, and both halves of the record show the same
/// amplitude and phase: what swings in time, or wanders, does not. Where the plateaus fall towards break-away the
/// contact creeps, and creep follows friction (a runout): friction in the plateau and at its end are then used in the
/// fit, and A must be larger than that fall over the level.
///
/// The phase of a real coupling runs with the angle theta that the disc has turned, of which omega t is the mean up to
/// A^2/2: n theta + phase is the true anomaly of an orbit of eccentricity A, so that the reciprocal of the level is a
/// sine of nearly the same frequency, n omega sqrt(1-A^2). Both readings are fitted, the better one counts.
///
/// `time`, `friction`: of the samples [s], [1 or N]; `omega` [rad/s]. Cost: linear in the plateaus, one pass over
/// friction in them.
RippleEstimate estimate_ripple(const BlockMeans& velocity, const Plateaus& plateaus, double omega,
                               std::span<const double> time, std::span<const double> friction);

/// The ripple at given times.
struct RippledDisc {
  std::vector<double> factor;  ///< of the speed, 1 + A cos(n theta + phase)
  std::vector<double> angle;   ///< omega times the integral of the factor from t = 0 [rad]
};
RippledDisc rippled_disc(const RippleEstimate& estimate, double omega, std::span<const double> time);

/// The one stated speed of the whole record [rad/s], NaN where there are several or it was recorded.
double steady_speed(const Trace& trace);

/// A ripple of the disc's speed, looked for where v_b was measured against one steady speed. `stated`: that speed was
/// stated; else it was read off the plateau, and is read off again without the ripple, in `disc` and in the conditions
/// of `trace`.
RippleEstimate find_ripple(Trace& trace, const PlateauSearch& search, Disc& disc, bool stated);

/// Makes the blocks and plateaus those that a disc without the ripple would have shown.
void flatten(PlateauSearch& search, const RippleEstimate& ripple, double omega, std::span<const double> time);

/// Gives speed and angle of the disc, and omega r, the ripple.
void impose_ripple(Trace& trace, Disc& disc, const RippleEstimate& ripple, double omega);

}  // namespace tribofit::kinematics
