// What acquisition does to a record.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit::altered {

using Random = std::mt19937_64;

/// What was done to a record, and the check that must name it.
struct Alteration {
  const char* name;
  std::function<void(Trace&, Random&)> apply;
  const char* check;
  const char* sentence;
};

inline std::size_t any_sample(const Trace& trace, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, trace.size() - 1)(random);
}

/// Cells of a channel that hold this value instead.
inline std::function<void(Trace&, Random&)> cells(std::vector<double> Trace::*channel, double value, int count = 5) {
  return [=](Trace& trace, Random& random) {
    for (int k = 0; k < count; ++k) (trace.*channel)[any_sample(trace, random)] = value;
  };
}

inline std::function<void(Trace&, Random&)> spikes(std::vector<double> Trace::*channel, double size) {
  return [=](Trace& trace, Random& random) {
    std::uniform_real_distribution<double> height(0.5, 1.5);
    for (int k = 0; k < 60; ++k) {
      (trace.*channel)[any_sample(trace, random)] += (k % 2 == 0 ? size : -size) * height(random);
    }
  };
}

/// The channel holds one value over a tenth of the record.
inline std::function<void(Trace&, Random&)> frozen(std::vector<std::vector<double> Trace::*> channels) {
  return [=](Trace& trace, Random&) {
    const std::size_t begin = trace.size() * 2 / 5, end = begin + trace.size() / 10;
    for (const auto channel : channels) {
      for (std::size_t i = begin; i < end; ++i) (trace.*channel)[i] = (trace.*channel)[begin];
    }
  };
}

/// A plug that loses contact now and then, for up to 20 ms.
inline std::function<void(Trace&, Random&)> loose(std::vector<std::vector<double> Trace::*> channels) {
  return [=](Trace& trace, Random& random) {
    for (int k = 0; k < 8; ++k) {
      const std::size_t begin = any_sample(trace, random);
      const std::size_t length = std::uniform_int_distribution<std::size_t>(5, 400)(random);
      for (const auto channel : channels) {
        for (std::size_t i = begin; i < std::min(trace.size(), begin + length); ++i) (trace.*channel)[i] = 0;
      }
    }
  };
}

inline std::function<void(Trace&, Random&)> stopped(double from, double to) {
  return [=](Trace& trace, Random& random) {
    const auto n = static_cast<double>(trace.size());
    const auto begin = static_cast<std::size_t>(from * n), end = static_cast<std::size_t>(to * n);
    const double level = trace.friction[begin];
    std::normal_distribution<double> normal;
    for (std::size_t i = begin; i < end; ++i) {
      trace.friction[i] = level + 0.003 * normal(random);
      trace.velocity[i] = 2e-5 * normal(random);
    }
  };
}

inline std::function<void(Trace&, Random&)> clipped_friction(double limit, double dither) {
  return [=](Trace& trace, Random& random) {
    std::normal_distribution<double> normal(0, 1);
    for (double& mu : trace.friction) mu = mu > limit ? limit + dither * normal(random) : mu;
  };
}

/// The block slips backwards up to `part` of its fastest.
inline std::function<void(Trace&, Random&)> clipped_velocity(double part, double dither) {
  return [=](Trace& trace, Random& random) {
    const double limit = part * *std::min_element(trace.velocity.begin(), trace.velocity.end());
    std::normal_distribution<double> normal(0, 1);
    for (double& v : trace.velocity) v = v < limit ? limit + dither * normal(random) : v;
  };
}

inline std::function<void(Trace&, Random&)> rounded(std::vector<double> Trace::*channel, double step) {
  return [=](Trace& trace, Random&) {
    for (double& x : trace.*channel) x = step * std::round(x / step);
  };
}

using Channel = std::vector<double> Trace::*;
inline const Channel kFriction = &Trace::friction;
inline const Channel kVelocity = &Trace::velocity;

