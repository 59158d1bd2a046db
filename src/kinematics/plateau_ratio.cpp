#include "plateau_ratio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::kinematics {
namespace {

constexpr std::size_t parts = 6, least_samples = 6 * parts, most_plateaus = 512;

/// One stick in parts: 1 - v_r/(omega r), friction, and the largest mean friction over a part of it.
struct Stick {
  std::array<double, parts> level{}, friction{};
  double highest = 0;
};

// Between re-stick, whose ringing makes a contact creep more, and break-away.
bool make_stick(const Motion& motion, const StickPlateau& run, std::size_t factor, Stick& stick) {
  const std::size_t first = run.begin * factor, size = run.size() * factor;
  const std::size_t begin = first + size * 9 / 20, end = std::min(first + size * 4 / 5, motion.size());
  if (end < begin + least_samples) return false;
  const std::size_t length = (end - begin) / parts;
  const double disc = motion.disc_velocity_at((begin + end) / 2);
  if (disc == 0) return false;
  const int direction = disc > 0 ? 1 : -1;
  const std::span<const double> v(motion.relative_velocity), mu(motion.friction);
  for (std::size_t k = 0; k < parts; ++k) {
    const std::size_t from = begin + k * length;
    stick.level[k] = 1 - mean_of(v.subspan(from, length)) / motion.disc_velocity_at(from + length / 2);
    stick.friction[k] = direction * mean_of(mu.subspan(from, length));
  }
  stick.highest = stick.friction[0];
  for (std::size_t from = begin; from + length <= std::min(first + size, motion.size()); from += length) {
    stick.highest = std::max(stick.highest, direction * mean_of(mu.subspan(from, length)));
  }
  return true;
}

// Mean of what lies within five robust standard deviations of the median.
Estimate trimmed_mean(std::vector<double> values) {
  const double centre = median(values);
  const double limit = 5 * kSigmaPerMad * median_absolute_deviation(values, centre);
  std::erase_if(values, [&](double v) { return std::abs(v - centre) > limit; });
  const auto n = static_cast<double>(values.size());
  const double mean = mean_of(values);
  const double squares = sum_of(values, [mean](double v) { return (v - mean) * (v - mean); });
  return {mean, n > 1 ? std::sqrt(squares / (n * (n - 1))) : 0};
}

/// Levels of the sticks on creep factors x = 1/(1 - mu/mu_s), one slope for all.
struct Creep {
  Estimate slope;          // per x
  std::vector<double> x;   // mean of every stick
  double left = HUGE_VAL;  // sum of squares about the lines
};

// mu_s is `above` times the highest friction of each stick. The slopes of the sticks weigh by their leverage.
Creep creep_of(const std::vector<Stick>& sticks, double above) {
  Creep creep;
  std::vector<double> slopes, weights;
  double sum = 0, weight = 0, total = 0;
  for (const Stick& s : sticks) {
    std::array<double, parts> x{};
    for (std::size_t k = 0; k < parts; ++k) {
      const bool loaded = s.highest > 0 && s.friction[k] > 0;
      x[k] = loaded ? 1 / std::max(0.02, 1 - s.friction[k] / (above * s.highest)) : 1;
    }
    const StraightLine line = fit_line(x, s.level);
    for (const double level : s.level) total += (level - line.value) * (level - line.value);
    creep.x.push_back(line.middle);
    slopes.push_back(line.slope);
    weights.push_back(line.squares);
    sum += line.slope * line.squares, weight += line.squares;
  }
  if (!(weight > 0)) return creep;
  creep.slope.value = sum / weight;
  creep.left = total - sum * sum / weight;
  double squares = 0;
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    squares += std::pow(weights[k] * (slopes[k] - creep.slope.value), 2);
  }
  creep.slope.std_error = std::sqrt(squares) / weight;
  return creep;
}

