// Velocity steps and holds with known truth: simulated by an integrator written apart, read through noise and drift,
// and fitted. Prints the tables of data/validation/velocity-steps.md; scripts/velocity-steps runs it.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "fit/contact_apart.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/fit/rate_state.hpp"

using namespace tribofit;

namespace {

constexpr double kMicro = 1e-6;

struct Cell {
  std::string name;
  StateEvolution evolution;
  double stiffness;    ///< over the critical one
  double step;         ///< ratio of the speeds
  double white, slow;  ///< noise [1]
  bool holds = false;
  double late = 0;         ///< by up to which friction answers a step after the load point is recorded to turn [s]
  std::size_t states = 1;  ///< the second as b_2 of 0.4 to 0.8 b, over 10 D_c
  double ramp = 0;         ///< time in which the drive passes from one speed to the next [s]
};

/// 2 um/s and `step` times as fast in turn, each over at least 12 D_c; or four holds of 3 to 100 s. Of two states one
/// step up, over at least 14 times the longer distance, and one down.
std::vector<LoadPointPhase> phases_of(const Cell& cell) {
  std::vector<LoadPointPhase> out = {{0, 2 * kMicro}};
  if (cell.states == 2) return {{0, 2 * kMicro}, {60, 10 * kMicro}, {200, 2 * kMicro}};
  if (cell.holds) {
    out = {{0, 10 * kMicro}};
    for (const double hold : {3.0, 10.0, 30.0, 100.0}) {
      out.push_back({out.back().begin + 20, 0});
      out.push_back({out.back().begin + hold, 10 * kMicro});
    }
    return out;
  }
  for (int i = 0; i < 4; ++i) {
    const bool fast = i % 2 == 0;
    out.push_back({out.back().begin + (out.back().speed > 3 * kMicro ? 40 : 60), (fast ? cell.step : 1) * 2 * kMicro});
  }
  return out;
}

/// The same with ramps, as stairs of a sample each.
std::vector<LoadPointPhase> with_ramps(const std::vector<LoadPointPhase>& phases, double ramp, double interval) {
  std::vector<LoadPointPhase> out = {phases.front()};
  for (std::size_t i = 1; i < phases.size(); ++i) {
    const double from = phases[i - 1].speed, to = phases[i].speed;
    for (double t = 0.5 * interval; t < ramp; t += interval)
      out.push_back({phases[i].begin + t - 0.5 * interval, from + (to - from) * t / ramp});
    out.push_back({phases[i].begin + ramp, to});
  }
  return out;
}

/// What is read of the load point where its displacement was recorded to 0.01 um.
std::vector<LoadPointPhase> recorded(const std::vector<LoadPointPhase>& phases, const std::vector<double>& times,
                                     const std::vector<double>& friction) {
  constexpr double kDigit = 0.01 * kMicro;
  Trace trace;
  trace.kind = RecordKind::velocity_steps;
  trace.time = times;
  trace.friction = friction;
  double at = 0;
  std::size_t phase = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0) at += phases[phase].speed * (times[i] - times[i - 1]);
    while (phase + 1 < phases.size() && phases[phase + 1].begin <= times[i]) {
      at += (phases[phase + 1].speed - phases[phase].speed) * (times[i] - phases[phase + 1].begin);
      ++phase;
    }
    trace.drive_position.push_back(std::round(at / kDigit) * kDigit);
  }
  return compute_motion(std::move(trace)).load_point;
}

RateStateMachine draw_machine(const Cell& cell, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform;
  RateStateMachine m;
  m.evolution = cell.evolution;
  m.parameters.a = 0.006 + 0.008 * uniform(generator);
  m.parameters.b[0] = m.parameters.a + 0.003 + 0.003 * uniform(generator);
  m.parameters.distance[0] = (5 + 5 * uniform(generator)) * kMicro;
  m.parameters.stiffness =
      cell.stiffness * critical_stiffness(m.parameters.a, m.parameters.b[0], m.parameters.distance[0]);
  m.states = cell.states;
  if (cell.states == 2) {
    m.parameters.b[1] = (0.4 + 0.4 * uniform(generator)) * m.parameters.b[0];
    m.parameters.distance[1] = 10 * m.parameters.distance[0];
  }
  return m;
}

