#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "clock.hpp"
#include "join.hpp"

namespace tribofit {
namespace {

double quantile(const std::vector<double>& values, double part) {
  std::vector<double> sample;
  const std::size_t stride = std::max<std::size_t>(1, values.size() / 20000);
  for (std::size_t i = 0; i < values.size(); i += stride) sample.push_back(values[i]);
  const auto at = sample.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(sample.size() - 1));
  std::nth_element(sample.begin(), at, sample.end());
  return *at;
}

/// The velocity most samples have, and how far slip takes it away from that.
struct Plateau {
  double velocity = 0, reach = 0;
};

Plateau find_plateau(const std::vector<double>& velocity) {
  const double low = quantile(velocity, 0.002), high = quantile(velocity, 0.998);
  std::array<std::size_t, 100> bins{};
  const double width = (high - low) / static_cast<double>(bins.size());
  if (!(width > 0)) return {low, 0};
  for (const double v : velocity) {
    const double bin = std::clamp((v - low) / width, 0.0, static_cast<double>(bins.size() - 1));
    ++bins[static_cast<std::size_t>(bin)];
  }
  const auto top = std::max_element(bins.begin(), bins.end()) - bins.begin();
  const double mode = low + (static_cast<double>(top) + 0.5) * width;
  return {mode, std::max(high - mode, mode - low)};
}

/// Times at which `signal` goes from below `arm` to above `level`, where it has been below `arm` since the last time.
template <typename Signal>
std::vector<double> upward_crossings(const std::vector<double>& time, Signal signal, double arm, double level) {
  std::vector<double> events;
  bool armed = false;
  double last = signal(0);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double value = signal(i);
    if (value < arm) armed = true;
    if (armed && value > level && i > 0) {
      armed = false;
      events.push_back(time[i - 1] + (time[i] - time[i - 1]) * (level - last) / (value - last));
    }
    last = value;
  }
  return events;
}

double median_interval(const std::vector<double>& events) {
  return events.size() > 1 ? typical_interval(events) : 0;
}

struct Candidate {
  double offset = 0;
  std::size_t support = 0;
};

/// Offsets under which most events of both coincide, best first.
std::vector<Candidate> coincidences(const std::vector<double>& a, const std::vector<double>& b, double width,
                                    double apart) {
  std::vector<double> differences;
  for (const double x : a) {
    for (const double y : b) differences.push_back(x - y);
  }
  std::sort(differences.begin(), differences.end());
  std::vector<Candidate> windows;
  for (std::size_t i = 0, j = 0; i < differences.size(); ++i) {
    while (j < differences.size() && differences[j] <= differences[i] + width) ++j;
    windows.push_back({(differences[i] + differences[j - 1]) / 2, j - i});
  }
  std::stable_sort(windows.begin(), windows.end(), [](const auto& x, const auto& y) { return x.support > y.support; });
  std::vector<Candidate> best;
  for (const Candidate& window : windows) {
    if (best.size() == 8 || (!best.empty() && 10 * window.support < 6 * best.front().support)) break;
    const bool is_new = std::all_of(best.begin(), best.end(),
                                    [&](const Candidate& c) { return std::abs(c.offset - window.offset) > apart; });
    if (is_new) best.push_back(window);
  }
  return best;
}

/// How far friction is from being a function of the velocity in slip, at a given offset.
class Scatter {
 public:
  Scatter(const std::vector<double>& friction_time, const std::vector<double>& friction,
          const std::vector<double>& velocity_time, const std::vector<double>& velocity, const Plateau& plateau)
      : friction_time_(friction_time),
        friction_(friction),
        velocity_time_(velocity_time),
        velocity_(velocity),
        plateau_(plateau) {}

  /// Variance of friction within bins of velocity over that in all of them, for friction samples [begin, end).
  double operator()(double offset, std::size_t begin, std::size_t end, std::size_t stride) const {
    struct Sum {
      double n = 0, sum = 0, squares = 0;
      double variance() const { return n > 0 ? squares - sum * sum / n : 0; }
    };
    std::array<Sum, 60> bins{};
    Sum all;
    std::size_t k = 0;
    for (std::size_t i = begin; i < end; i += stride) {
      const double t = friction_time_[i] - offset;
      if (t < velocity_time_.front() || t >= velocity_time_.back()) continue;
      if (k == 0)
        k = static_cast<std::size_t>(std::upper_bound(velocity_time_.begin(), velocity_time_.end(), t) -
                                     velocity_time_.begin()) -
            1;
      while (velocity_time_[k + 1] <= t) ++k;
      const double part = (t - velocity_time_[k]) / (velocity_time_[k + 1] - velocity_time_[k]);
      const double away =
          (velocity_[k] + part * (velocity_[k + 1] - velocity_[k]) - plateau_.velocity) / plateau_.reach;
      if (std::abs(away) < 0.08) continue;  // stick, where friction is not a function of velocity
      const double bin = std::clamp((away + 1) * 30, 0.0, 59.0);
      for (Sum* sum : {&bins[static_cast<std::size_t>(bin)], &all}) {
        sum->n += 1;
        sum->sum += friction_[i];
        sum->squares += friction_[i] * friction_[i];
      }
    }
    double within = 0;
    for (const Sum& bin : bins) within += bin.variance();
    return all.n > 10 && all.variance() > 0 ? within / all.variance() : 1;
  }

