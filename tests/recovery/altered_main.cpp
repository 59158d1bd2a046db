/// Runs the long list of altered records: what came of each, and the count.
#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "altered_cases.hpp"

namespace {

using namespace tribofit::altered;

constexpr const char* kNames[] = {"right", "named", "refused", "WRONG"};

}  // namespace

/// usage: altered_benchmark [TEXT in the name]
int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
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