Motion draw_motion(const Cell& cell, const RateStateMachine& machine, std::mt19937_64& generator) {
  constexpr double kRate = 20, kForgets = 2;
  Motion motion;
  motion.load_point = phases_of(cell);
  const double end = motion.load_point.back().begin + 60;
  for (std::size_t i = 0; static_cast<double>(i) / kRate < end; ++i)
    motion.time.push_back(static_cast<double>(i) / kRate);
  std::uniform_real_distribution<double> uniform;
  std::vector<LoadPointPhase> turns = motion.load_point;
  for (std::size_t i = 1; i < turns.size(); ++i) turns[i].begin += cell.late * uniform(generator);
  if (cell.ramp > 0) turns = with_ramps(turns, cell.ramp, 1 / kRate);
  motion.friction = apart::Contact(machine).friction(turns, motion.time);
  if (cell.ramp > 0) motion.load_point = recorded(turns, motion.time, motion.friction);
  motion.relative_velocity.assign(motion.time.size(), 0.0);
  std::normal_distribution<double> normal;
  const double decay = std::exp(-1 / kRate / kForgets), drift = 2e-5 * normal(generator);
  double slow = normal(generator);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    slow = decay * slow + std::sqrt(1 - decay * decay) * normal(generator);
    motion.friction[i] += cell.white * normal(generator) + cell.slow * slow + drift * motion.time[i];
  }
  return motion;
}

/// What became of the records of a cell.
struct Tally {
  std::array<double, 4> squares = {};  ///< of relative errors
  std::array<int, 4> covered = {};
  int fitted = 0, right = 0, wrong = 0;  ///< laws named, where p < 0.05
  int states = 0, moved = 0;             ///< the number of states is the true one; steps were moved
};

Tally run(const Cell& cell, int records, unsigned cell_number) {
  const auto count = static_cast<std::size_t>(records);
  std::vector<RateStateMachine> machines(count);
  std::vector<RateStateAnalysis> analyses(count);
  run_tasks(count, 0, [&](std::size_t r) {
    std::mt19937_64 generator(1000003ULL * cell_number + r);
    machines[r] = draw_machine(cell, generator);
    RateStateOptions options;
    options.each_step = false;
    analyses[r] = fit_rate_state(draw_motion(cell, machines[r], generator), options);
  });
  Tally tally;
  for (std::size_t r = 0; r < count; ++r) {
    const RateStateMachine& machine = machines[r];
    const RateStateAnalysis& analysis = analyses[r];
    if (!analysis.fitted()) continue;
    const RateStateFit& fit = analysis.fits[static_cast<std::size_t>(cell.evolution)];
    if (!fit.converged) continue;
    ++tally.fitted;
    tally.states += fit.parameters.size() == 2 + 2 * cell.states ? 1 : 0;
    tally.moved += analysis.steps.front().slack > 0 ? 1 : 0;
    const bool named = analysis.law_p_value < 0.05;
    const bool right = analysis.fits[analysis.best].evolution == cell.evolution;
    tally.right += named && right ? 1 : 0;
    tally.wrong += named && !right ? 1 : 0;
    const auto& p = machine.parameters;
    const std::array<double, 4> truth = {p.a, p.b[0], p.distance[0], p.stiffness};
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const FitParameter& found = k < 3 ? fit.parameters[k] : fit.parameters.back();  // b_2 and D_c2 before k
      tally.covered[k] += truth[k] > found.lower95 && truth[k] < found.upper95 ? 1 : 0;
      tally.squares[k] += std::pow(found.value / truth[k] - 1, 2);
    }
  }
  return tally;
}

