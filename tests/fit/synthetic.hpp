#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "tribofit/friction/evaluate.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace synthetic {

/// A record with prescribed motion: every cycle is a stick and a slip of known shape, and friction follows the model
/// exactly but for the noise asked for. No oscillator, no segmentation: what a fit returns is compared with the truth
/// itself.
struct Options {
  std::size_t cycles = 40;
  double rate = 10e3;       ///< [Hz]
  double stick_time = 0.1;  ///< [s]
  double slip_time = 0.1;   ///< [s]
  double peak = 0.08;       ///< of v_r [m/s]
  double noise = 0;         ///< on friction
  double colour = 0;        ///< AR(1) coefficient of the noise, per sample
  double scatter = 0;       ///< of the break-away level from cycle to cycle
  double wander = 0;        ///< AR(1) coefficient of the scatter, per cycle
  double direction = 1;
  std::uint64_t seed = 1;
};

struct Record {
  tribofit::Motion motion;
  tribofit::Segmentation segmentation;
};

/// Noise with variance 1 and autocorrelation `colour`.
class ColouredNoise {
 public:
  ColouredNoise(double colour, boost::random::mt19937_64& engine) : colour_(colour), engine_(engine) {
    state_ = draw();
  }
  double operator()() {
    const double now = state_;
    state_ = colour_ * state_ + std::sqrt(1 - colour_ * colour_) * draw();
    return now;
  }

 private:
  double draw() { return normal_(engine_); }
  double colour_, state_;
  boost::random::mt19937_64& engine_;
  boost::random::normal_distribution<double> normal_;
};

/// A cycle whose stick begins at sample `begin`.
inline tribofit::Cycle cycle_from(std::size_t begin, const Options& o) {
  tribofit::Cycle cycle;
  cycle.stick = {begin, begin + static_cast<std::size_t>(o.stick_time * o.rate)};
  cycle.slip = {cycle.stick.end, cycle.stick.end + static_cast<std::size_t>(o.slip_time * o.rate)};
  cycle.stick_complete = cycle.slip_complete = true;
  cycle.direction = o.direction < 0 ? -1 : 1;
  cycle.stick_time = o.stick_time;
  cycle.slip_time = o.slip_time;
  cycle.period = o.stick_time + o.slip_time;
  cycle.stick_slope = 2;
  cycle.break_away_time = (static_cast<double>(cycle.slip.begin) - 0.5) / o.rate;
  return cycle;
}

/// Time and v_r of one slip.
struct SlipMotion {
  std::vector<double> time, velocity;
};

/// The peak differs a little from cycle to cycle, as it does on a rig.
inline SlipMotion slip_motion(std::size_t number, const Options& o, tribofit::Cycle& cycle) {
  const double peak = o.peak * (1 + 0.05 * std::sin(static_cast<double>(number)));
  SlipMotion slip;
  for (std::size_t i = 0; i < cycle.slip.size(); ++i) {
    const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(cycle.slip.size());
    slip.time.push_back((static_cast<double>(cycle.slip.begin + i)) / o.rate);
    slip.velocity.push_back(o.direction * peak * std::pow(std::sin(std::numbers::pi * s), 2));
    cycle.peak_velocity = std::max(cycle.peak_velocity, std::abs(slip.velocity.back()));
  }
  return slip;
}

/// The slip as friction/ takes it.
inline tribofit::Slip slip_of(const tribofit::Cycle& cycle, const SlipMotion& slip, const SlipMotion& earlier,
                              const Options& o) {
  tribofit::Slip view;
  view.time = slip.time;
  view.velocity = slip.velocity;
  view.from_stick = true;
  view.break_away_time = cycle.break_away_time;
  view.stick_time = cycle.stick_time;
  view.stick_slope = cycle.stick_slope;
  view.direction = o.direction;
  view.mean_load = 50;
  view.earlier_time = earlier.time;
  view.earlier_velocity = earlier.velocity;
  return view;
}

inline Record make(const tribofit::FrictionModel& model, const std::vector<double>& p, const Options& o) {
  using namespace tribofit;
  Record record;
  Motion& m = record.motion;
  m.step = 1 / o.rate;
  m.sticks = true;
  m.constant_disc_velocity = 0.00628;
  m.conditions.load = {50, "command line"};
  m.conditions.radius = {0.015, "command line"};
  m.conditions.speed = {0.419, "command line"};
  boost::random::mt19937_64 engine(o.seed);
  ColouredNoise noise(o.colour, engine), scatter(o.wander, engine);
  SlipMotion earlier;
  for (std::size_t c = 0; c < o.cycles; ++c) {
    Cycle cycle = cycle_from(m.size(), o);
    std::vector<double> q = p;
    q[0] += o.scatter * scatter();
    SlipMotion slip = slip_motion(c, o, cycle);
    const Slip view = slip_of(cycle, slip, earlier, o);
    std::vector<double> mu(cycle.slip.size());
    evaluate<double>(model, q.data(), view, view.velocity, mu);
    const double level = break_away_level(model, q.data(), view);
    cycle.break_away_friction = level;
    cycle.stick_maximum = cycle.slip_minimum = o.direction * level;
    for (std::size_t i = cycle.stick.begin; i < cycle.stick.end; ++i) {
      m.time.push_back(static_cast<double>(i) / o.rate);
      m.relative_velocity.push_back(0);
      const double back = cycle.break_away_time - m.time.back();
      m.friction.push_back(o.direction * (level - cycle.stick_slope * back) + o.noise * noise());
      cycle.stick_maximum = std::max(cycle.stick_maximum, m.friction.back() * o.direction);
    }
    for (std::size_t i = 0; i < mu.size(); ++i) {
      m.time.push_back(slip.time[i]);
      m.relative_velocity.push_back(slip.velocity[i]);
      m.friction.push_back(mu[i] + o.noise * noise());
      cycle.slip_minimum = std::min(cycle.slip_minimum, m.friction.back() * o.direction);
    }
    record.segmentation.cycles.push_back(cycle);
    earlier = std::move(slip);
  }
  return record;
}

/// SI parameters of the 15 mm row of Table 4 of [D].
inline std::vector<double> table4_15mm(tribofit::Law law) {
  return {0.509, 0.318, law == tribofit::Law(tribofit::FractionalLaw{}) ? 95.33 : 52.14};
}

}  // namespace synthetic
