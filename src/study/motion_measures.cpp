#include "motion_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "segmentation/counts.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kHarmonics = 5;
constexpr std::size_t kPortraitPoints = 24;

/// Break-aways that are followed by another of the same direction, as samples.
struct Turn {
  double begin = 0, end = 0;  ///< break-away times, in samples of the motion
};

std::vector<Turn> turns_of(const Motion& motion, const Segmentation& s) {
  std::vector<Turn> turns;
  const double first = motion.time.front();
  for (const Cycle& cycle : s.cycles) {
    if (!(cycle.period > 0) || cycle.stick.size() == 0) continue;
    const double begin = (cycle.break_away_time - first) / motion.step, length = cycle.period / motion.step;
    if (begin >= 0 && begin + length <= static_cast<double>(motion.size() - 1))
      turns.push_back({begin, begin + length});
  }
  return turns;
}

/// Least friction in a slip, of means over a twentieth of it: single samples would show the noise.
double least_friction(const Motion& motion, const Cycle& cycle) {
  const std::size_t n = cycle.slip.size(), window = std::max<std::size_t>(1, n / 20);
  double sum = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
    sum += cycle.direction * motion.friction[i];
    if (i >= cycle.slip.begin + window) sum -= cycle.direction * motion.friction[i - window];
    if (i + 1 >= cycle.slip.begin + window) least = std::min(least, sum / static_cast<double>(window));
  }
  return least;
}

double block_velocity(const Motion& motion, std::size_t i) {
  return motion.disc_velocity_at(i) - motion.relative_velocity[i];
}

/// Mean square of v_b and harmonics of v_r over one turn, by the trapezoid rule with the ends between samples.
struct TurnMeasures {
  double square = 0;
  std::array<double, kHarmonics> amplitude{};
};

TurnMeasures over_turn(const Motion& motion, const Turn& turn) {
  const auto first = static_cast<std::size_t>(std::ceil(turn.begin)), last = static_cast<std::size_t>(turn.end);
  const double length = turn.end - turn.begin;
  TurnMeasures out;
  std::array<std::complex<double>, kHarmonics> sums{};
  const std::complex<double> step = std::polar(1.0, -2 * std::numbers::pi / length);
  std::complex<double> at = std::polar(1.0, -2 * std::numbers::pi * (static_cast<double>(first) - turn.begin) / length);
  for (std::size_t i = first; i <= last; ++i, at *= step) {
    double weight = 1;
    if (i == first) weight = 0.5 + static_cast<double>(first) - turn.begin;
    if (i == last) weight = 0.5 + turn.end - static_cast<double>(last);
    const double v = block_velocity(motion, i);
    out.square += weight * v * v / length;
    std::complex<double> power = weight * motion.relative_velocity[i];
    for (std::complex<double>& sum : sums) sum += power *= at;
  }
  for (std::size_t h = 0; h < kHarmonics; ++h) out.amplitude[h] = 2 / length * std::abs(sums[h]);
  return out;
}

/// The slip of one cycle at equal parts of it, from break-away to re-stick.
void add_portrait(const Motion& motion, const Cycle& cycle, std::vector<std::vector<double>>& points) {
  if (!cycle.slip_complete || cycle.stick.size() == 0 || cycle.slip.size() < 4) return;
  const double first = motion.time.front();
  const double begin = (cycle.break_away_time - first) / motion.step, end = (cycle.restick_time - first) / motion.step;
  if (!(begin >= 0 && end > begin && end < static_cast<double>(motion.size() - 1))) return;
  // x from break-away on, where the block moves with the disc.
  auto i = static_cast<std::size_t>(std::ceil(begin));
  double x = (static_cast<double>(i) - begin) * motion.step * block_velocity(motion, i);
  for (std::size_t k = 1; k <= kPortraitPoints; ++k) {
    const double place = begin + (end - begin) * static_cast<double>(k) / kPortraitPoints;
    for (; static_cast<double>(i + 1) <= place; ++i) {
      x += 0.5 * motion.step * (block_velocity(motion, i) + block_velocity(motion, i + 1));
    }
    const double rest = place - static_cast<double>(i), here = block_velocity(motion, i);
    const double v = here + rest * (block_velocity(motion, i + 1) - here);
    points[k - 1].push_back(x + 0.5 * rest * motion.step * (here + v));
    points[kPortraitPoints + k - 1].push_back(v);
  }
}

}  // namespace

const std::vector<MotionMeasureInfo>& motion_measures() {
  static const std::vector<MotionMeasureInfo> list = {
      {"period", "ms", 1e-3},
      {"stick time", "ms", 1e-3},
      {"amplitude of v_r", "mm/s", 1e-3},
      {"break-away friction", "1", 1},
      {"least friction in slip", "1", 1},
      {"RMS of v_b", "mm/s", 1e-3},
      {"fundamental frequency", "Hz", 1},
      {"harmonic 1 of v_r", "mm/s", 1e-3},
      {"harmonic 2 of v_r", "mm/s", 1e-3},
      {"harmonic 3 of v_r", "mm/s", 1e-3},
      {"harmonic 4 of v_r", "mm/s", 1e-3},
      {"harmonic 5 of v_r", "mm/s", 1e-3},
  };
  return list;
}

MotionMeasures measure_motion(const Motion& motion, const Segmentation& s) {
  std::vector<double> break_away, least, squares;
  std::array<std::vector<double>, kHarmonics> harmonics;
  std::vector<std::vector<double>> points(2 * kPortraitPoints);
  for (const Cycle& cycle : s.cycles) {
    if (cycle.stick.size() > 0) break_away.push_back(cycle.break_away_friction);
    if (cycle.slip_complete && cycle.slip.size() > 0) least.push_back(least_friction(motion, cycle));
    add_portrait(motion, cycle, points);
  }
  for (const Turn& turn : turns_of(motion, s)) {
    const TurnMeasures measures = over_turn(motion, turn);
    squares.push_back(measures.square);
    for (std::size_t h = 0; h < kHarmonics; ++h) harmonics[h].push_back(measures.amplitude[h]);
  }
  const double f = s.frequency.value;
  const Estimate period{1 / f, s.frequency.std_error / (f * f), s.frequency.degrees_of_freedom};
  Estimate rms = mean_with_error(squares);
  rms.value = std::sqrt(rms.value);
  rms.std_error /= 2 * rms.value;
  // The line lies where the mean frequency does, and is as well known.
  const Estimate line{fundamental(motion.relative_velocity, motion.step).frequency, s.frequency.std_error,
                      s.frequency.degrees_of_freedom};
  MotionMeasures out;
  out.values = {period, s.stick_time, s.amplitude, mean_with_error(break_away), mean_with_error(least), rms, line};
  for (const std::vector<double>& harmonic : harmonics) out.values.push_back(mean_with_error(harmonic));
  for (const std::vector<double>& point : points) out.values.push_back(mean_with_error(point));
  return out;
}

}  // namespace tribofit
