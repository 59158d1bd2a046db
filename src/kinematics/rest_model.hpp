#pragma once

#include <cstddef>
#include <vector>

#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Terms of the reading of the velocity at rest, see RestModel.
struct RestTerms {
  bool high_pass = false, crosstalk = false, drive = false;
  double disc_speed = 0;  ///< omega [rad/s], whose ripple is looked for; 0: it is not
};

/// What the velocity of the block reads where it rests on the disc. There v_r = 0, whatever the law of friction, so
/// that omega r is read, and with it what disc and instruments make of it, from all sticks at once:
///
///   v = level + drift (t - middle) - 2 pi f_c x + c mu + d LP(mu) - e/(1 - mu/mu_s) + level A cos(n theta + phase)
///
/// with a high-pass of the vibrometer at f_c (x: integral of v as read), crosstalk of friction into the velocity, a
/// disc that slows down under friction (LP: a first order), creep of the contact before it breaks away at mu_s (a
/// bristle, Canudas de Wit 1995 with mu = sigma0 z; of a disc that turns under the pad m/sqrt(1 - m), m = mu/mu_s), and
/// a speed of the disc that follows its angle theta: omega t, or the angle turned, whichever fits better.
///
/// Each term is tried beside those that are there; the one that leaves least is taken where it is six standard errors
/// large (from stick to stick), matters, and is the same in both halves of the record. Levels of sticks wander: they
/// are random effects. A spring pulls in proportion to the displacement, so that in stick x, mu and LP(mu) look alike.
/// What is true of v_b (drive, creep) leaves friction straight over x, what is only read (high-pass, crosstalk) leaves
/// it straight over time; and behind crosstalk the block seems to go away with c times the mean friction, behind a
/// high-pass it goes nowhere. A drive must also explain clearly more than creep does, and leave nothing that follows
/// the time in a stick: beside creep nothing else that falls is named.
struct RestModel {
  Estimate level;                ///< [m/s], at the mean friction at rest where the disc slows down, without creep
  double drift = 0, middle = 0;  ///< [m/s^2], [s]
  std::size_t sticks = 0;        ///< used
  Estimate high_pass;            ///< f_c [Hz], the best one beside level and drift alone
  bool high_pass_is_found = false;
  Estimate crosstalk, drive;    ///< c, d [m/s over the unit of friction]; 0: none
  double drive_time = 0;        ///< time constant of the drive [s]
  double friction_at_rest = 0;  ///< mean of LP(mu)
  double creep = 0;             ///< of the contact: standard deviation over the level; 0: it does not creep
  DiscRipple ripple;            ///< the best one of all orders tried
  bool ripple_is_found = false;
  bool true_angle = false;  ///< theta is the angle turned
};

/// mean: velocity of the block as read, from stick to stick [m/s]. Cost: a few passes over the blocks, and a thousand
/// times the rows of the sticks.
RestModel fit_rest(const Trace& trace, const PlateauSearch& search, const RestTerms& terms, const Estimate& mean);

/// omega r of every sample over its level: the ripple, and what friction slows the disc down by. omega: its mean speed
/// [rad/s].
std::vector<double> disc_factor(const RestModel& model, double omega, const Trace& trace, double step);

}  // namespace tribofit::kinematics
