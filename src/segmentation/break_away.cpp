#include "break_away.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "growth_fit.hpp"
#include "limits.hpp"
#include "phases.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::segmentation {
namespace {

/// An onset with the level of its own stick: creep of the contact, a ripple of the disc or a wrong radius is no slip.
struct Rise {
  Onset onset;
  double stick_level = 0;     // v above the plateau in a quarter of the stick, the third where that is long [m/s]
  std::size_t level_end = 0;  // of that quarter
};

double above_stick(const Motion& m, const Rise& r, std::size_t i) {
  return r.onset.direction * above_plateau(m, i) - r.stick_level;
}

// First sample above `level` of the rise that leads to the slip.
std::size_t rises_above(const Motion& m, const Rise& r, double level) {
  std::size_t i = r.onset.slip;
  while (i > r.onset.stick_begin && above_stick(m, r, i - 1) > level) --i;
  return i;
}

Rise rise_of(const Motion& m, const Onset& onset) {
  const Rise flat{onset, 0, onset.stick_begin};
  const std::size_t n = onset.slip - onset.stick_begin;
  if (n < kShowsLevel) return flat;
  // A short stick ends well before the velocity has grown to where the slip begins.
  const std::size_t half = rises_above(m, flat, 0.5 * above_stick(m, flat, onset.slip));
  const std::size_t doublings = kDoublings * (onset.slip - half);
  // What is there in the second quarter of the stick already is creep, or a motion that only turns, not growth: the
  // third quarter is its level.
  const auto mean_above = [&](std::size_t begin) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + n / 4; ++i) sum += above_stick(m, flat, i);
    return sum / static_cast<double>(n / 4);
  };
  const double second = mean_above(onset.stick_begin + n / 4), third = mean_above(onset.stick_begin + n / 2);
  const bool creeps = 4 * (onset.slip - half) > n || std::abs(second) > kAlreadyThere * std::abs(third);
  const std::size_t grown = creeps ? n / 4 : std::clamp(doublings, n / 4, n);
  const std::size_t length = std::min(n / 4, n - grown), end = onset.slip - grown;
  if (length < kShortestQuarter) return flat;
  Rise rise{onset, 0, end};
  for (std::size_t i = end - length; i < end; ++i) rise.stick_level += above_stick(m, flat, i);
  rise.stick_level /= static_cast<double>(length);
  return rise;
}

// Time constant of the growth [samples] from the time between two levels, as if it were exponential.
double growth_time(const Motion& m, const std::vector<Rise>& rises, double level) {
  std::vector<double> times;
  for (const Rise& r : rises) {
    const std::size_t low = rises_above(m, r, level);
    std::size_t high = low;
    while (high + 1 < m.size() && above_stick(m, r, high) < kGrowthRatio * level) ++high;
    times.push_back(static_cast<double>(high - low) / std::log(kGrowthRatio));
  }
  return std::max(0.5, median(std::move(times)));
}

/// Last sample up to `last` before a step of the disc's speed that v_r follows.
std::size_t before_step(const Motion& m, const Rise& r, std::size_t begin, std::size_t last, double level) {
  if (m.disc_velocity.empty()) return last;
  for (std::size_t i = last; i > begin; --i) {
    const double step = std::abs(m.disc_velocity[i] - m.disc_velocity[i - 1]);
    if (step > level && above_stick(m, r, i) - above_stick(m, r, i - 1) > level) return i - 1;
  }
  return last;
}

Window window_of(const Motion& m, const Rise& r, double level, double growth) {
  Window w;
  const std::size_t crossing = rises_above(m, r, level);
  // Some time constants, but not into the part of the stick that gives the level: a creeping contact has no sharp
  // onset.
  const auto stick = static_cast<double>(r.onset.slip - std::min(r.level_end, crossing));
  const auto before = static_cast<std::size_t>(
      std::clamp(kTimeConstants * growth, kShortestGrowth, std::max(kShortestGrowth, std::min(kLongestGrowth, stick))));
  w.begin = crossing > r.onset.stick_begin + before ? crossing - before : r.onset.stick_begin;
  // In a short stick the window may reach back into the end of the slip before.
  while (w.begin < crossing && above_stick(m, r, w.begin) > level) ++w.begin;
  // A disc that steps carries v_r over the level at once: that is no growth.
  const std::size_t end = before_step(m, r, w.begin, crossing, level);
  w.is_cut = end < crossing;
  w.squares.push_back(0);
  for (std::size_t i = w.begin; i <= end; ++i) {
    w.v.push_back(above_stick(m, r, i));
    w.squares.push_back(w.squares.back() + w.v.back() * w.v.back());
  }
  w.crossing = static_cast<double>(end - w.begin);
  return w;
}

