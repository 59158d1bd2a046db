#include "joined_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/kinematics/clock_offset.hpp"

namespace tribofit::joined {
namespace {

std::string described(const Pair& pair) {
  return fmt::format("{} rpm, {:.3g} s late, clock {:.3g} s, {:.3g} ppm{}", pair.rig.rpm, pair.late, pair.clock,
                     pair.ppm, pair.strangers ? ", of other runs" : "");
}

using Values = std::vector<double>;

/// A stretch of a channel from a sample on, with the times on its own clock.
std::pair<Values, Values> stretch(const Values& channel, double step, std::size_t begin, const Pair& pair,
                                  std::size_t every) {
  const auto n = static_cast<std::size_t>(pair.length / step);
  std::pair<Values, Values> out;
  for (std::size_t i = begin; i < std::min(channel.size(), begin + n); i += every) {
    out.first.push_back(pair.slower * static_cast<double>(i - begin) * step);
    out.second.push_back(channel[i]);
  }
  return out;
}

double allowed_error(const Pair& pair) {
  const double slowest = static_cast<double>(std::max(pair.friction_every, pair.velocity_every)) / pair.rig.rate;
  return pair.slower * std::max(1e-4, 0.25 * slowest);
}

}  // namespace

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  std::mt19937_64 random(1);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  for (unsigned k = 0; k < 500; ++k) {
    Pair pair;
    pair.rig.duration = 80, pair.rig.rate = 10000, pair.rig.scatter = 0.004;
    pair.rig.seed = 1 + k % 12;
    pair.rig.rpm = 2 + 2 * (k % 5);
    const double late = std::exp(uniform(std::log(0.1), std::log(30.0)));
    pair.late = k % 2 == 0 ? late : -late;
    pair.clock = k % 3 == 0 ? uniform(-50, 50) : 0;
    pair.ppm = k % 4 == 0 ? uniform(-200, 200) : 0;
    pair.strangers = k % 10 == 9;
    if (k % 20 == 8) pair.late = k % 40 == 8 ? 41 : -41;
    pair.name = described(pair);
    all.push_back(pair);
  }
  return all;
}

std::vector<Pair> other_pairs() {
  std::vector<Pair> all;
  std::mt19937_64 random(2);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const auto add = [&](const std::string& what, const auto& change) {
    for (unsigned k = 0; k < 8; ++k) {
      Pair pair;
      pair.rig.duration = 40, pair.rig.rate = 10000, pair.rig.scatter = 0.004, pair.length = 20;
      pair.rig.seed = 31 + k, pair.rig.rpm = 2 + 2 * (k % 4);
      pair.late = (k % 2 == 0 ? 1 : -1) * uniform(0.1, 10), pair.clock = uniform(-50, 50);
      pair.ppm = k % 4 == 3 ? uniform(-200, 200) : 0;
      pair.strangers = k == 5;
      change(pair);
      pair.name = what + ": " + described(pair);
      all.push_back(pair);
    }
  };
  for (const double scatter : {0.002, 0.0005, 0.0002, 0.0}) {
    add(fmt::format("scatter {}", scatter), [&](Pair& p) { p.rig.scatter = scatter; });
  }
  for (const double cycles : {3.0, 5.0, 7.0, 10.0}) {
    add(fmt::format("{} cycles in all", cycles), [&](Pair& p) {
      p.length = cycles * 0.83 / p.rig.rpm, p.rig.duration = p.length + 1, p.late = std::copysign(0.05, p.late);
    });
    add(fmt::format("{} cycles shared", cycles), [&](Pair& p) {
      p.length = 10, p.late = std::copysign(10 - cycles * 0.83 / p.rig.rpm, p.late), p.rig.duration = 20.5;
    });
  }
  add("friction at 1 kHz, velocity at 20 kHz", [](Pair& p) { p.rig.rate = 20000, p.friction_every = 20; });
  add("friction at 20 kHz, velocity at 1 kHz", [](Pair& p) { p.rig.rate = 20000, p.velocity_every = 20; });
  add("noise of friction 0.03", [](Pair& p) { p.rig.friction_noise = 0.03; });
  add("noise of velocity 1 mm/s", [](Pair& p) { p.rig.velocity_noise = 1e-3; });
  add("noise with a memory", [](Pair& p) { p.rig.friction_noise = 0.01, p.rig.noise_correlation = 0.99; });
  add("wandering scatter", [](Pair& p) { p.rig.wander = 0.95; });
  add("slow rig", [](Pair& p) { p.slower = 50; });
  add("1000 times slower", [](Pair& p) { p.slower = 1000; });
  add("100 times faster", [](Pair& p) { p.slower = 0.01; });
  add("reversed", [](Pair& p) { p.reversed = true; });
  add("sliding", [](Pair& p) { p.rig.static_friction = 0.32, p.rig.zeta = 0.3, p.rig.decay = 1, p.rig.scatter = 0; });
  add("speed swings once a revolution", [](Pair& p) { p.rig.ripple = 0.05; });
  add("ten minutes", [](Pair& p) {
    p.rig.rate = 2000, p.rig.duration = 650, p.length = 600, p.ppm = p.rig.seed % 2 == 0 ? 180 : -180;
  });
  return all;
}

Judged judge(const Pair& pair) {
  const truth::Rig& rig = pair.rig;
  const Trace trace = truth::simulate(rig).trace;
  truth::Rig another = rig;
  another.seed += 100;
  const double step = 1 / rig.rate, scale = pair.slower;
  const auto late = static_cast<std::ptrdiff_t>(std::lround(pair.late / step));
  const auto friction_from = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -late)),
             velocity_from = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, late));
  auto [friction_time, friction] = stretch(trace.friction, step, friction_from, pair, pair.friction_every);
  auto [velocity_time, velocity] = stretch(pair.strangers ? truth::simulate(another).trace.velocity : trace.velocity,
                                           step, velocity_from, pair, pair.velocity_every);
  const auto clock = [&](double t) { return t * (1 + 1e-6 * pair.ppm) + pair.clock; };
  for (double& t : velocity_time) t = clock(t);
  for (double& v : velocity) v /= scale;
  if (pair.reversed) {
    for (double& f : friction) f = -f;
  }
  const double starts = static_cast<double>(late) * step * scale, overlap = pair.length * scale - std::abs(starts),
               middle = std::max(0.0, starts) + 0.5 * overlap;  // of what both share, on friction's clock
  const double truth = middle - clock(middle - starts);
  Judged judged;
  judged.belongs = overlap > 0 && !pair.strangers;
  const auto began = std::chrono::steady_clock::now();
  try {
    const ClockOffset found = estimate_clock_offset(friction_time, friction, velocity_time, velocity);
    judged.error = found.offset - truth, judged.std_error = found.uncertainty;
    const bool is_right = judged.belongs && std::abs(judged.error) < allowed_error(pair);
    judged.outcome = found.events == 0 ? Outcome::refused : is_right ? Outcome::right : Outcome::wrong;
    judged.text =
        found.events == 0
            ? "refused: no events"
            : fmt::format("{} {:+.3f} +- {:.3f} ms, drift {:+.1f} +- {:.1f} ppm", is_right ? "right" : "WRONG",
                          1e3 * judged.error, 1e3 * judged.std_error, 1e6 * found.drift, 1e6 * found.drift_uncertainty);
  } catch (const InputError& error) {
    judged.outcome = Outcome::refused;
    judged.text = std::string("refused: ") + error.what();
  }
  judged.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return judged;
}

}  // namespace tribofit::joined
