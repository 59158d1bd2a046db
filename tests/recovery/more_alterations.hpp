// More of what acquisition does to a record: for the long list of altered_cases.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "alterations.hpp"

namespace tribofit::altered {

using Alter = std::function<void(Trace&, Random&)>;

/// A mean over the samples before.
inline Alter trailing_mean(std::vector<Channel> channels, double width) {
  return [=](Trace& trace, Random&) {
    const auto n = static_cast<std::size_t>(width / trace.interval() + 0.5);
    for (const Channel channel : channels) {
      const std::vector<double> x = trace.*channel;
      double sum = static_cast<double>(n) * x[0];
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum += x[i] - x[i >= n ? i - n : 0];
        (trace.*channel)[i] = sum / static_cast<double>(n);
      }
    }
  };
}

/// Every `count` samples become their mean; the record has as many times fewer.
inline Alter block_means(std::size_t count) {
  return [=](Trace& trace, Random&) {
    const std::size_t n = trace.size() / count;
    for (const Channel channel : {&Trace::time, kFriction, kVelocity}) {
      std::vector<double>& x = trace.*channel;
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < count; ++k) sum += x[i * count + k];
        x[i] = sum / static_cast<double>(count);
      }
      x.resize(n);
    }
    for (std::size_t i = n; i-- > 0;) trace.time[i] -= trace.time[0];
    trace.steps = {{0, n, "", {}}};
  };
}

/// A converter that reads one in `count` samples and repeats it.
inline Alter held(std::vector<Channel> channels, std::size_t count) {
  return [=](Trace& trace, Random&) {
    for (const Channel channel : channels) {
      std::vector<double>& x = trace.*channel;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i - i % count];
    }
  };
}

/// The reading follows by `part` of its steepest change in a sample at most.
inline Alter slew_limited(std::vector<Channel> channels, double part) {
  return [=](Trace& trace, Random&) {
    for (const Channel channel : channels) {
      std::vector<double>& x = trace.*channel;
      double steepest = 0;
      for (std::size_t i = 8; i < x.size(); ++i) steepest = std::max(steepest, std::abs(x[i] - x[i - 8]) / 8);
      for (std::size_t i = 1; i < x.size(); ++i)
        x[i] = x[i - 1] + std::clamp(x[i] - x[i - 1], -part * steepest, part * steepest);
    }
  };
}

/// The gain falls with the speed, not with its square.
inline Alter compressed_linearly(double part) {
  return [=](Trace& trace, Random&) {
    double most = 0;
    for (const double v : trace.velocity) most = std::max(most, std::abs(v));
    for (double& v : trace.velocity) v *= 1 - part * std::abs(v) / most;
  };
}

/// An amplifier that saturates softly: v -> L tanh(v/L), L so many times the fastest.
inline Alter saturated(double limit) {
  return [=](Trace& trace, Random&) {
    double most = 0;
    for (const double v : trace.velocity) most = std::max(most, std::abs(v));
    for (double& v : trace.velocity) v = limit * most * std::tanh(v / (limit * most));
  };
}

inline Alter gain(Channel channel, double factor) {
  return [=](Trace& trace, Random&) {
    for (double& x : trace.*channel) x *= factor;
  };
}

/// Friction is recorded so much later [s].
inline Alter delayed(double by) {
  return [=](Trace& trace, Random&) {
    const double samples = by / trace.interval();
    const std::vector<double> x = trace.friction;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double at = std::clamp(static_cast<double>(i) - samples, 0.0, static_cast<double>(x.size() - 2));
      const auto k = static_cast<std::size_t>(at);
      trace.friction[i] = x[k] + (at - static_cast<double>(k)) * (x[k + 1] - x[k]);
    }
  };
}

inline Alter frozen_for(std::vector<Channel> channels, double part) {
  return [=](Trace& trace, Random& random) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(trace.size()));
    const std::size_t begin = any_sample(trace, random) * 3 / 4;
    for (const Channel channel : channels) {
      for (std::size_t i = begin; i < std::min(trace.size(), begin + length); ++i)
        (trace.*channel)[i] = (trace.*channel)[begin];
    }
  };
}

/// The record holds v_r, with this gain and zero.
inline Alter relative(double factor, double zero) {
  return [=](Trace& trace, Random&) {
    const double disc = trace.conditions.speed.value * trace.conditions.radius.value;
    trace.velocity_kind = VelocityKind::relative;
    for (double& v : trace.velocity) v = factor * (disc - v) + zero;
  };
}

/// Alterations one after the other.
inline Alter all_of(std::vector<Alter> steps) {
  return [=](Trace& trace, Random& random) {
    for (const Alter& step : steps) step(trace, random);
  };
}

}  // namespace tribofit::altered