/// The rises of a record with the speeds of the disc at each, over their median: it loads the spring at that speed, and
/// the block leaves in proportion to it.
std::vector<Window> windows_of(const Motion& m, const std::vector<Rise>& rises, double level, double growth,
                               int threads) {
  std::vector<Window> windows(rises.size());
  run_tasks(rises.size(), threads, [&](std::size_t k) { windows[k] = window_of(m, rises[k], level, growth); });
  std::vector<double> speeds;
  for (const Window& window : windows) {
    const std::size_t end = window.begin + static_cast<std::size_t>(window.crossing);
    speeds.push_back(std::abs(m.disc_velocity_at(end)));
  }
  const double usual = median(speeds);
  for (std::size_t k = 0; k < windows.size() && usual > 0; ++k)
    windows[k].pull = std::clamp(speeds[k] / usual, kSlowestPull, 1 / kSlowestPull);
  return windows;
}

/// What all break-aways of a record have in common.
struct CommonGrowth {
  double level = 0;  // where the fit of a rise ends [m/s]
  double time = 0;   // in which the velocity grows e-fold [samples]
  PooledFit fit;
  double variance = 0;                                       // of a sample, enlarged where noise is coloured
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  // of (log A, log lambda, B, gain)
};

// Rises that are whole, evenly picked.
std::vector<Window> pool_of(const std::vector<Window>& windows) {
  const std::size_t stride = (windows.size() + kMostPooled - 1) / kMostPooled;
  std::vector<Window> pool;
  for (std::size_t i = 0; i < windows.size(); i += stride) {
    if (!windows[i].is_cut) pool.push_back(windows[i]);
  }
  return pool.empty() ? windows : pool;
}

/// A fit with more in it takes the place of one with less where it explains more than noise would, coloured as it may
/// be, and leaves no more than a part of its squares.
void prefer(PooledFit& fit, Noise& colour, PooledFit&& fuller, const std::vector<Window>& pool, double leaves) {
  const double per_sample = fuller.rss / static_cast<double>(fuller.samples);
  if (!(fit.rss - fuller.rss > kJumpExplains * colour.inflation * per_sample && fuller.rss < leaves * fit.rss)) return;
  fit = std::move(fuller);
  colour = noise_of(pool, fit.growth);
}

CommonGrowth fit_common_growth(const std::vector<Window>& windows, double level, double time) {
  CommonGrowth common;
  common.level = level;
  common.time = time;
  const Growth start{level / 4.4, 1 / common.time};  // v reaches the end of the fit at x = 2
  std::vector<Window> pool = pool_of(windows);
  PooledFit& fit = common.fit;
  fit = fit_growth(pool, start, {});
  Noise colour = noise_of(pool, fit.growth);
  std::vector<Window> jump_pool = pool_of(windows);
  PooledFit jump = fit_growth(jump_pool, {fit.growth.a, fit.growth.lambda, kFirstJump * level}, {.jump = true});
  prefer(fit, colour, std::move(jump), jump_pool, kJumpLeaves);
  if (std::ranges::any_of(windows, [](const Window& w) { return w.excess != 0; })) {
    std::vector<Window> gain_pool = pool_of(windows);
    PooledFit gain = fit_growth(gain_pool, fit.growth, {.jump = fit.growth.b > 0, .gain = true});
    prefer(fit, colour, std::move(gain), gain_pool, 1);
  }
  // What the data leave open (A against lambda where the growth starts at once) is bounded by what is plausible: a
  // factor of three on the rates, a jump of the size of the window.
  common.variance = std::max(colour.effective(), kRoundingPart * level * level);
  const Eigen::Vector4d plausible(1.0, 1.0, 1 / (level * level), 1.0);
  const Eigen::Matrix4d information = fit.information / common.variance + Eigen::Matrix4d(plausible.asDiagonal());
  common.covariance = information.inverse();
  const auto is_known = [&common](int k) { common.covariance.row(k).setZero(), common.covariance.col(k).setZero(); };
  if (fit.growth.b == 0) is_known(2);
  if (fit.growth.gain == 0) is_known(3);
  return common;
}

// Each rise with its own break-away.
void locate_each(std::vector<Window>& windows, const CommonGrowth& common, int threads) {
  run_tasks(windows.size(), threads, [&](std::size_t k) {
    Window& w = windows[k];
    const Growth growth = growth_in(w, common.fit.growth);
    const double reaches = std::log1p(common.level / (growth.a + growth.b)) / growth.lambda;
    w.t0 = fit_time(w, common.fit.growth, w.crossing - reaches);
  });
}

