#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "oscillator/find_zero.hpp"
#include "simulated_run.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kPhases = 60;

/// Friction and |v_r| of the mean slip at equal parts of it.
struct MeanSlip {
  std::vector<double> friction, speed;
  double time = 0;  ///< that it takes [s]
};

MeanSlip mean_slip(const SimulatedRun& run) {
  const Motion& motion = run.motion;
  MeanSlip out;
  out.friction.assign(kPhases + 1, 0);
  out.speed.assign(kPhases + 1, 0);
  double count = 0;
  const double first = motion.time.front();
  for (const Cycle& cycle : run.segmentation.cycles) {
    if (!cycle.slip_complete || cycle.stick.size() == 0 || cycle.slip.size() < 8) continue;
    const double begin = (cycle.break_away_time - first) / motion.step,
                 length = (cycle.restick_time - cycle.break_away_time) / motion.step;
    if (!(length > 0)) continue;
    const auto least = static_cast<double>(cycle.slip.begin), most = static_cast<double>(cycle.slip.end - 1);
    for (std::size_t k = 0; k <= kPhases; ++k) {
      const double at = std::clamp(begin + length * static_cast<double>(k) / kPhases, least, most);
      const auto i = std::min(static_cast<std::size_t>(at), cycle.slip.end - 2);
      const double part = at - static_cast<double>(i);
      const auto between = [&](const std::vector<double>& x) {
        return cycle.direction * (x[i] + part * (x[i + 1] - x[i]));
      };
      out.friction[k] += between(motion.friction);
      out.speed[k] += between(motion.relative_velocity);
    }
    out.time += length * motion.step;
    count += 1;
  }
  if (count == 0) return {};
  for (std::size_t k = 0; k <= kPhases; ++k) out.friction[k] /= count, out.speed[k] /= count;
  out.time /= count;
  return out;
}

/// Where the mean slip passes a speed on its way up and down, as phases between 0 and kPhases.
std::optional<std::pair<double, double>> passes(const MeanSlip& slip, double speed) {
  const std::vector<double>& v = slip.speed;
  const auto top = static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
  std::size_t up = 1, down = top + 1;
  while (up <= top && !(v[up] >= speed && v[up - 1] < speed)) ++up;
  while (down < v.size() && !(v[down] <= speed && v[down - 1] > speed)) ++down;
  if (up > top || down >= v.size()) return std::nullopt;
  const auto phase = [&](std::size_t k) { return static_cast<double>(k - 1) + (speed - v[k - 1]) / (v[k] - v[k - 1]); };
  return std::pair{phase(up), phase(down)};
}

double at_phase(const std::vector<double>& x, double phase) {
  const double place = std::clamp(phase, 0.0, static_cast<double>(kPhases));
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(place), kPhases - 1);
  return x[i] + (place - static_cast<double>(i)) * (x[i + 1] - x[i]);
}

/// By how much later than v_r friction would have to be read so that both branches of the slip lie on one another, at
/// speeds between a third and two thirds of the peak [s], and what the block slides meanwhile [m].
struct Loop {
  double time = kNotSeen, distance = kNotSeen;
};
Loop loop_of(const MeanSlip& slip) {
  if (slip.speed.empty()) return {};
  const double peak = *std::max_element(slip.speed.begin(), slip.speed.end());
  std::vector<std::pair<double, double>> places;
  double speed = 0;
  for (const double part : {0.35, 0.45, 0.55, 0.65}) {
    if (const auto place = passes(slip, part * peak)) places.push_back(*place), speed += part * peak;
  }
  if (places.size() < 3) return {};
  const auto gap = [&](double shift) {
    double sum = 0;
    for (const auto& [up, down] : places) {
      sum += at_phase(slip.friction, up + shift) - at_phase(slip.friction, down + shift);
    }
    return sum;
  };
  const double most = 0.25 * kPhases, at_low = gap(-most), at_high = gap(most);
  if (at_low * at_high > 0) return {};
  const double time = find_zero(gap, -most, most, at_low, at_high) / kPhases * slip.time;
  return {time, time * speed / static_cast<double>(places.size())};
}

/// Break-away of every cycle that begins in stick, over its stick time.
RunCurve break_aways(const SimulatedRun& run) {
  RunCurve out;
  for (const Cycle& cycle : run.segmentation.cycles) {
    if (cycle.stick.size() == 0 || !cycle.stick_complete) continue;
    if (!std::isfinite(cycle.break_away_friction) || !std::isfinite(cycle.stick_time)) continue;
    out.x.push_back(cycle.stick_time);
    out.y.push_back(cycle.break_away_friction);
  }
  return out;
}