inline std::function<void(Trace&, Random&)> shifted(double zero) {
  return [=](Trace& trace, Random&) {
    for (double& v : trace.velocity) v += zero;
  };
}

/// The gain falls by `part` at the fastest.
inline std::function<void(Trace&, Random&)> compressed(double part) {
  return [=](Trace& trace, Random&) {
    double most = 0;
    for (const double v : trace.velocity) most = std::max(most, std::abs(v));
    for (double& v : trace.velocity) v *= 1 - part * (v / most) * (v / most);
  };
}

inline std::function<void(Trace&, Random&)> low_passed(std::vector<Channel> channels, double corner) {
  return [=](Trace& trace, Random&) {
    const double keep = std::exp(-2 * std::numbers::pi * corner * trace.interval());
    for (const Channel channel : channels) {
      double state = (trace.*channel).front();
      for (double& x : trace.*channel) x = state = keep * state + (1 - keep) * x;
    }
  };
}

/// A Butterworth filter of second order.
inline std::function<void(Trace&, Random&)> low_passed_twice(std::vector<Channel> channels, double corner) {
  return [=](Trace& trace, Random&) {
    const double w = std::tan(std::numbers::pi * corner * trace.interval()), k = std::numbers::sqrt2 * w;
    const double norm = 1 / (1 + k + w * w), b = w * w * norm, a1 = 2 * (w * w - 1) * norm, a2 = (1 - k + w * w) * norm;
    for (const Channel channel : channels) {
      std::vector<double>& x = trace.*channel;
      double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
      for (double& value : x) {
        const double y = b * (value + 2 * x1 + x2) - a1 * y1 - a2 * y2;
        x2 = x1, x1 = value, y2 = y1, y1 = y;
        value = y;
      }
    }
  };
}

/// A centred mean.
inline std::function<void(Trace&, Random&)> averaged(std::vector<Channel> channels, double width) {
  return [=](Trace& trace, Random&) {
    const auto half = static_cast<std::size_t>(0.5 * width / trace.interval());
    for (const Channel channel : channels) {
      const std::vector<double> x = trace.*channel;
      for (std::size_t i = half; i + half < x.size(); ++i) {
        double sum = 0;
        for (std::size_t k = i - half; k <= i + half; ++k) sum += x[k];
        (trace.*channel)[i] = sum / static_cast<double>(2 * half + 1);
      }
    }
  };
}

/// Stretches of so many samples are missing, and the clock runs on as if they were not.
inline std::function<void(Trace&, Random&)> lost(double part, std::size_t length) {
  return [=](Trace& trace, Random& random) {
    const std::size_t n = trace.size();
    std::vector<bool> keeps(n, true);
    const auto stretches = static_cast<std::size_t>(part * static_cast<double>(n) / static_cast<double>(length));
    for (std::size_t k = 0; k < stretches; ++k) {
      const std::size_t begin = any_sample(trace, random);
      for (std::size_t i = begin; i < std::min(n, begin + length); ++i) keeps[i] = false;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!keeps[i]) continue;
      trace.friction[kept] = trace.friction[i];
      trace.velocity[kept++] = trace.velocity[i];
    }
    for (auto* channel : {&trace.time, &trace.friction, &trace.velocity}) channel->resize(kept);
    trace.steps = {{0, kept, "", {}}};
  };
}

/// The velocity has a clock of its own.
inline std::function<void(Trace&, Random&)> clocks_apart(double ppm) {
  return [=](Trace& trace, Random&) {
    const std::vector<double> v = trace.velocity;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double at = std::min(static_cast<double>(v.size() - 2), static_cast<double>(i) * (1 + 1e-6 * ppm));
      const auto k = static_cast<std::size_t>(at);
      trace.velocity[i] = v[k] + (at - static_cast<double>(k)) * (v[k + 1] - v[k]);
    }
  };
}

