/// Simulated investigations.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "investigations.hpp"
#include "tribofit/execution/parallel.hpp"

namespace {

using namespace recovery;

std::string line(const Investigation& one) {
  std::string text = fmt::format("{:<46} {}", one.tested.name, one.first);
  if (!one.failure.empty()) return text + "; THREW " + one.failure;
  if (!one.open) return text;
  const auto arm = [](const std::vector<FurtherRun>& runs) {
    std::string all;
    for (const FurtherRun& run : runs) {
      all += fmt::format("; {} ({:.0f} %, expected {:.0f} %): {}{}", run.what, 100 * run.probability,
                         100 * run.expected, run.names,
                         run.alone   ? " ALONE"
                         : run.wrong ? " WRONG"
                                     : "");
    }
    return all;
  };
  text += fmt::format("; planned in {:.1f} s{}", one.seconds, arm(one.planned));
  if (one.hopeless) text += "; hopeless";
  return text + "\n    random" + arm(one.random) + "\n    by itself" + arm(one.tried);
}

}  // namespace

int main(int argc, char** argv) {
  InvestigationOptions options;
  std::string only;
  double minutes = std::numeric_limits<double>::infinity();
  CLI::App app("Simulated investigations: plan, run, diagnose, again");
  app.add_option("--count", options.count, "Investigations that are open after the first record");
  app.add_option("--tried", options.most_tried, "First records that are diagnosed to find them");
  app.add_option("--random", options.most_random, "Runs at random beside the planned ones (0: none)");
  app.add_option("--uncertain", options.most_tried_alone, "Uncertain runs of a first plan that are made by themselves");
  app.add_option("--effort", options.effort, "Records diagnosed in full for a plan, of the usual number");
  app.add_option("--seed", options.seed, "");
  app.add_option("--threads", options.threads, "Investigations at a time");
  app.add_option("--only", only, "Cases whose name holds this");
  app.add_option("--minutes", minutes, "After which no further investigation is begun");
  CLI11_PARSE(app, argc, argv);
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Case> cases = investigated_cases(options.most_tried, options.seed);
  std::erase_if(cases, [&](const Case& c) { return c.name.find(only) == std::string::npos; });
  std::vector<Investigation> done;
  std::mutex mutex;
  std::size_t open = 0;
  // In their order until enough are open: which are taken does not depend on the threads but for the last few.
  tribofit::run_tasks(cases.size(), options.threads, [&](std::size_t k) {
    {
      const std::lock_guard lock(mutex);
      const std::chrono::duration<double, std::ratio<60>> spent = std::chrono::steady_clock::now() - begin;
      if (open >= options.count || spent.count() > minutes) return;
    }
    Investigation one = investigate(cases[k], options);
    const std::lock_guard lock(mutex);
    open += one.open ? 1 : 0;
    fmt::print(stderr, "{}\n", line(one));
    done.push_back(std::move(one));
  });
  std::sort(done.begin(), done.end(),
            [](const Investigation& a, const Investigation& b) { return a.tested.name < b.tested.name; });
  fmt::print("{}", investigations_tables(done));
  return std::any_of(done.begin(), done.end(), [](const Investigation& one) { return !one.failure.empty(); }) ? 1 : 0;
}