/// Break-away after sticks of more than half the longest, where those are far longer than most.
double after_long_sticks(const RunCurve& all) {
  if (all.x.size() < 8) return kNotSeen;
  const double longest = *std::max_element(all.x.begin(), all.x.end());
  if (longest < 4 * median(all.x)) return kNotSeen;
  std::vector<double> after;
  for (std::size_t k = 0; k < all.x.size(); ++k) {
    if (all.x[k] > 0.5 * longest) after.push_back(all.y[k]);
  }
  return mean_of(after);
}

/// Mean friction of each slip over time.
RunCurve levels(const SimulatedRun& run) {
  RunCurve out;
  for (const Cycle& cycle : run.segmentation.cycles) {
    if (!cycle.slip_complete || cycle.slip.size() < 8 || !std::isfinite(cycle.break_away_time)) continue;
    double sum = 0;
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) sum += cycle.direction * run.motion.friction[i];
    out.x.push_back(cycle.break_away_time);
    out.y.push_back(sum / static_cast<double>(cycle.slip.size()));
  }
  return out;
}

/// Change from the first quarter of a record to the last.
double change_over(const RunCurve& levels) {
  const std::size_t part = levels.y.size() / 4;
  const std::span<const double> y(levels.y);
  return part < 2 ? kNotSeen : mean_of(y.last(part)) - mean_of(y.first(part));
}

/// Amplitude of the swing of the levels once a revolution, beside a straight line.
double swing_of(const RunCurve& levels, double omega) {
  if (levels.x.size() < 8 || !(omega > 0)) return kNotSeen;
  if (levels.x.back() - levels.x.front() < 2 * 2 * std::numbers::pi / omega) return kNotSeen;
  const StraightLine line = fit_line(levels.x, levels.y);
  double c = 0, s = 0;
  for (std::size_t k = 0; k < levels.x.size(); ++k) {
    const double left = levels.y[k] - line.at(levels.x[k]);
    c += left * std::cos(omega * levels.x[k]), s += left * std::sin(omega * levels.x[k]);
  }
  return 2 * std::hypot(c, s) / static_cast<double>(levels.x.size());
}

/// Mean v_r in the second half of the sticks over friction there: how the block creeps as the spring pulls.
double creep_of(const SimulatedRun& run) {
  double early = 0, late = 0, count = 0;
  for (const Cycle& cycle : run.segmentation.cycles) {
    const std::size_t quarter = cycle.stick.size() / 4;
    if (quarter < 4 || !cycle.stick_complete) continue;
    const auto part = static_cast<double>(quarter);
    for (std::size_t i = 0; i < quarter; ++i) {
      early += cycle.direction * run.motion.relative_velocity[cycle.stick.begin + quarter + i] / part;
      late += cycle.direction * run.motion.relative_velocity[cycle.stick.end - quarter + i] / part;
    }
    count += 1;
  }
  return count > 0 ? 0.5 * (early + late) / count : kNotSeen;
}

}  // namespace

const std::vector<MotionMeasureInfo>& run_measures() {
  static const std::vector<MotionMeasureInfo> all = {
      {"loop of friction over v_r", "ms", kMillisecond},
      {"loop over the distance slid", "um", 1e-6},
      {"break-away", "", 1},
      {"break-away after the longest sticks", "", 1},
      {"mean friction in slip", "", 1},
      {"v_r in stick", "um/s", 1e-6},
      {"change of friction over the run", "", 1},
      {"swing of friction over a revolution", "", 1},
      {"peak v_r", "mm/s", kMillimetre},
      {"stick-slip frequency", "Hz", 1},
  };
  return all;
}

std::vector<double> measure_run(const SimulatedRun& run) {
  const Segmentation& s = run.segmentation;
  if (s.kind != MotionKind::stick_slip) return std::vector<double>(run_measures().size(), kNotSeen);
  const Loop loop = loop_of(mean_slip(run));
  const RunCurve sticks = break_aways(run), level = levels(run);
  const double omega = run.motion.conditions.speed.known() ? run.motion.conditions.speed.value : kNotSeen;
  return {loop.time,     loop.distance,      mean_of(sticks.y),      after_long_sticks(sticks), mean_of(level.y),
          creep_of(run), change_over(level), swing_of(level, omega), s.amplitude.value,         s.frequency.value};
}

RunCurve curve_of_run(const SimulatedRun& run, RunView view) {
  if (view == RunView::stick_time) return break_aways(run);
  if (view == RunView::time) return levels(run);
  const MeanSlip slip = mean_slip(run);
  return {slip.speed, slip.friction};
}

}  // namespace tribofit