/// From now on the disc turns at another speed, which nobody says.
inline std::function<void(Trace&, Random&)> then_at(double rpm) {
  return [=](Trace& trace, Random&) {
    truth::Rig rig;
    rig.rpm = rpm;
    rig.duration = 6;
    rig.scatter = 0.004;
    rig.seed = 5;
    const Trace more = truth::simulate(rig).trace;
    const double step = trace.interval(), from = trace.time.back() + step;
    for (std::size_t i = 0; i < more.size(); ++i) {
      trace.time.push_back(from + more.time[i]);
      trace.friction.push_back(more.friction[i]);
      trace.velocity.push_back(more.velocity[i]);
    }
    trace.steps = {{0, trace.size(), "", {}}};
  };
}

inline const std::vector<Alteration>& alterations() {
  static const std::vector<Alteration> list = {
      {"friction: five cells of -9999", cells(kFriction, -9999), "drop-outs", "marker value"},
      {"velocity: five cells of 1e38", cells(kVelocity, 1e38), "drop-outs", "marker value"},
      {"friction: five cells of 9.9E37", cells(kFriction, 9.9e37), "drop-outs", "marker value"},
      {"friction: a hundred cells of 9999", cells(kFriction, 9999, 100), "drop-outs", "marker value"},
      {"friction: lone spikes", spikes(kFriction, 0.3), "drop-outs", "lone sample"},
      {"velocity: lone spikes", spikes(kVelocity, 0.04), "drop-outs", "lone sample"},
      {"friction: frozen for a tenth", frozen({kFriction}), "drop-outs", "friction repeats one value"},
      {"velocity: frozen for a tenth", frozen({kVelocity}), "drop-outs", "velocity repeats one value"},
      {"both: frozen for a tenth", frozen({kFriction, kVelocity}), "drop-outs", "repeats one value"},
      {"friction: a loose plug", loose({kFriction}), "drop-outs", "friction repeats one value"},
      {"both: a loose plug", loose({kFriction, kVelocity}), "drop-outs", "repeats one value"},
      {"machine stopped at the end", stopped(0.85, 1), "drop-outs", "stands still"},
      {"machine stopped at the start", stopped(0, 0.15), "drop-outs", "stands still"},
      {"friction: clipped at 0.5, dither 2e-4", clipped_friction(0.5, 2e-4), "clipping", "mu_s"},
      {"friction: clipped at 0.5, dither 1e-3", clipped_friction(0.5, 1e-3), "clipping", "mu_s"},
      {"friction: clipped at 0.4", clipped_friction(0.4, 2e-4), "clipping", "mu_s"},
      {"velocity: clipped at 0.7, dither", clipped_velocity(0.7, 5e-6), "clipping", "alpha"},
      {"velocity: clipped at 0.95, dither", clipped_velocity(0.95, 2e-5), "clipping", "alpha"},
      {"velocity: clipped at 0.5", clipped_velocity(0.5, 0), "clipping", "alpha"},
      {"velocity: eight bits", rounded(kVelocity, 0.8e-3), "resolution", "steps of 0.8 mm/s"},
      {"friction: seven bits", rounded(kFriction, 0.004), "resolution", "steps of 0.004"},
      {"friction: clipped at 0.4, dither 2e-3", clipped_friction(0.4, 2e-3), "clipping", "mu_s"},
      {"friction: five bits, no sample alone", rounded(kFriction, 0.008), "resolution", "steps of 0.008"},
      {"machine stopped half way", stopped(0.4, 0.55), "drop-outs", "stands still"},
      {"velocity: zero off by 0.2 mm/s", shifted(2e-4), "plateau-speed", "the velocity has a zero error; corrected"},
      {"velocity: zero off by -0.2 mm/s", shifted(-2e-4), "plateau-speed", "the velocity has a zero error; corrected"},
      {"velocity: zero off by 1 mm/s", shifted(1e-3), "plateau-speed", "the velocity has a zero error; corrected"},
      {"one in a hundred samples lost", lost(0.01, 1), "drop-outs", "samples were lost"},
      {"one in twenty samples lost", lost(0.05, 1), "drop-outs", "samples were lost"},
      {"one in five samples lost", lost(0.2, 1), "drop-outs", "samples were lost"},
      {"disc from 4 to 8 rpm", then_at(8), "plateau-speed", "the speed of the disc steps"},
      {"disc from 4 to 5 rpm", then_at(5), "plateau-speed", "the speed of the disc steps"},
      {"both: low-pass of 100 Hz", low_passed({kFriction, kVelocity}, 100), "bandwidth", "first-order low-pass"},
      {"both: low-pass of 200 Hz", low_passed({kFriction, kVelocity}, 200), "bandwidth", "first-order low-pass"},
      {"both: low-pass of 500 Hz", low_passed({kFriction, kVelocity}, 500), "bandwidth", "first-order low-pass"},
      {"both: low-pass of 1 kHz", low_passed({kFriction, kVelocity}, 1000), "bandwidth", "first-order low-pass"},
      {"both: low-pass of 2 kHz", low_passed({kFriction, kVelocity}, 2000), "bandwidth", "first-order low-pass"},
      {"velocity: low-pass of 500 Hz", low_passed({kVelocity}, 500), "bandwidth", "first-order low-pass"},
      {"velocity: low-pass of 1 kHz", low_passed({kVelocity}, 1000), "bandwidth", "first-order low-pass"},
      {"velocity: gain falls by 10 %", compressed(0.1), "plateau-speed", "the velocity channel is nonlinear"},
      {"velocity: gain falls by 5 %", compressed(0.05), "plateau-speed", "the velocity channel is nonlinear"},
      {"velocity: gain rises by 10 %", compressed(-0.1), "plateau-speed", "the velocity channel is nonlinear"},
      {"clocks 50 ppm apart", clocks_apart(50), "channel-delay", "their clocks drift apart"},
      {"clocks 100 ppm apart", clocks_apart(100), "channel-delay", "their clocks drift apart"},
      {"clocks -200 ppm apart", clocks_apart(-200), "channel-delay", "their clocks drift apart"},
      {"velocity: low-pass of 200 Hz", low_passed({kVelocity}, 200), "bandwidth", "first-order low-pass"},
      {"friction: low-pass of 200 Hz", low_passed({kFriction}, 200), "bandwidth", "first-order low-pass"},
      {"friction: low-pass of 1 kHz", low_passed({kFriction}, 1000), "bandwidth", "first-order low-pass"},
  };
  return list;
}

