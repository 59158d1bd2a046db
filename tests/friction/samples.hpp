#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tribofit/friction/evaluate.hpp"
#include "tribofit/friction/slip.hpp"

namespace samples {

/// A slip of prescribed speed with every channel present: peak * sin^2 over `duration`.
struct ExampleSlip {
  std::vector<double> time, velocity, acceleration, angle, distance, reversal_distance, load, temperature;
  std::vector<double> earlier_strokes = {0.02, 0.012, 0.004};
  tribofit::Slip slip;

  explicit ExampleSlip(std::size_t n = 400, double peak = 0.08, double duration = 0.1, double direction = 1) {
    double slid = 1.5;
    for (std::size_t i = 0; i < n; ++i) {
      const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      time.push_back(3 + s * duration);
      velocity.push_back(direction * peak * std::pow(std::sin(std::numbers::pi * s), 2));
      acceleration.push_back(-direction * peak * std::numbers::pi / duration * std::sin(2 * std::numbers::pi * s));
      angle.push_back(0.42 * time.back());
      slid += std::abs(velocity.back()) * duration / static_cast<double>(n);
      distance.push_back(slid);
      reversal_distance.push_back(slid - 1.499);
      load.push_back(50 + 5 * std::sin(40 * time.back()));
      temperature.push_back(25 + s);
    }
    slip.time = time;
    slip.velocity = velocity;
    slip.acceleration = acceleration;
    slip.angle = angle;
    slip.distance = distance;
    slip.reversal_distance = reversal_distance;
    slip.earlier_strokes = earlier_strokes;
    slip.load = load;
    slip.temperature = temperature;
    slip.from_stick = true;
    slip.break_away_time = 3;
    slip.stick_time = 0.1;
    slip.stick_slope = 2 * direction;
    slip.direction = direction;
    slip.disc_speed = 0.42;
    slip.mean_load = 50;
    slip.mean_temperature = 25;
  }
  ExampleSlip(const ExampleSlip&) = delete;
  ExampleSlip& operator=(const ExampleSlip&) = delete;
};

/// A slip at constant speed.
struct Steady {
  std::vector<double> time, velocity;
  tribofit::Slip slip;
  Steady(double speed, double step, std::size_t n) : velocity(n, speed) {
    for (std::size_t i = 0; i < n; ++i) time.push_back(step * static_cast<double>(i + 1));
    slip.time = time;
    slip.velocity = velocity;
    slip.direction = speed < 0 ? -1 : 1;
  }
  Steady(const Steady&) = delete;
  Steady& operator=(const Steady&) = delete;
};

/// Friction of a model over a slip [1].
inline std::vector<double> run(const tribofit::FrictionModel& model, const std::vector<double>& p,
                               const tribofit::Slip& slip) {
  std::vector<double> mu(slip.size());
  tribofit::evaluate<double>(model, p.data(), slip, slip.velocity, mu);
  return mu;
}

}  // namespace samples