  /// The offset of least scatter within `reach` of `start`.
  double minimise(double start, double reach, std::size_t begin, std::size_t end, std::size_t stride,
                  double tolerance) const {
    const auto cost = [&](double offset) { return (*this)(offset, begin, end, stride); };
    double best = start, least = std::numeric_limits<double>::infinity();
    constexpr int steps = 40;
    for (int i = 0; i <= steps; ++i) {
      const double offset = start + reach * (2.0 * i / steps - 1);
      if (const double c = cost(offset); c < least) {
        least = c;
        best = offset;
      }
    }
    // golden section
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    double low = best - 2 * reach / steps, high = best + 2 * reach / steps;
    double left = high - ratio * (high - low), right = low + ratio * (high - low);
    double left_cost = cost(left), right_cost = cost(right);
    while (high - low > tolerance) {
      if (left_cost < right_cost) {
        high = right;
        right = left;
        right_cost = left_cost;
        left = high - ratio * (high - low);
        left_cost = cost(left);
      } else {
        low = left;
        left = right;
        left_cost = right_cost;
        right = low + ratio * (high - low);
        right_cost = cost(right);
      }
    }
    return (low + high) / 2;
  }

 private:
  const std::vector<double>&friction_time_, &friction_, &velocity_time_, &velocity_;
  Plateau plateau_;
};

}  // namespace

ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity) {
  const double low = quantile(friction, 0.05), high = quantile(friction, 0.95);
  const Plateau plateau = find_plateau(velocity);
  if (!(high > low) || !(plateau.reach > 0)) return {};
  auto falls = upward_crossings(
      friction_time, [&](std::size_t i) { return -friction[i]; }, -(low + 0.7 * (high - low)),
      -(low + 0.45 * (high - low)));
  auto jumps = upward_crossings(
      velocity_time, [&](std::size_t i) { return std::abs(velocity[i] - plateau.velocity); }, 0.1 * plateau.reach,
      0.35 * plateau.reach);
  if (falls.size() > 1000) falls.resize(1000);
  if (jumps.size() > 1000) jumps.resize(1000);
  if (falls.size() < 3 || jumps.size() < 3) return {};

  const double interval = std::max(typical_interval(friction_time), typical_interval(velocity_time));
  const double period = std::min(median_interval(falls), median_interval(jumps));
  const auto candidates = coincidences(falls, jumps, std::max(3 * interval, 0.05 * period), 0.3 * period);
  const Scatter scatter(friction_time, friction, velocity_time, velocity, plateau);
  const std::size_t n = friction.size(), coarse = std::max<std::size_t>(1, n / 40000);
  const double reach = std::max(4 * interval, 0.12 * period);
  double best = 0, least = std::numeric_limits<double>::infinity(), second = least;
  std::size_t support = 0;
  for (const Candidate& candidate : candidates) {
    const double offset = scatter.minimise(candidate.offset, reach, 0, n, coarse, interval / 4);
    const double cost = scatter(offset, 0, n, coarse) / static_cast<double>(candidate.support);
    second = std::min(second, std::max(least, cost));
    if (cost < least) {
      least = cost;
      best = offset;
      support = candidate.support;
    }
  }
  ClockOffset result;
  result.events = support;
  result.ambiguity = candidates.size() > 1 ? least / second : 0;
  const std::size_t fine = std::max<std::size_t>(1, n / 400000);
  result.offset = scatter.minimise(best, 4 * interval, 0, n, fine, interval / 50);
  // The same from contiguous parts: their spread is what wanders from cycle to cycle.
  constexpr std::size_t parts = 6;
  double squares = 0;
  for (std::size_t i = 0; i < parts; ++i) {
    const double part =
        scatter.minimise(result.offset, 8 * interval, i * n / parts, (i + 1) * n / parts, fine, interval / 20);
    squares += (part - result.offset) * (part - result.offset);
  }
  result.uncertainty = std::sqrt(squares / (parts * (parts - 1.0)));
  return result;
}

}  // namespace tribofit
