#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "force_balance.hpp"
#include "limits.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

double t_of(const RigValue& v) {
  return v.determined && v.std_error > 0 ? std::abs(v.value) / v.std_error : 0;
}

/// Whether a further term is there and moves the damping by enough to be spoken of.
bool counts(const RigValue& term, const RigFit& fit) {
  return term.determined && t_p_value(t_of(term), fit.degrees_of_freedom) < kChanceOfRemark &&
         std::abs(fit.without_both.damping - fit.damping.value) >
             std::max(kPartOfDamping * std::abs(fit.damping.value), 2 * fit.damping.std_error);
}

bool delay_counts(const RigFit& fit) {
  return counts(fit.delay, fit);
}

bool high_pass_counts(const RigFit& fit) {
  return counts(fit.high_pass, fit);
}

const char* damping_unit(const RigFit& fit) {
  return fit.per_unit_load ? "s/mm" : "N s/mm";
}

std::string delay_text(const RigFit& fit) {
  return fmt::format("friction is recorded {} +/- {} ms {} v_b; without that the damping would be {} {}",
                     general(1e3 * std::abs(fit.delay.value), 3), general(1e3 * fit.delay.std_error, 1),
                     fit.delay.value > 0 ? "later than" : "before", general(1e-3 * fit.without_both.damping, 3),
                     damping_unit(fit));
}

/// The damping in N s/mm, as tables show it.
std::string damping_text(const RigFit& fit) {
  return fmt::format("{} +/- {} {}", general(1e-3 * fit.damping.value, 3), general(1e-3 * fit.damping.std_error, 2),
                     damping_unit(fit));
}

std::string why_negative_damping(const RigFit& fit) {
  const bool sags = high_pass_counts(fit), late = delay_counts(fit);
  if (sags && fit.high_pass.value > 0 && (!late || t_of(fit.high_pass) > t_of(fit.delay))) {
    return fmt::format("v_b went through a high-pass that was not undone (the balance sees {} Hz)",
                       general(fit.high_pass.value, 3));
  }
  if (late) return delay_text(fit);
  return "a high-pass of the vibrometer or a friction channel that is late does this, but neither shows clearly";
}

}  // namespace

std::string why_impossible(const RigFit& fit) {
  const double m = fit.mass.value, k = fit.stiffness.value;
  if (k < 0 && m < 0) {
    return "mass and stiffness are negative: v_b or friction has the wrong sign";
  }
  if (k < 0) return "the stiffness is negative: the channels do not belong to one block on a spring";
  if (m < 0) {
    return "the mass is negative: more mass hangs below the force sensor than above it (only m - m_s shows), or "
           "the channels are far apart in time";
  }
  if (fit.damping.upper95 < 0) {
    return fmt::format("the damping is negative, {}: {}", damping_text(fit), why_negative_damping(fit));
  }
  return "";
}

namespace {

void add_about_channels(const Motion& motion, RigFit& fit) {
  auto& out = fit.messages;
  const bool late = delay_counts(fit), sags = high_pass_counts(fit);
  const bool sag_first = sags && (!late || t_of(fit.high_pass) > t_of(fit.delay));
  fit.damping_doubtful = sags || late;
  if (sag_first && fit.high_pass.value > 0) {
    out.push_back(fmt::format(
        "the damping is wrong: the balance shows a high-pass of {} +/- {} Hz on v_b that is not undone (a "
        "force "
        "follows the integral of the displacement, as in no rig); without it the damping would be {} {}: undo it, "
        "or "
        "declare it as vibrometer.high_pass",
        general(fit.high_pass.value, 3), general(fit.high_pass.std_error, 2),
        general(1e-3 * fit.without_both.damping, 3), damping_unit(fit)));
  } else if (sag_first) {
    out.push_back(fmt::format(
        "the damping is wrong: the balance shows a high-pass of {} +/- {} Hz on the force (a charge amplifier "
        "drifts back so), or one on v_b undone too far",
        general(-fit.high_pass.value, 3), general(fit.high_pass.std_error, 2)));
  } else if (late) {
    out.push_back("the damping is wrong: " + delay_text(fit) +
                  "; a delay or a slower force sensor does this: declare it with --instruments");
  }
  if (motion.high_pass > 0) {
    out.push_back(fmt::format("a high-pass of {} Hz on v_b was undone; the error of its corner is fitted too",
                              general(motion.high_pass, 3)));
  }
}

void add_about_mass(const Instruments& instruments, RigFit& fit) {
  auto& out = fit.messages;
  if (fit.mass_below_declared) {
    out.push_back(fmt::format("the mass includes the declared {} kg below the force sensor",
                              general(instruments.force_sensor.mass_below->value, 4)));
    return;
  }
  if (fit.mass_below.determined) {
    out.push_back(fmt::format(
        "the declared ping frequency belongs to the whole mass: {} +/- {} kg of it hang "
        "below the force sensor",
        general(fit.mass_below.value, 4), general(std::hypot(fit.mass_below.std_error, fit.mass_below.systematic), 2)));
    return;
  }
  out.push_back(
      "the mass is that above the force sensor (m - m_s): what hangs below it is not distinguishable from "
      "friction; declare force_sensor.mass_below or rig.ping_frequency with --instruments");
}

void add_about_stiffness(const Motion& motion, const Instruments& instruments, RigFit& fit) {
  auto& out = fit.messages;
  const double off = fit.stick_slope_stiffness.value / fit.stiffness.value - 1;
  if (fit.determined && fit.stick_slope_stiffness.determined && std::abs(off) > kPartOfStiffness &&
      t_p_value(fit.stick_slope_difference, fit.degrees_of_freedom) < kChanceOfRemark) {
    out.push_back(
        fmt::format("the slope of friction in stick gives another stiffness ({} %): the gain of the vibrometer or "
                    "omega r is off, or the "
                    "contact creeps in stick",
                    general_with_sign(100 * off, 2)));
  }
  if (const auto& pull = instruments.rig.stiffness; pull && fit.stiffness.determined && !fit.per_unit_load) {
    const double error = std::hypot(fit.stiffness.std_error, fit.stiffness.systematic, pull->uncertainty);
    out.push_back(fmt::format("the declared pull test gives {} N/mm, {} standard errors from the balance",
                              general(1e-3 * pull->value, 4),
                              with_sign((pull->value - fit.stiffness.value) / error, 1)));
  }
  if (fit.per_unit_load) {
    out.push_back("no normal force is known: mass, damping and stiffness are per newton of it; give --load 50N");
  }
  if (motion.velocity_kind == VelocityKind::relative && motion.disc_velocity.empty()) {
    out.push_back("v_r was measured: the disc is assumed to turn evenly");
  }
}

}  // namespace

void add_messages(const Motion& motion, const Segmentation& segmentation, const Instruments& instruments, RigFit& fit) {
  if (segmentation.kind == MotionKind::always_sticking) {
    if (fit.stiffness.determined) {
      fit.messages.push_back("the stiffness is from the slope of friction in stick");
    }
  } else {
    if (segmentation.kind == MotionKind::always_slipping) {
      fit.messages.push_back("the block never sticks: the force balance uses slip only");
    }
    add_about_channels(motion, fit);
    if (fit.mass.determined) add_about_mass(instruments, fit);
    if (fit.determined && fit.damping.value < 0) {
      fit.messages.push_back("the damping is zero within its error; simulations use zero");
    }
  }
  add_about_stiffness(motion, instruments, fit);
}

}  // namespace tribofit