void print_row(const Cell& cell, const Tally& t, int records) {
  const auto error = [&](std::size_t k) { return 100 * std::sqrt(t.squares[k] / std::max(1, t.fitted)); };
  const auto cover = [&](std::size_t k) { return 100.0 * t.covered[k] / std::max(1, t.fitted); };
  fmt::print(
      "| {} | {} | {}/{} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {} | {} | {} | {} "
      "|\n",
      to_string(cell.evolution), cell.name, t.fitted, records, error(0), error(1), error(2), error(3), cover(0),
      cover(1), cover(2), cover(3), t.right, t.wrong, t.states, t.moved);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int records = argc > 1 ? std::atoi(argv[1]) : 40;
  const unsigned only = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0;  // row; 0: all
  fmt::print(R"(# Velocity steps and holds

`scripts/velocity-steps {0}` made this page: {0} records of each row, simulated by an integrator written apart, 20 samples a
second, with noise of 0.0002 (white; coloured: 0.0001 white and 0.0002 that wanders over 2 s) and a drift of about 2e-5 a
second; a 0.006 to 0.014, b - a 0.003 to 0.006, D_c 5 to 10 um. The errors are root mean squares over the records, of fits
of the law they were made with. Covered: per cent of 95 % intervals that hold the truth. Law named: records for which a law
was named (p < 0.05) and it was the right one, and those where it was the wrong one. States: records for which as many
states were chosen as they have. Moved: records whose steps were taken for later or earlier than the load point turns.

)",
             records);
  fmt::print(
      "| law | record | fitted | a % | b % | D_c % | k % | covered a | b | D_c | k | law named | wrong | states | "
      "moved |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::array<int, 2> pooled = {};
  unsigned number = 0;
  for (const StateEvolution evolution : state_evolutions) {
    const auto cell = [&](const char* name, double stiffness, double step, double white, double slow,
                          bool holds = false, double late = 0, std::size_t states = 1, double ramp = 0) {
      return Cell{name, evolution, stiffness, step, white, slow, holds, late, states, ramp};
    };
    // Under the slip law large steps run away above the critical stiffness, too (J.-C. Gu et al., J. Mech. Phys. Solids
    // 32 (1984) 167): with these a and b from 2.2 times the speed on at 1.1 k_c (less while the last one still swings),
    // from 3.5 on at 1.5 k_c.
    const bool ageing = evolution == StateEvolution::ageing;
    for (const Cell& c : {cell("2 and 10 um/s, k = 30 k_c, white", 30, 5, 2e-4, 0),
                          cell("2 and 10 um/s, k = 5 k_c, white", 5, 5, 2e-4, 0),
                          cell("2 and 10 um/s, k = 5 k_c, coloured", 5, 5, 1e-4, 2e-4),
                          ageing ? cell("2 and 10 um/s, k = 1.5 k_c, white", 1.5, 5, 2e-4, 0)
                                 : cell("2 and 6 um/s, k = 1.5 k_c, white", 1.5, 3, 2e-4, 0),
                          ageing ? cell("2 and 10 um/s, k = 1.1 k_c, coloured", 1.1, 5, 1e-4, 2e-4)
                                 : cell("2 and 3 um/s, k = 1.1 k_c, coloured", 1.1, 1.5, 1e-4, 2e-4),
                          cell("2 and 20 um/s, k = 5 k_c, coloured", 5, 10, 1e-4, 2e-4),
                          cell("holds of 3 to 100 s, k = 5 k_c, coloured", 5, 1, 1e-4, 2e-4, true),
                          cell("2 and 10 um/s, up to 0.05 s late, white", 30, 5, 2e-4, 0, false, 0.05),
                          cell("2 and 10 um/s, up to 0.3 s late, white", 30, 5, 2e-4, 0, false, 0.3),
                          cell("2 and 10 um/s, up to 0.3 s late, coloured", 30, 5, 1e-4, 2e-4, false, 0.3),
                          cell("holds of 3 to 100 s, up to 0.2 s late, coloured", 5, 1, 1e-4, 2e-4, true, 0.2),
                          cell("2 and 10 um/s, ramps of 1 s, coloured", 5, 5, 1e-4, 2e-4, false, 0, 1, 1),
                          cell("2 and 10 um/s, ramps of 5 s, coloured", 5, 5, 1e-4, 2e-4, false, 0, 1, 5),
                          cell("two states, white", 10, 5, 2e-4, 0, false, 0, 2),
                          cell("two states, coloured", 10, 5, 1e-4, 2e-4, false, 0, 2)}) {
      ++number;
      if (only > 0 && number != only) continue;
      const Tally tally = run(c, records, number);
      print_row(c, tally, records);
      for (const int covered : tally.covered) pooled[0] += covered, pooled[1] += tally.fitted;
    }
  }
  fmt::print("\n{} of {} intervals hold the truth: {:.1f} %\n", pooled[0], pooled[1], 100.0 * pooled[0] / pooled[1]);
  return 0;
}
