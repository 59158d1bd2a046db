#include "tribofit/oscillator/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "simulation_checks.hpp"

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

void check_steps(const std::vector<double>& times, const std::vector<double>& speeds) {
  require(!times.empty() && times.size() == speeds.size(),
          "a speed profile needs as many speeds as times, at least one", "give one speed for every time");
  require(std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end(),
          "the times of a speed profile do not increase", "sort them and remove repeated ones");
}

}  // namespace

SpeedProfile constant_speed(double omega) {
  return {[omega](double) { return omega; }, [](double) { return 0.0; }, [omega](double t) { return omega * t; }, true};
}

SpeedProfile reversing_speed(double amplitude, double frequency) {
  const double w = 2 * std::numbers::pi * frequency;
  require(w > 0, "the frequency of a reversing drive is not positive", "give it in Hz");
  return {[=](double t) { return amplitude * std::sin(w * t); },
          [=](double t) { return amplitude * w * std::cos(w * t); },
          [=](double t) { return amplitude / w * (1 - std::cos(w * t)); }};
}

SpeedProfile piecewise_linear_speed(std::vector<double> times, std::vector<double> speeds) {
  check_steps(times, speeds);
  auto line = std::make_shared<Polyline>(Polyline{std::move(times), std::move(speeds), {0}});
  for (std::size_t i = 1; i < line->times.size(); ++i) {
    line->angles.push_back(line->angles[i - 1] +
                           0.5 * (line->speeds[i - 1] + line->speeds[i]) * (line->times[i] - line->times[i - 1]));
  }
  const double at_zero = line->angle(0);
  return {[line](double t) { return line->speed(t); }, [line](double t) { return line->acceleration(t); },
          [line, at_zero](double t) { return line->angle(t) - at_zero; }};
}

SpeedProfile rippled_speed(SpeedProfile base, double amplitude, double order, double phase) {
  require(amplitude >= 0 && amplitude < 1, "the amplitude of the speed ripple is not within 0 and 1 (excluded)",
          "give it as e.g. 0.05");
  require(order > 0, "the order of the speed ripple is not positive", "give waves a revolution, e.g. 1");
  if (amplitude == 0) return base;
  // u = n theta + phase obeys du/d(base angle) = n (1 + A cos u): the true and the eccentric anomaly of an orbit of
  // eccentricity A, of which the latter grows in proportion to the base angle.
  const double root = std::sqrt(1 - amplitude * amplitude), b = amplitude / (1 + root);
  const double begin = phase - 2 * std::atan2(b * std::sin(phase), 1 + b * std::cos(phase));
  const auto wave = [=, angle = base.angle](double t) {
    const double e = begin + order * root * angle(t);
    return e + 2 * std::atan2(b * std::sin(e), 1 - b * std::cos(e));
  };
  const auto speed = [=, base_speed = base.speed](double t) {
    return base_speed(t) * (1 + amplitude * std::cos(wave(t)));
  };
  const auto acceleration = [=](double t) {
    const double u = wave(t);
    return base.acceleration(t) * (1 + amplitude * std::cos(u)) -
           base.speed(t) * amplitude * order * std::sin(u) * speed(t);
  };
  return {speed, acceleration, [=](double t) { return (wave(t) - phase) / order; }};
}

SpeedProfile stepped_speed(std::vector<double> times, std::vector<double> speeds, const std::vector<Pause>& pauses) {
  check_steps(times, speeds);
  const auto wanted = [&](double t) {
    for (const Pause& pause : pauses) {
      if (t >= pause.begin && t < pause.begin + pause.duration) return 0.0;
    }
    const auto after = std::upper_bound(times.begin() + 1, times.end(), t);
    return speeds[static_cast<std::size_t>(after - times.begin()) - 1];
  };
  std::vector<double> at(times.begin() + 1, times.end());
  for (const Pause& pause : pauses) {
    require(pause.duration > 0, "a pause of the disc is not positive", "give it as e.g. 10s,5s");
    at.insert(at.end(), {pause.begin, pause.begin + pause.duration});
  }
  std::sort(at.begin(), at.end());
  std::vector<double> line_times = {at.empty() ? times[0] : std::min(times[0], at[0]) - 1};
  std::vector<double> line_speeds = {wanted(line_times[0])};
  for (const double t : at) {
    if (wanted(t) == line_speeds.back()) continue;
    require(t >= line_times.back(),
            "the speed of the disc changes twice within " + std::to_string(kSpeedChangeTime) + " s",
            "leave more time between steps and pauses");
    if (t > line_times.back()) {
      line_times.push_back(t);
      line_speeds.push_back(line_speeds.back());
    }
    line_times.push_back(t + kSpeedChangeTime);
    line_speeds.push_back(wanted(t));
  }
  return piecewise_linear_speed(std::move(line_times), std::move(line_speeds));
}

SpeedProfile run_up_speed(double omega, double duration) {
  return piecewise_linear_speed({0, duration}, {0, omega});
}

}  // namespace tribofit
