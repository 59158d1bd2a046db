#include "held_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Every `hold.samples`-th value, from the first fresh one on.
void thin_out(const Hold& hold, std::vector<double>& channel) {
  std::size_t kept = 0;
  for (std::size_t i = hold.first; i < channel.size(); i += hold.samples) channel[kept++] = channel[i];
  channel.resize(kept);
}

/// The sample that has become of one.
std::size_t place_of(const Hold& hold, std::size_t sample) {
  return sample <= hold.first ? 0 : (sample - hold.first + hold.samples - 1) / hold.samples;
}

/// A stretch of a channel in which its values are looked at, and where it begins.
std::pair<std::span<const double>, std::size_t> middle_of(std::span<const double> channel) {
  const std::size_t n = std::min(channel.size(), kValuesForSteps), from = (channel.size() - n) / 2;
  return {channel.subspan(from, n), from};
}

/// The sum at a place in every so many, with so many places to either side.
double sum_about(const std::vector<double>& sums, std::size_t phase, std::size_t beside) {
  const std::size_t count = sums.size();
  double sum = sums[phase];
  for (std::size_t k = 1; k <= beside; ++k) sum += sums[(phase + k) % count] + sums[(phase + count - k) % count];
  return sum;
}

std::size_t largest_about(const std::vector<double>& sums, std::size_t beside) {
  std::size_t best = 0;
  for (std::size_t phase = 1; phase < sums.size(); ++phase)
    best = sum_about(sums, phase, beside) > sum_about(sums, best, beside) ? phase : best;
  return best;
}

/// Squares by their place in every so many; nothing once more than `apart` is not about one place, wherever that is.
std::vector<double> by_phase(std::span<const double> squares, std::size_t count, std::size_t beside, double apart) {
  constexpr std::size_t kLookEvery = 2048;
  std::vector<double> sums(count, 0);
  for (std::size_t begin = 0, next = kLookEvery; begin < squares.size(); begin += count) {
    const std::size_t some = std::min(count, squares.size() - begin);
    for (std::size_t phase = 0; phase < some; ++phase) sums[phase] += squares[begin + phase];
    if (begin < next) continue;
    next = begin + kLookEvery;
    const double seen = std::reduce(sums.begin(), sums.end());
    if (seen - sum_about(sums, largest_about(sums, beside), beside) > apart) return {};
  }
  return sums;
}

/// Whether there is much at the knots and next to nothing elsewhere: all of a few events may fall there by chance.
bool only_there(std::span<const double> squares, const Hold& hold, std::size_t beside) {
  std::vector<double> knots, others;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const std::size_t after = (i + hold.samples - hold.first) % hold.samples;
    (std::min(after, hold.samples - after) <= beside ? knots : others).push_back(squares[i]);
  }
  return median(std::move(knots)) > kBendsMore * kBendsMore * quantile(std::move(others), 0.95);
}

/// The most samples of which one, with so many to either side, has so much of the squares, and which; of events that
/// are few not by chance.
Hold spaced(std::span<const double> squares, double part, std::size_t beside, bool few) {
  constexpr double kRounding = 1e-9;  // of the sums
  const double all = std::reduce(squares.begin(), squares.end());
  for (std::size_t count = kLongestHold; all > 0 && count > 2 * beside + 1; --count) {
    const std::vector<double> sums = by_phase(squares, count, beside, (1 - part + kRounding) * all);
    if (sums.empty()) continue;
    const Hold best{count, largest_about(sums, beside)};
    const bool enough = sum_about(sums, best.first, beside) > part * all;
    if (enough && (!few || only_there(squares, best, beside))) return best;
  }
  return {};
}

}  // namespace

Hold find_hold(std::span<const double> channel) {
  const auto [x, from] = middle_of(channel);
  if (x.size() < kFewestDistributed) return {};
  std::vector<double> changes(x.size(), 0), bends(x.size(), 0);
  for (std::size_t i = 1; i < x.size(); ++i) changes[i] = x[i] != x[i - 1] ? 1 : 0;
  if (std::reduce(changes.begin(), changes.end()) < static_cast<double>(kFewestDistributed)) return {};
  Hold hold = spaced(changes, kHeldAlike, 0, false);
  if (hold.samples == 1) {
    for (std::size_t i = 1; i + 1 < x.size(); ++i) bends[i] = std::pow(x[i + 1] - 2 * x[i] + x[i - 1], 2);
    hold = spaced(bends, kBendAlike, 0, true);
  }
  if (hold.samples == 1) {  // cubic from knot to knot: the fourth difference is not zero there and beside it
    std::ranges::fill(bends, 0);
    for (std::size_t i = 2; i + 2 < x.size(); ++i)
      bends[i] = std::pow(x[i - 2] + x[i + 2] - 4 * (x[i - 1] + x[i + 1]) + 6 * x[i], 2);
    hold = spaced(bends, kBendAlike, 1, true);
  }
  hold.first = (hold.first + from) % hold.samples;
  return hold;
}

void keep_fresh_values(Trace& trace, int threads, std::vector<std::string>& notes) {
  Hold friction, velocity;
  run_tasks(2, threads, [&](std::size_t k) {
    (k == 0 ? friction : velocity) = find_hold(k == 0 ? trace.friction : trace.velocity);
  });
  const Hold& hold = velocity.samples > friction.samples ? velocity : friction;
  if (hold.samples == 1 || trace.size() / hold.samples < kFewestDistributed) return;
  const char* which = friction.samples == velocity.samples ? "friction and velocity have"
                      : &hold == &velocity                 ? "the velocity has"
                                                           : "friction has";
  notes.push_back(
      fmt::format("{} a value of its own in one of {} samples, which is used; the others are copies or lie on lines or "
                  "curves: the record is one at {}",
                  which, hold.samples, frequency_text(trace.rate() / static_cast<double>(hold.samples))));
  for (auto* channel :
       {&trace.time, &trace.friction, &trace.velocity, &trace.block_position, &trace.drive_position,
        &trace.friction_std_error, &trace.velocity_std_error, &trace.acceleration, &trace.velocity_variance,
        &trace.load, &trace.temperature, &trace.disc_speed, &trace.disc_angle}) {
    thin_out(hold, *channel);
  }
  for (Step& step : trace.steps) step.begin = place_of(hold, step.begin), step.end = place_of(hold, step.end);
  if (!trace.steps.empty()) trace.steps.back().end = trace.size();
}

}  // namespace tribofit::kinematics
