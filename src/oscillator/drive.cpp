#include "tribofit/oscillator/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

/// Straight lines through points, with the integral up to each of them.
struct Polyline {
  std::vector<double> times, speeds, angles;

  double slope(std::size_t i) const { return (speeds[i + 1] - speeds[i]) / (times[i + 1] - times[i]); }

  /// Number of points at or before t: 0 before the first, size() after the last.
  std::size_t passed(double t) const {
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  }
  double speed(double t) const {
    const std::size_t n = passed(t);
    if (n == 0) return speeds.front();
    if (n == times.size()) return speeds.back();
    return speeds[n - 1] + slope(n - 1) * (t - times[n - 1]);
  }
  double acceleration(double t) const {
    const std::size_t n = passed(t);
    return n == 0 || n == times.size() ? 0 : slope(n - 1);
  }
  /// Integral of the speed from the first point.
  double angle(double t) const {
    const std::size_t n = passed(t);
    if (n == 0) return speeds.front() * (t - times.front());
    return angles[n - 1] + 0.5 * (speeds[n - 1] + speed(t)) * (t - times[n - 1]);
  }
};

}  // namespace

SpeedProfile constant_speed(double omega) {
  return {[omega](double) { return omega; }, [](double) { return 0.0; }, [omega](double t) { return omega * t; }, true};
}

SpeedProfile reversing_speed(double amplitude, double frequency) {
  const double w = 2 * std::numbers::pi * frequency;
  if (!(w > 0)) throw InputError("the frequency of a reversing drive is not positive", "give it in Hz");
  return {[=](double t) { return amplitude * std::sin(w * t); },
          [=](double t) { return amplitude * w * std::cos(w * t); },
          [=](double t) { return amplitude / w * (1 - std::cos(w * t)); }};
}

SpeedProfile piecewise_linear_speed(std::vector<double> times, std::vector<double> speeds) {
  if (times.empty() || times.size() != speeds.size()) {
    throw InputError("a speed profile needs as many speeds as times, at least one", "give one speed for every time");
  }
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end()) {
    throw InputError("the times of a speed profile do not increase", "sort them and remove repeated ones");
  }
  auto line = std::make_shared<Polyline>(Polyline{std::move(times), std::move(speeds), {0}});
  for (std::size_t i = 1; i < line->times.size(); ++i) {
    line->angles.push_back(line->angles[i - 1] +
                           0.5 * (line->speeds[i - 1] + line->speeds[i]) * (line->times[i] - line->times[i - 1]));
  }
  const double at_zero = line->angle(0);
  return {[line](double t) { return line->speed(t); }, [line](double t) { return line->acceleration(t); },
          [line, at_zero](double t) { return line->angle(t) - at_zero; }};
}

SpeedProfile run_up_speed(double omega, double duration) {
  return piecewise_linear_speed({0, duration}, {0, omega});
}

}  // namespace tribofit
