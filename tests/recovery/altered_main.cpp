/// Runs the long list of altered records: what came of each, and the count.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "altered_cases.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/kinematics/clock_offset.hpp"

namespace {

using namespace tribofit::altered;

/// Two files of one run or of none, as two instruments write them.
struct Pair {
  std::string name;
  unsigned seed = 0;
  double rpm = 4, late = 0, clock = 0, ppm = 0;  ///< the velocity's start, its clock's zero [s], its drift
  bool strangers = false;
};

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  Random random(1);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  for (unsigned k = 0; k < 500; ++k) {
    Pair pair;
    pair.seed = 1 + k % 12;
    pair.rpm = 2 + 2 * (k % 5);
    const double late = std::exp(uniform(std::log(0.1), std::log(30.0)));
    pair.late = k % 2 == 0 ? late : -late;
    pair.clock = k % 3 == 0 ? uniform(-50, 50) : 0;
    pair.ppm = k % 4 == 0 ? uniform(-200, 200) : 0;
    pair.strangers = k % 10 == 9;
    if (k % 20 == 8) pair.late = k % 40 == 8 ? 41 : -41;
    pair.name = fmt::format("{} rpm, {:.3g} s late, clock {:.3g} s, {:.3g} ppm{}", pair.rpm, pair.late, pair.clock,
                            pair.ppm, pair.strangers ? ", of other runs" : "");
    all.push_back(pair);
  }
  return all;
}

constexpr double kDuration = 80, kLength = 40;

/// A stretch of a channel from a time on, with the times on its own clock.
std::pair<std::vector<double>, std::vector<double>> stretch(const tribofit::Trace& trace, Channel channel,
                                                            double from) {
  const double step = trace.interval();
  const auto begin = static_cast<std::size_t>(from / step + 0.5), n = static_cast<std::size_t>(kLength / step);
  std::vector<double> time, values;
  for (std::size_t i = begin; i < std::min(trace.size(), begin + n); ++i) {
    time.push_back(static_cast<double>(i - begin) * step);
    values.push_back((trace.*channel)[i]);
  }
  return {time, values};
}

/// "right", "refused" or "WRONG" with the error.
std::string join_of(const Pair& pair, const tribofit::Trace& trace, const tribofit::Trace& other) {
  const double friction_from = pair.late < 0 ? -pair.late : 0, velocity_from = pair.late > 0 ? pair.late : 0;
  const auto [friction_time, friction] = stretch(trace, kFriction, friction_from);
  auto [velocity_time, velocity] = stretch(pair.strangers ? other : trace, kVelocity, velocity_from);
  for (double& t : velocity_time) t = t * (1 + 1e-6 * pair.ppm) + pair.clock;
  const double overlap = kLength - std::abs(pair.late), middle = std::max(0.0, -pair.late) + 0.5 * overlap;
  const double at = middle * (1 + 1e-6 * pair.ppm) + pair.clock;  // the velocity's clock half way through the overlap
  const double truth = middle + pair.late - at;
  try {
    const tribofit::ClockOffset found =
        tribofit::estimate_clock_offset(friction_time, friction, velocity_time, velocity);
    if (found.events == 0) return "refused: no events";
    const double error = found.offset - truth;
    const bool is_right = overlap > 0 && !pair.strangers && std::abs(error) < 1e-4;
    return fmt::format("{} {:+.3f} ms", is_right ? "right" : "WRONG", 1e3 * error);
  } catch (const tribofit::InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

int run_joins() {
  std::map<std::pair<unsigned, double>, tribofit::Trace> traces;
  const std::vector<Pair> all = pairs();
  const auto trace_of = [&](unsigned seed, double rpm) -> const tribofit::Trace& {
    tribofit::Trace& trace = traces[{seed, rpm}];
    if (trace.size() == 0) {
      tribofit::truth::Rig rig;
      rig.rpm = rpm, rig.duration = kDuration, rig.rate = 10000, rig.scatter = 0.004, rig.seed = seed;
      trace = tribofit::truth::simulate(rig).trace;
    }
    return trace;
  };
  std::map<std::string, int> counts;
  for (const Pair& pair : all) {
    const std::string said = join_of(pair, trace_of(pair.seed, pair.rpm), trace_of(pair.seed + 100, pair.rpm));
    const bool belongs = !pair.strangers && std::abs(pair.late) < kLength;
    ++counts[said.substr(0, 5) + (belongs ? " of one run" : " of no run")];
    fmt::print("{}: {}\n", pair.name, said);
    std::fflush(stdout);
  }
  for (const auto& [what, count] : counts) fmt::print("{}: {}\n", what, count);
  return 0;
}

constexpr const char* kNames[] = {"right", "named", "refused", "WRONG"};

}  // namespace

/// usage: altered_benchmark [--joins | TEXT in the name]
int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  if (only == "--joins") return run_joins();
  std::vector<AlteredCase> cases = altered_cases();
  std::erase_if(cases, [&](const AlteredCase& one) { return one.name.find(only) == std::string::npos; });
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t counts[4] = {}, slow = 0, loose = 0;
  const auto work = [&] {
    for (std::size_t k = next++; k < cases.size(); k = next++) {
      const Judged judged = judge(cases[k]);
      const std::lock_guard lock(mutex);
      ++counts[static_cast<std::size_t>(judged.outcome)];
      slow += judged.seconds > 10 ? 1U : 0U;
      loose += judged.outcome == Outcome::right && !judged.strict ? 1U : 0U;
      fmt::print("{:<7} {:5.1f} s  {}:{}\n", kNames[static_cast<std::size_t>(judged.outcome)], judged.seconds,
                 cases[k].name, judged.text);
      std::fflush(stdout);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  fmt::print(
      "{} cases: {} right ({} of them beyond three standard errors, within 2 %), {} named, {} refused, {} wrong; {} "
      "over 10 s\n",
      cases.size(), counts[0], loose, counts[1], counts[2], counts[3], slow);
  return counts[3] == 0 ? 0 : 1;
}
