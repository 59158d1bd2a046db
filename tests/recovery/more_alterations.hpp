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

/// The laser loses its speckle for some samples: the velocity reads about nothing.
inline Alter speckled(double part) {
  return [=](Trace& trace, Random& random) {
    std::normal_distribution<double> normal(0, 2e-5);
    const auto spans = static_cast<int>(part * static_cast<double>(trace.size()) / 10);
    for (int k = 0; k < spans; ++k) {
      const std::size_t begin = any_sample(trace, random);
      const auto length = std::uniform_int_distribution<std::size_t>(2, 20)(random);
      for (std::size_t i = begin; i < std::min(trace.size(), begin + length); ++i) trace.velocity[i] = normal(random);
    }
  };
}

/// A clock that is written with so few digits, over the sampling step.
inline Alter coarse_clock(double steps) {
  return [=](Trace& trace, Random&) {
    const double step = steps * trace.interval();
    for (double& t : trace.time) t = step * std::floor(t / step + 1e-9);
  };
}

/// A clock that jitters, over the sampling step.
inline Alter jittering_clock(double part) {
  return [=](Trace& trace, Random& random) {
    std::uniform_real_distribution<double> off(-0.5 * part * trace.interval(), 0.5 * part * trace.interval());
    for (double& t : trace.time) t += off(random);
  };
}

/// A level that drifts evenly, by so much in all.
inline Alter drifting(Channel channel, double by) {
  return [=](Trace& trace, Random&) {
    const auto n = static_cast<double>(trace.size());
    for (std::size_t i = 0; i < trace.size(); ++i) (trace.*channel)[i] += by * static_cast<double>(i) / n;
  };
}

/// A level that steps half way.
inline Alter stepping(Channel channel, double by) {
  return [=](Trace& trace, Random&) {
    for (std::size_t i = trace.size() / 2; i < trace.size(); ++i) (trace.*channel)[i] += by;
  };
}

inline Alter humming(Channel channel, double amplitude, double frequency) {
  return [=](Trace& trace, Random&) {
    for (std::size_t i = 0; i < trace.size(); ++i)
      (trace.*channel)[i] += amplitude * std::sin(2 * std::numbers::pi * frequency * trace.time[i] + 1);
  };
}

/// The record at another rate: straight lines between its samples, or every so many samples without a filter.
inline Alter resampled(double step_over_step) {
  return [=](Trace& trace, Random&) {
    const auto n = static_cast<std::size_t>(static_cast<double>(trace.size() - 2) / step_over_step);
    for (const Channel channel : {&Trace::time, kFriction, kVelocity}) {
      const std::vector<double> x = trace.*channel;
      for (std::size_t i = 0; i < n; ++i) {
        const double at = static_cast<double>(i) * step_over_step;
        const auto k = static_cast<std::size_t>(at);
        (trace.*channel)[i] = x[k] + (at - static_cast<double>(k)) * (x[k + 1] - x[k]);
      }
      (trace.*channel).resize(n);
    }
    trace.steps = {{0, n, "", {}}};
  };
}

/// A channel of a slower instrument, drawn out with straight lines.
inline Alter drawn_out(Channel channel, std::size_t count) {
  return [=](Trace& trace, Random&) {
    std::vector<double>& x = trace.*channel;
    for (std::size_t i = 0; i + count < x.size(); i += count) {
      for (std::size_t k = 1; k < count; ++k)
        x[i + k] = x[i] + (x[i + count] - x[i]) * static_cast<double>(k) / static_cast<double>(count);
    }
  };
}

/// A running median, as software takes spikes out.
inline Alter running_median(std::vector<Channel> channels, std::size_t half) {
  return [=](Trace& trace, Random&) {
    for (const Channel channel : channels) {
      const std::vector<double> x = trace.*channel;
      for (std::size_t i = half; i + half < x.size(); ++i) {
        std::vector<double> some(x.begin() + static_cast<std::ptrdiff_t>(i - half),
                                 x.begin() + static_cast<std::ptrdiff_t>(i + half + 1));
        std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end());
        (trace.*channel)[i] = some[half];
      }
    }
  };
}

/// Alterations one after the other.
inline Alter all_of(std::vector<Alter> steps) {
  return [=](Trace& trace, Random& random) {
    for (const Alter& step : steps) step(trace, random);
  };
}

}  // namespace tribofit::altered