double time_of(const Motion& m, const Window& w, double t0) {
  const double index = std::max(0.0, static_cast<double>(w.begin) + t0);
  const std::size_t whole = std::min(static_cast<std::size_t>(index), m.size() - 1);
  return m.time[whole] + (index - static_cast<double>(whole)) * m.step;
}

/// A block that friction held with more force leaves faster. Whether the break-aways differ in it.
bool set_excess(const Motion& m, const std::vector<Rise>& rises, int threads, std::vector<Window>& windows) {
  if (m.friction.empty()) return false;
  std::vector<double> levels(windows.size()), known;
  run_tasks(windows.size(), threads, [&](std::size_t k) {
    const Onset& onset = rises[k].onset;
    const StickFriction at_break =
        friction_at(m, {onset.stick_begin, onset.slip}, time_of(m, windows[k], windows[k].t0), onset.direction);
    levels[k] = std::isfinite(at_break.level.std_error) ? at_break.level.value : std::nan("");
  });
  std::copy_if(levels.begin(), levels.end(), std::back_inserter(known), [](double level) { return level == level; });
  if (known.size() < kFewestLevels) return false;
  const double usual = median(std::move(known));
  if (!(usual > 0)) return false;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const double excess = levels[k] / usual - 1;
    windows[k].excess = std::isfinite(excess) ? std::clamp(excess, -kMostExcess, kMostExcess) : 0;
  }
  return true;
}

// A contact that creeps has no sharp onset: what leads up to the slip belongs to the stick.
bool contact_creeps(const std::vector<Rise>& rises, const std::vector<Window>& windows) {
  std::vector<double> gradualness;
  for (std::size_t k = 0; k < rises.size(); ++k) {
    const Window& w = windows[k];
    const double crossing = static_cast<double>(w.begin) + w.crossing;
    gradualness.push_back((w.crossing - w.t0) / std::max(1.0, static_cast<double>(rises[k].onset.slip_end) - crossing));
  }
  return median(std::move(gradualness)) > kGradual;
}

/// In samples from the begin of the window.
BreakAway settle_break_away(const Window& w, const CommonGrowth& common, bool creeps) {
  const double error = std::max(1.0, w.crossing);  // nothing is less certain than the window is long
  if (creeps) return {w.crossing, std::min(error, common.time), false};
  const Sums s = sums_of(w, common.fit.growth, w.t0);
  if (w.t0 < w.crossing - kShowsGrowth && s.h > 0) {
    const Eigen::Vector4d lever = s.mixed / s.h;
    const double own = common.variance / s.h + std::max(0.0, lever.dot(common.covariance * lever));
    const double seen = w.crossing - w.t0;
    const double best = kBetweenSamples / std::clamp(seen * seen, 1.0, 1 / kBetweenSamples);
    return {w.t0, std::min(error, std::sqrt(own + best)), seen < kFewShowGrowth};
  }
  // No growth as from a stick (a velocity that merely turns near zero): where it last leaves the level of the stick.
  std::size_t i = w.v.size() - 1;
  while (i > 0 && w.v[i] > kLeavesStick * common.level) --i;
  const auto t0 = static_cast<double>(i);
  return {t0, std::max(1.0, w.crossing - t0), true};
}

/// Where the stretch before `end` begins over which the disc pulls at about the speed it has at the end: a disc that
/// stood still, or was slower, in the same stick loaded the spring along another line.
std::size_t begin_of_pull(const Motion& motion, std::size_t begin, std::size_t end) {
  if (motion.disc_velocity.empty() || end < begin + kShowsLine) return begin;
  const double least = kSlowerPull * std::abs(motion.disc_velocity[end - 1]);
  std::size_t i = end - kShowsLine;
  while (i > begin && std::abs(motion.disc_velocity[i - 1]) > least) --i;
  return i;
}

}  // namespace