/// Where no honest number is left: the check reports a problem.
inline const std::vector<Alteration>& beyond_rescue() {
  static const std::vector<Alteration> list = {
      {"both: means of 0.25 ms", averaged({kFriction, kVelocity}, 0.25e-3), "bandwidth", "low-pass"},
      {"both: means of 0.5 ms", averaged({kFriction, kVelocity}, 0.5e-3), "bandwidth", "low-pass"},
      {"both: means of 1 ms", averaged({kFriction, kVelocity}, 1e-3), "bandwidth", "low-pass"},
      {"velocity: means of 2 ms", averaged({kVelocity}, 2e-3), "bandwidth", "low-pass"},
      {"both: second order of 500 Hz", low_passed_twice({kFriction, kVelocity}, 500), "bandwidth",
       "second-order low-pass"},
      {"velocity: second order of 1 kHz", low_passed_twice({kVelocity}, 1000), "bandwidth",
       "second-order low-pass at 1"},
      {"velocity: six bits", rounded(kVelocity, 3.2e-3), "resolution", "the law's decay (alpha) is unreliable"},
      {"friction: twenty levels", rounded(kFriction, 0.02), "resolution",
       "mu_k and the law's decay (alpha) are unreliable"},
      {"one in five samples lost, 20 ms each", lost(0.2, 400), "drop-outs", "samples were lost"},
  };
  return list;
}

}  // namespace tribofit::altered
