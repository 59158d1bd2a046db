#include "health_checks.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "limits.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {

std::string_view to_string(HealthItem::Status status) {
  switch (status) {
    case HealthItem::Status::ok:
      return "ok";
    case HealthItem::Status::warning:
      return "warning";
    case HealthItem::Status::problem:
      break;
  }
  return "problem";
}

}  // namespace tribofit

namespace tribofit::kinematics {
namespace {

using Status = HealthItem::Status;

struct Band {
  double upper = 0;       // content above the noise floor up to here [Hz]
  double floor = 0;       // amplitude density of the noise floor, relative to the largest line
  bool filtered = false;  // the noise floor itself falls off towards the end of the band
  double corner = 0;      // from here on the content falls steeply [Hz]; 0: nowhere
  double order = 0;       // the power of frequency with which it does
};

// Stick-slip falls with the first power of frequency in friction (it jumps) and the second in velocity (it has
// corners), a sensor of second order adds two. What falls faster over an octave, while still above its floor, was
// low-passed.
void find_corner(const Spectrum& spectrum, double floor, Band& band) {
  constexpr double third_of_octave = 1.259921;
  std::vector<double> frequency, amplitude;
  for (double k = 4; k * third_of_octave < static_cast<double>(spectrum.amplitude.size()); k *= third_of_octave) {
    const auto begin = static_cast<std::size_t>(k), end = static_cast<std::size_t>(k * third_of_octave) + 1;
    const std::span<const double> part = std::span<const double>(spectrum.amplitude).subspan(begin, end - begin);
    amplitude.push_back(std::sqrt(sum_of(part, [](double a) { return a * a; }) / static_cast<double>(part.size())));
    frequency.push_back(k * spectrum.bin_width);
  }
  double before = 0;
  for (std::size_t i = 0; i + 3 < amplitude.size(); ++i) {
    if (amplitude[i + 3] < kSlopeOverNoise * floor) break;
    const double order = std::log2(amplitude[i] / amplitude[i + 3]);
    if (std::min(order, before) > kSteepFall && band.corner == 0) band.corner = frequency[i];
    if (band.corner > 0) band.order = std::max(band.order, order);
    before = order;
  }
}

// Content reaches up to where the smoothed spectrum comes near the noise floor, that of the upper quarter.
Band band_of(std::span<const double> signal, double step) {
  const Spectrum spectrum = averaged_spectrum(signal, step);
  Band band;
  const std::size_t n = spectrum.amplitude.size();
  if (n < kFewestBins) return band;
  const auto power_between = [&](std::size_t from, std::size_t to) {
    std::vector<double> part(spectrum.amplitude.begin() + static_cast<std::ptrdiff_t>(from),
                             spectrum.amplitude.begin() + static_cast<std::ptrdiff_t>(to));
    return median(std::move(part));
  };
  const double floor = power_between(3 * n / 4, n - 1);
  const double last = power_between(15 * n / 16, n - 1), third = power_between(n / 2, n / 2 + n / 16);
  band.filtered = last < kFilteredEnd * third;
  band.floor = floor / *std::max_element(spectrum.amplitude.begin() + 1, spectrum.amplitude.end());
  std::size_t upper = 1;
  for (std::size_t k = 2; k + 2 < n; ++k) {
    const double smooth = (spectrum.amplitude[k - 2] + spectrum.amplitude[k - 1] + spectrum.amplitude[k] +
                           spectrum.amplitude[k + 1] + spectrum.amplitude[k + 2]) /
                          5;
    if (smooth > kContentOverNoise * floor) upper = k;
    if (k > kLoneLineAbove * upper + kLoneLineBins) break;
  }
  band.upper = static_cast<double>(upper) * spectrum.bin_width;
  find_corner(spectrum, floor, band);
  return band;
}

// Where the channel's filter begins [Hz]; 0: none seen.
double lowest_pass(const Band& band) {
  return band.corner > 0 ? band.corner : band.filtered ? band.upper : 0;
}

std::string describe(const char* name, const Band& band) {
  if (band.upper <= 0) return fmt::format("{}: too short to say", name);
  if (band.corner > 0)
    return fmt::format("{} falls from about {} on like f^-{}, it was low-passed there", name,
                       frequency_text(band.corner, 2), fixed(band.order, 0));
  if (band.filtered)
    return fmt::format("{} falls to {} of its largest line, filtered above about {}", name, general(band.floor, 2),
                       frequency_text(band.upper, 3));
  return fmt::format("{} stands above its noise up to {}", name, frequency_text(band.upper, 3));
}

}  // namespace

HealthItem check_sagging(const RestModel& rest, std::optional<double> declared, bool undone, bool sticks) {
  HealthItem item{health_check::kSaggingPlateau, Status::ok, health_check::not_checked("no stick plateau to look at")};
  if (declared) {
    item.message = fmt::format("the declared high-pass of {} Hz is corrected", general(*declared, 3));
  } else if (rest.high_pass_is_found) {
    item.status = undone ? Status::warning : Status::problem;
    item.message =
        fmt::format("the plateau sags like that of a first-order high-pass at {} +/- {} Hz ({} plateaus); {}",
                    fixed(rest.high_pass.value, 3), fixed(rest.high_pass.std_error, 4), rest.sticks,
                    undone ? "corrected" : "not corrected");
  } else if (rest.drive.any()) {
    item.status = Status::warning;
    item.message =
        "the plateau falls while friction rises, and friction is straight over the way of the block: the "
        "disc slows down, it is not the reading";
  } else if (rest.crosstalk.any()) {
    item.status = Status::warning;
    item.message =
        "the plateau follows friction, which is straight over time, and the block seems to go away: friction "
        "crosses into the reading of the velocity";
  } else if (rest.creep > 0) {
    item.message = fmt::format(
        "the plateau falls faster towards break-away: the contact creeps, no high-pass (its speed "
        "varies by {} %)",
        fixed(100 * rest.creep, 2));
  } else if (rest.high_pass.std_error > 0) {
    item.message = fmt::format("plateaus are level: a high-pass would have its corner at {} +/- {} Hz ({} plateaus)",
                               fixed(rest.high_pass.value, 4), fixed(rest.high_pass.std_error, 4), rest.sticks);
  } else if (sticks) {
    item.message = health_check::not_checked("too few plateaus to look for a high-pass");
  }
  return item;
}

namespace {

double corner_of(const Estimate& low_pass) {
  return 1 / (2 * std::numbers::pi * low_pass.value);
}

/// What was found at re-stick and corrected, as the end of a sentence.
std::string undone_low_passes(const Motion& motion, std::size_t slips) {
  std::string text;
  if (motion.velocity_low_pass.any()) {
    text += fmt::format("; v_r decays at re-stick as after a first-order low-pass at {} ({} slips); corrected",
                        frequency_text(corner_of(motion.velocity_low_pass), 3), slips);
  }
  if (motion.friction_low_pass.any()) {
    const bool seen = motion.friction_filter_source != FilterSource::other_runs;
    text += fmt::format("; {} a first-order low-pass at {}: each law is filtered the same way",
                        seen ? "friction decays at re-stick as after" : "other runs show that friction is read through",
                        frequency_text(corner_of(motion.friction_low_pass), 3));
  }
  return text;
}

}  // namespace

HealthItem check_bandwidth(const Motion& motion, std::span<const double> velocity, const LowPass& restick) {
  const double step = motion.step;
  const Band a = band_of(motion.friction, step);
  HealthItem item{health_check::kBandwidth, Status::ok, describe("friction", a)};
  Band b = velocity.empty() ? Band{} : band_of(velocity, step);
  // A smooth motion has a steep spectrum: where v_r comes to rest at once, there is no filter.
  if (restick.slips > 0 && !restick.is_filter) b.corner = 0;
  if (!velocity.empty()) item.message += "; " + describe("velocity", b);
  item.message += fmt::format("; sampled at {}", frequency_text(1 / step));
  if (const std::string undone = undone_low_passes(motion, restick.slips); !undone.empty()) {
    item.status = Status::warning;
    item.message += undone;
  }
  if (restick.is_filter && !motion.velocity_low_pass.any()) {
    item.status = Status::problem;
    item.message += fmt::format(
        "; v_r decays at re-stick as after a {}low-pass at {} ({} slips): mu_s, mu_k and the law's decay (alpha) are "
        "not those of the contact, a bandwidth of {} is needed",
        restick.is_second_order ? "second-order " : "", frequency_text(restick.corner(), 2), restick.slips,
        frequency_text(restick.corner() * std::min(restick.at_restick, 1.0) / kRestickHarmless, 2));
    return item;
  }
  const double low = lowest_pass(a), other = lowest_pass(b);
  if (low == 0 && other == 0) return item;
  item.status = Status::warning;
  item.message += ": what is faster than the filter is not in the data";
  const bool differ = low == 0 || other == 0 || std::max(low, other) > kFiltersDiffer * std::min(low, other);
  if (!velocity.empty() && differ) {
    item.message += "; the channels have different filters; the lag between them looks like memory";
  }
  return item;
}

HealthItem check_friction_zero(const Motion& motion) {
  const UndoneResponse& response = motion.friction_response;
  if (!motion.friction_drives && response.any()) {
    return {
        health_check::kFrictionZero, Status::warning,
        fmt::format("friction rises ever slower in stick, where it is the force of the spring: its gain is {} +/- {} % "
                    "less at the highest reading; corrected",
                    general(100 * response.response.part, 3), general(100 * response.std_error, 2))};
  }
  if (!motion.friction_drives) return {health_check::kFrictionZero, Status::ok, "friction brakes what slides"};
  return {
      health_check::kFrictionZero, Status::problem,
      "friction is negative in slip, as if it drove the block: the zero of its sensor is wrong, or the channel passes "
      "no constant (AC coupling); mu_s, mu_k and the law's decay (alpha) are unreliable, record it with DC coupling"};
}

HealthItem check_revolutions(const Motion& motion) {
  HealthItem item{health_check::kRevolutions, Status::ok, health_check::not_checked("the disc's speed is not known")};
  double angle = 0;
  if (!motion.disc_angle.empty()) {
    angle = motion.disc_angle.back() - motion.disc_angle.front();
  } else if (!motion.disc_speed.empty()) {
    double sum = 0;
    for (double w : motion.disc_speed) sum += std::abs(w);
    angle = sum * motion.step;
  } else {
    for (const Step& step : motion.steps) {
      const Condition& speed = step.conditions.speed.known() ? step.conditions.speed : motion.conditions.speed;
      if (!speed.known()) return item;
      angle += speed.value * static_cast<double>(step.end - step.begin) * motion.step;
    }
  }
  const double revolutions = std::abs(angle) / (2 * std::numbers::pi);
  item.message = fmt::format("{} revolutions recorded", fixed(revolutions, 2));
  if (revolutions < kRevolutionsOfAngle) {
    item.status = Status::warning;
    item.message += ": effects of the disc angle need two";
  }
  return item;
}

HealthItem check_speed_ripple(const Motion& motion, const RestModel& rest) {
  HealthItem item{health_check::kSpeedRipple, Status::ok,
                  health_check::not_checked("no stick plateaus to follow over the disc angle")};
  if (!motion.sticks || motion.velocity_kind != VelocityKind::block) return item;
  const DiscRipple& ripple = rest.ripple;
  if (ripple.order == 0) {
    const bool recorded = !motion.disc_velocity.empty() && !rest.drive.any();
    item.message = recorded ? "the speed of the disc is recorded"
                            : health_check::not_checked("less than two revolutions or too few plateaus");
    return item;
  }
  item.message =
      fmt::format("the plateau follows the disc angle by {} % {} a revolution (+/- {} %, {} plateaus)",
                  fixed(100 * ripple.amplitude, 2), ripple.order == 1 ? "once" : fmt::format("{} times", ripple.order),
                  fixed(100 * ripple.amplitude_std_error, 2), rest.sticks);
  if (!rest.ripple_is_found) return item;
  item.status = Status::warning;
  item.message += motion.speed_ripple.order > 0 ? "; the speed of the disc ripples; corrected"
                                                : "; the speed of the disc ripples; not corrected";
  return item;
}

HealthItem check_run_up(const Motion& motion, bool trim, std::size_t found) {
  HealthItem item{health_check::kRunUp, Status::ok, "the record begins at full speed"};
  if (found == 0) return item;
  const double time = static_cast<double>(found) * motion.step;
  item.message = fmt::format("the first {} s, before the plateau is within 2 % of its final value, {}",
                             general(time, 3), trim ? "are trimmed" : "are kept");
  if (!trim) item.status = Status::warning;
  return item;
}

HealthItem check_plateau_speed(const Motion& motion, double plateau, bool speed_was_stated, bool radius_known,
                               const std::optional<RecordedPlateau>& recorded) {
  HealthItem item{health_check::kPlateauSpeed, Status::ok,
                  health_check::not_checked("the record has no stick plateau")};
  const auto compare = [&](double block, double disc, const char* origin) {
    item.message =
        fmt::format("plateau of v_b {} mm/s, {} {} mm/s", general(1e3 * block, 4), origin, general(1e3 * disc, 4));
    const double error = disc == 0 ? std::numeric_limits<double>::infinity() : block / disc - 1;
    if (disc != 0) item.message += fmt::format(": {} %", with_sign(100 * error, 1));
    if (std::abs(error) > kSettled) item.status = std::abs(error) > kFarFromDisc ? Status::problem : Status::warning;
  };
  if (recorded) {
    compare(recorded->block, recorded->disc, "the recorded speed times the radius");
    if (item.status != Status::ok) item.message += "; radius, speed column (sign, unit), laser angle or creep";
    return item;
  }
  if (!motion.sticks) return item;
  const bool recorded_speed = !motion.disc_velocity.empty() && motion.speed_ripple.order == 0;
  if (motion.velocity_kind == VelocityKind::relative || recorded_speed) {
    item.message = fmt::format("v_r rests at {} mm/s in stick", general(1e3 * motion.plateau_velocity, 3));
    return item;
  }
  if (!speed_was_stated) {
    item.message = fmt::format("speed taken from the plateau of v_b: omega r = {} mm/s", general(1e3 * plateau, 4));
    if (radius_known) item.message += fmt::format(", {} rpm", general(motion.conditions.speed.value / kRpm, 4));
    return item;
  }
  if (motion.kind == RecordKind::spring_slider) {
    compare(plateau, motion.constant_disc_velocity, "the drive");
    if (item.status != Status::ok) item.message += "; stiffness, speed of the drive, load or creep of the contact";
    return item;
  }
  compare(plateau, motion.constant_disc_velocity, "omega r");
  if (item.status != Status::ok) item.message += "; radius, speed, laser angle or creep of the contact";
  return item;
}

}  // namespace tribofit::kinematics
