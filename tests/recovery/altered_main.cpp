/// Runs the long list of altered records, or of pairs of files: what came of each, and the count.
#include <fmt/format.h>

#include <algorithm>
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
#include "joined_pairs.hpp"

namespace {

using namespace tribofit::altered;

unsigned threads_of_machine() {
  return std::max(1U, std::thread::hardware_concurrency());
}

/// Calls `work` for 0 to count - 1, on some threads.
template <typename Work>
void run_all(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> running;
  for (unsigned k = 0; k < threads; ++k) {
    running.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
  for (std::thread& thread : running) thread.join();
}

int run_joins(const std::vector<tribofit::joined::Pair>& pairs, unsigned threads) {
  std::vector<tribofit::joined::Judged> judged(pairs.size());
  std::mutex mutex;
  run_all(pairs.size(), threads, [&](std::size_t k) {
    judged[k] = tribofit::joined::judge(pairs[k]);
    const std::lock_guard lock(mutex);
    fmt::print("{}: {} ({:.2f} s)\n", pairs[k].name, judged[k].text, judged[k].seconds);
    std::fflush(stdout);
  });
  std::map<std::string, int> counts;
  double seconds = 0, squares = 0, inside = 0, right = 0;
  int wrong = 0;
  for (const auto& one : judged) {
    const bool is_right = one.outcome == tribofit::joined::Outcome::right,
               is_wrong = one.outcome == tribofit::joined::Outcome::wrong;
    ++counts[std::string(is_right   ? "right"
                         : is_wrong ? "WRONG"
                                    : "refused") +
             (one.belongs ? " of one run" : " of no run")];
    seconds += one.seconds;
    wrong += is_wrong ? 1 : 0;
    if (!is_right) continue;
    right += 1;
    squares += one.error * one.error / (one.std_error * one.std_error);
    inside += std::abs(one.error) < 1.96 * one.std_error ? 1 : 0;
  }
  for (const auto& [what, count] : counts) fmt::print("{}: {}\n", what, count);
  fmt::print("errors of those that are right: {:.2f} standard errors (root mean square), {:.0f} % inside 95 %\n",
             std::sqrt(squares / right), 100 * inside / right);
  fmt::print("{:.2f} s a pair\n", seconds / static_cast<double>(pairs.size()));
  return wrong == 0 ? 0 : 1;
}

constexpr const char* kNames[] = {"right", "named", "refused", "WRONG"};

}  // namespace

/// usage: altered_benchmark [--threads N] [--joins | --other-joins] [TEXT in the name]
int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  unsigned threads = threads_of_machine();
  bool joins = false, others = false;
  std::string only;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] == "--threads" && k + 1 < arguments.size()) {
      threads = static_cast<unsigned>(std::max(1, std::stoi(arguments[++k])));
    } else if (arguments[k] == "--joins" || arguments[k] == "--other-joins") {
      joins = true, others = arguments[k] == "--other-joins";
    } else {
      only = arguments[k];
    }
  }
  const auto is_other = [&](const auto& one) { return one.name.find(only) == std::string::npos; };
  if (joins) {
    auto pairs = others ? tribofit::joined::other_pairs() : tribofit::joined::pairs();
    std::erase_if(pairs, is_other);
    return run_joins(pairs, threads);
  }
  std::vector<AlteredCase> cases = altered_cases();
  std::erase_if(cases, is_other);
  std::mutex mutex;
  std::size_t counts[4] = {}, slow = 0, loose = 0;
  run_all(cases.size(), threads, [&](std::size_t k) {
    const Judged judged = judge(cases[k]);
    const std::lock_guard lock(mutex);
    ++counts[static_cast<std::size_t>(judged.outcome)];
    slow += judged.seconds > 10 ? 1U : 0U;
    loose += judged.outcome == Outcome::right && !judged.strict ? 1U : 0U;
    fmt::print("{:<7} {:5.1f} s  {}:{}\n", kNames[static_cast<std::size_t>(judged.outcome)], judged.seconds,
               cases[k].name, judged.text);
    std::fflush(stdout);
  });
  fmt::print(
      "{} cases: {} right ({} of them beyond three standard errors, within 2 %), {} named, {} refused, {} wrong; {} "
      "over 10 s\n",
      cases.size(), counts[0], loose, counts[1], counts[2], counts[3], slow);
  return counts[3] == 0 ? 0 : 1;
}