// Mean velocity of the block over the record, from its positions in the middles of the plateaus: what its integration
// constant is wrong by.
Estimate net_velocity(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  std::vector<double> time, position;
  double x = 0;
  std::size_t i = 0;
  for (const StickPlateau& run : plateaus.runs) {
    const std::size_t middle = std::min((run.begin + run.end) / 2 * factor, motion.size() - 1);
    for (; i < middle; ++i) x += motion.step * (motion.disc_velocity_at(i) - motion.relative_velocity[i]);
    time.push_back(static_cast<double>(middle) * motion.step);
    position.push_back(x);
  }
  const auto n = static_cast<double>(time.size());
  const StraightLine line = fit_line(time, position);
  double squares = 0;
  for (std::size_t k = 0; k < time.size(); ++k) squares += std::pow(position[k] - line.at(time[k]), 2);
  return {line.slope, std::sqrt(squares / std::max(1.0, n - 2) / line.squares)};
}

}  // namespace

PlateauRatio plateau_ratio(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  PlateauRatio ratio;
  std::vector<Stick> sticks;
  const std::size_t stride = plateaus.runs.size() / most_plateaus + 1;
  for (std::size_t r = 0; r < plateaus.runs.size(); r += stride) {
    Stick stick;
    if (make_stick(motion, plateaus.runs[r], factor, stick)) sticks.push_back(stick);
  }
  if (sticks.size() < 3) return ratio;
  // Break-away itself is rounded by the creep: mu_s lies somewhat above the highest friction.
  Creep creep;
  for (double above = 1.005; above < 1.06; above += 0.01) {
    Creep next = creep_of(sticks, above);
    if (next.left < creep.left) creep = std::move(next);
  }
  const bool creeps = creep.slope.value < -4 * creep.slope.std_error;
  std::vector<double> levels;
  for (std::size_t k = 0; k < sticks.size(); ++k) {
    levels.push_back(mean_of(sticks[k].level) - (creeps ? creep.slope.value * creep.x[k] : 0));
  }
  const Estimate level = trimmed_mean(std::move(levels));
  ratio.value = ratio.in_motion = level.value;
  const double x = creeps ? median(creep.x) : 0;
  ratio.std_error = std::hypot(level.std_error, x * creep.slope.std_error, kErrorOfCreep * x * creep.slope.value);
  if (motion.high_pass > 0 && motion.constant_disc_velocity != 0) {
    const Estimate net = net_velocity(motion, plateaus, factor);
    ratio.value -= net.value / motion.constant_disc_velocity;
    ratio.std_error = std::hypot(ratio.std_error, net.std_error / motion.constant_disc_velocity, kErrorAfterHighPass);
  }
  return ratio;
}

}  // namespace tribofit::kinematics

namespace tribofit {

void correct_plateau(Motion& motion, PlateauCorrection correction) {
  const double ratio = motion.plateau_ratio, in_motion = motion.plateau_ratio_in_motion;
  if (correction == PlateauCorrection::none || !(ratio > 0)) return;  // NaN: not known
  motion.plateau_correction = correction;
  motion.corrected_ratio = ratio;
  const auto at = [&](std::size_t i) { return motion.disc_velocity_at(i); };
  const double constant = motion.constant_disc_velocity;
  if (correction == PlateauCorrection::radius) {
    // Behind a high-pass the integration constant was set to omega r as stated: it moves along.
    const double shift = in_motion - 1;
    for (std::size_t i = 0; i < motion.size(); ++i) motion.relative_velocity[i] += shift * at(i);
    motion.plateau_velocity += shift * constant;
    for (double& v : motion.disc_velocity) v *= ratio;
    motion.constant_disc_velocity *= ratio;
    motion.notes.push_back(fmt::format("disc: omega r times {} +/- {}, as the plateau of v_b says (radius)",
                                       fixed(ratio, 4), fixed(motion.plateau_ratio_std_error, 4)));
    return;
  }
  const double lost = ratio - in_motion, part = 1 / ratio;
  const auto corrected = [&](double v, double disc) { return disc - part * (disc - v + lost * constant); };
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion.relative_velocity[i] = corrected(motion.relative_velocity[i], at(i));
  }
  motion.plateau_velocity = corrected(motion.plateau_velocity, constant);
  motion.velocity_noise *= part;
  motion.notes.push_back(fmt::format("velocity: divided by {} +/- {}, as the plateau of v_b says (gain)",
                                     fixed(ratio, 4), fixed(motion.plateau_ratio_std_error, 4)));
}

}  // namespace tribofit
