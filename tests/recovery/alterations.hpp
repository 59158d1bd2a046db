// What acquisition does to a record.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::altered {

using Random = std::mt19937_64;

/// A distortion that is undone, and its true value.
struct Undone {
  std::function<Estimate(const Motion&)> found;
  double truth;
};

/// What was done to a record, and the check that must name it.
inline Estimate part_of_velocity(const Motion& motion) {
  return {motion.velocity_response.response.part, motion.velocity_response.std_error};
}

inline Estimate part_of_friction(const Motion& motion) {
  return {motion.friction_response.response.part, motion.friction_response.std_error};
}

struct Alteration {
  std::string name;
  std::function<void(Trace&, Random&)> apply;
  std::string check;
  std::vector<Undone> undone = {};
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

/// Velocities against the disc, which turns forward, are read with less gain.
inline std::function<void(Trace&, Random&)> less_against_disc(double part) {
  return [=](Trace& trace, Random&) {
    for (double& v : trace.velocity) v *= v < 0 ? 1 - part : 1;
  };
}

/// The gain of friction falls by `part` at the largest.
inline std::function<void(Trace&, Random&)> bent_friction(double part) {
  return [=](Trace& trace, Random&) {
    double most = 0;
    for (const double mu : trace.friction) most = std::max(most, std::abs(mu));
    for (double& mu : trace.friction) mu *= 1 - part * (mu / most) * (mu / most);
  };
}

/// How an instrument's continuous filter is computed from samples: the input holds its next sample (what kinematics/
/// undoes), holds the last one, or runs straight between them, for which each is exact; or by the bilinear transform,
/// exact at the corner.
enum class Discretisation { next_held, last_held, straight, bilinear };

/// A Butterworth filter of first or second order: of each conjugate pair of poles the one above the real axis.
inline std::function<void(Trace&, Random&)> butterworth(std::vector<Channel> channels, int order, double corner,
                                                        Discretisation how) {
  return [=](Trace& trace, Random&) {
    using Complex = std::complex<double>;
    const double w = 2 * std::numbers::pi * corner, step = trace.interval();
    const Complex pole = order == 1 ? Complex(-w) : std::polar(w, 0.75 * std::numbers::pi);
    const Complex gain = order == 1 ? Complex(w) : 2 * w * w / (pole - std::conj(pole));
    Complex keep = std::exp(pole * step), now = 0, before = 0;
    const Complex all = gain * (keep - 1.0) / pole;
    if (how == Discretisation::next_held) now = all;
    if (how == Discretisation::last_held) before = all;
    if (how == Discretisation::straight) {
      now = gain * (keep - 1.0 - pole * step) / (pole * pole * step);
      before = all - now;
    }
    if (how == Discretisation::bilinear) {
      const double c = w / std::tan(0.5 * w * step);
      keep = (c + pole) / (c - pole);
      now = before = gain / (c - pole);
    }
    for (const Channel channel : channels) {
      double last = (trace.*channel).front();
      Complex state = (now + before) / (1.0 - keep) * last;
      for (double& x : trace.*channel) {
        state = keep * state + now * x + before * last;
        last = std::exchange(x, state.real());
      }
    }
  };
}

inline std::function<void(Trace&, Random&)> low_passed(std::vector<Channel> channels, double corner) {
  return butterworth(std::move(channels), 1, corner, Discretisation::next_held);
}
inline std::function<void(Trace&, Random&)> low_passed_twice(std::vector<Channel> channels, double corner) {
  return butterworth(std::move(channels), 2, corner, Discretisation::bilinear);
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

/// First-order low-passes, which are undone.
inline std::vector<Alteration> low_passes() {
  const auto lag = [](Estimate Motion::*found, double corner) {
    return Undone{found, 1 / (2 * std::numbers::pi * corner)};
  };
  std::vector<Alteration> list;
  for (const double f : {100.0, 200.0, 500.0, 1000.0, 2000.0}) {
    const Undone velocity = lag(&Motion::velocity_low_pass, f), friction = lag(&Motion::friction_low_pass, f);
    const std::string name = fmt::format("low-pass of {} Hz", f);
    list.push_back({"both: " + name, low_passed({kFriction, kVelocity}, f), "bandwidth", {velocity, friction}});
    if (f == 200 || f == 1000)
      list.push_back({"friction: " + name, low_passed({kFriction}, f), "bandwidth", {friction}});
    if (f == 200 || f == 500 || f == 1000)
      list.push_back({"velocity: " + name, low_passed({kVelocity}, f), "bandwidth", {velocity}});
  }
  return list;
}

inline std::vector<Alteration> alterations() {
  std::vector<Alteration> list = {
      {"friction: five cells of -9999", cells(kFriction, -9999), "drop-outs"},
      {"velocity: five cells of 1e38", cells(kVelocity, 1e38), "drop-outs"},
      {"friction: five cells of 9.9E37", cells(kFriction, 9.9e37), "drop-outs"},
      {"friction: a hundred cells of 9999", cells(kFriction, 9999, 100), "drop-outs"},
      {"friction: lone spikes", spikes(kFriction, 0.3), "drop-outs"},
      {"velocity: lone spikes", spikes(kVelocity, 0.04), "drop-outs"},
      {"friction: frozen for a tenth", frozen({kFriction}), "drop-outs"},
      {"velocity: frozen for a tenth", frozen({kVelocity}), "drop-outs"},
      {"both: frozen for a tenth", frozen({kFriction, kVelocity}), "drop-outs"},
      {"friction: a loose plug", loose({kFriction}), "drop-outs"},
      {"both: a loose plug", loose({kFriction, kVelocity}), "drop-outs"},
      {"machine stopped at the end", stopped(0.85, 1), "drop-outs"},
      {"machine stopped at the start", stopped(0, 0.15), "drop-outs"},
      {"friction: clipped at 0.5, dither 2e-4", clipped_friction(0.5, 2e-4), "clipping"},
      {"friction: clipped at 0.5, dither 1e-3", clipped_friction(0.5, 1e-3), "clipping"},
      {"friction: clipped at 0.4", clipped_friction(0.4, 2e-4), "clipping"},
      {"velocity: clipped at 0.7, dither", clipped_velocity(0.7, 5e-6), "clipping"},
      {"velocity: clipped at 0.95, dither", clipped_velocity(0.95, 2e-5), "clipping"},
      {"velocity: clipped at 0.5", clipped_velocity(0.5, 0), "clipping"},
      {"velocity: eight bits", rounded(kVelocity, 0.8e-3), "resolution"},
      {"friction: seven bits", rounded(kFriction, 0.004), "resolution"},
      {"friction: clipped at 0.4, dither 2e-3", clipped_friction(0.4, 2e-3), "clipping"},
      {"friction: five bits, no sample alone", rounded(kFriction, 0.008), "resolution"},
      {"machine stopped half way", stopped(0.4, 0.55), "drop-outs"},
      {"velocity: zero off by 0.2 mm/s", shifted(2e-4), "plateau-speed", {{&Motion::velocity_zero, 2e-4}}},
      {"velocity: zero off by -0.2 mm/s", shifted(-2e-4), "plateau-speed", {{&Motion::velocity_zero, -2e-4}}},
      {"velocity: zero off by 1 mm/s", shifted(1e-3), "plateau-speed", {{&Motion::velocity_zero, 1e-3}}},
      {"one in a hundred samples lost", lost(0.01, 1), "drop-outs"},
      {"one in twenty samples lost", lost(0.05, 1), "drop-outs"},
      {"one in five samples lost", lost(0.2, 1), "drop-outs"},
      {"disc from 4 to 8 rpm", then_at(8), "plateau-speed"},
      {"disc from 4 to 5 rpm", then_at(5), "plateau-speed"},
      {"velocity: gain falls by 10 %", compressed(0.1), "plateau-speed", {{part_of_velocity, 0.1}}},
      {"velocity: gain falls by 5 %", compressed(0.05), "plateau-speed", {{part_of_velocity, 0.05}}},
      {"velocity: gain rises by 10 %", compressed(-0.1), "plateau-speed", {{part_of_velocity, -0.1}}},
      {"clocks 50 ppm apart", clocks_apart(50), "channel-delay", {{&Motion::clock_drift, 5e-5}}},
      {"clocks 100 ppm apart", clocks_apart(100), "channel-delay", {{&Motion::clock_drift, 1e-4}}},
      {"clocks -200 ppm apart", clocks_apart(-200), "channel-delay", {{&Motion::clock_drift, -2e-4}}},
  };
  for (Alteration& low_pass : low_passes()) list.push_back(std::move(low_pass));
  list.push_back({"friction: gain falls by 10 %", bent_friction(0.1), "friction-zero", {{part_of_friction, 0.1}}});
  return list;
}

/// Where no honest number is left: the check reports a problem.
inline std::vector<Alteration> beyond_rescue() {
  return {
      {"both: means of 0.25 ms", averaged({kFriction, kVelocity}, 0.25e-3), "bandwidth"},
      {"both: means of 0.5 ms", averaged({kFriction, kVelocity}, 0.5e-3), "bandwidth"},
      {"both: means of 1 ms", averaged({kFriction, kVelocity}, 1e-3), "bandwidth"},
      {"velocity: means of 2 ms", averaged({kVelocity}, 2e-3), "bandwidth"},
      {"both: second order of 500 Hz", low_passed_twice({kFriction, kVelocity}, 500), "bandwidth"},
      {"velocity: second order of 1 kHz", low_passed_twice({kVelocity}, 1000), "bandwidth"},
      {"velocity: six bits", rounded(kVelocity, 3.2e-3), "resolution"},
      {"friction: twenty levels", rounded(kFriction, 0.02), "resolution"},
      {"one in five samples lost, 20 ms each", lost(0.2, 400), "drop-outs"},
  };
}

}  // namespace tribofit::altered