std::vector<BreakAway> locate_break_aways(const Motion& motion, const std::vector<Onset>& onsets, double peak,
                                          int threads) {
  std::vector<BreakAway> result;
  if (onsets.empty()) return result;
  const double noise = motion.velocity_noise;
  const double level = std::max({kGrowthOverPeak * peak, std::min(kClearOfNoise * noise, kGrowthAtMost * peak),
                                 std::min(kinematics::kSlipsOverError * noise, kinematics::kSlipsOverFastest * peak)});
  std::vector<Rise> rises(onsets.size());
  run_tasks(onsets.size(), threads, [&](std::size_t k) { rises[k] = rise_of(motion, onsets[k]); });
  const double growth = growth_time(motion, rises, level);
  std::vector<Window> windows = windows_of(motion, rises, level, growth, threads);
  CommonGrowth common = fit_common_growth(windows, level, growth);
  locate_each(windows, common, threads);
  if (set_excess(motion, rises, threads, windows)) {
    common = fit_common_growth(windows, level, growth);
    locate_each(windows, common, threads);
  }
  const bool creeps = contact_creeps(rises, windows);
  for (std::size_t k = 0; k < rises.size(); ++k) {
    const BreakAway at = settle_break_away(windows[k], common, creeps);
    result.push_back({std::max(time_of(motion, windows[k], at.time), motion.time[rises[k].onset.stick_begin]),
                      motion.step * at.std_error, at.is_sharp});
  }
  return result;
}

double locate_restick(const Motion& motion, SampleRange slip, std::size_t next, int direction, double peak) {
  const double noise = motion.velocity_noise;
  const double low = std::min(kRestickNoise * noise, kRestickAtMost * peak),
               high = std::max(kEndAtLeast * peak, std::min(kClearOfNoise * noise, kEndAtMost * peak));
  const auto u = [&](std::size_t i) { return direction * above_plateau(motion, i); };
  // First sample on the plateau, or the slowest where the motion turns before it gets there.
  std::size_t last = slip.end;
  for (std::size_t i = slip.end; i < std::min(next, slip.end + kRestickWithin) && u(last) > low; ++i)
    last = u(i) < u(last) ? i : last;
  std::size_t first = last;
  while (first > slip.begin && u(first - 1) < high) --first;
  if (last - first < 2) {  // steeper than the sampling: the last two samples of the slip point to the plateau
    if (last < slip.begin + 2) return motion.time[last];
    const double steepness = u(last - 2) - u(last - 1);
    const double part = steepness > 0 ? std::clamp(u(last - 1) / steepness, 0.0, 1.0) : 0.5;
    return motion.time[last - 1] + part * motion.step;
  }
  const auto n = static_cast<double>(last - first);
  std::vector<double> end;
  for (std::size_t i = first; i < last; ++i) end.push_back(u(i));
  const StraightLine line = fit_line(end);
  const double where = line.slope < 0 ? line.middle - line.value / line.slope : n;
  return motion.time[first] + std::clamp(where, 0.0, n + 1) * motion.step;
}

StickFriction friction_at(const Motion& motion, SampleRange stick, double time, int direction) {
  std::size_t begin = stick.size() > 2 * kShowsLine ? stick.begin + stick.size() / 2 : stick.begin;
  std::size_t end = std::min(stick.end, motion.size());
  while (end > begin && motion.time[end - 1] >= time - motion.step) --end;
  // The line goes on from the last good sample; lone spoilt ones before it are on the line already.
  if (end > begin && motion.has_fault(end - 1, SampleFault::friction)) {
    while (end > stick.begin && motion.has_fault(end - 1, SampleFault::friction)) --end;
    begin = end > stick.begin + 2 * kShowsLine ? stick.begin + (end - stick.begin) / 2 : stick.begin;
  }
  begin = begin_of_pull(motion, begin, end);
  if (end < begin + kShortestLine) {
    const double last = stick.size() > 0 ? direction * motion.friction[stick.end - 1] : std::nan("");
    return {{last, std::nan("")}, std::nan("")};
  }
  const auto friction = std::span<const double>(motion.friction).subspan(begin, end - begin);
  Parabola parabola = fit_parabola(friction);
  const double n = parabola.count, curvature_norm = parabola.curvature_norm();
  if (n <= 3) parabola.curvature = 0;
  const Remainder left = remainder_about(parabola, friction);
  const double variance = left.squares / std::max(1.0, n - 3) * variance_inflation(left.correlation(kMostCorrelation));
  const double x = (time - motion.time[begin]) / motion.step - parabola.centre();
  double factor = 1 / n + x * x / parabola.line_norm();
  const bool is_curved =
      n > static_cast<double>(kShowsLine) &&
      parabola.curvature * parabola.curvature * curvature_norm > kClearCurvature * kClearCurvature * variance;
  if (is_curved) factor += std::pow(x * x - parabola.shift(), 2) / curvature_norm;
  const double line = parabola.mean + parabola.slope * x;
  return {{direction * (is_curved ? parabola.at(x) : line), std::sqrt(variance * factor)},
          direction * parabola.slope / motion.step};
}

}  // namespace tribofit::segmentation
