/// Runs the long list of altered records, or of pairs of files: what came of each on the error stream, and the counts.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "altered_cases.hpp"
#include "joined_pairs.hpp"
#include "rates.hpp"
#include "tribofit/execution/parallel.hpp"

namespace {

namespace altered = tribofit::altered;
namespace joined = tribofit::joined;
using altered::AlteredCase;
using recovery::share;

/// Judges all of them, each with a line of its own.
template <class Judged, class Case, class Line>
std::vector<Judged> judge_all(const std::vector<Case>& cases, int threads, const Line& line) {
  std::vector<Judged> judged(cases.size());
  std::mutex mutex;
  tribofit::run_tasks(cases.size(), threads, [&](std::size_t k) {
    judged[k] = judge(cases[k]);
    const std::lock_guard lock(mutex);
    fmt::print(stderr, "{}\n", line(cases[k], judged[k]));
  });
  return judged;
}

int run_joins(const std::vector<joined::Pair>& pairs, int threads) {
  const auto all = judge_all<joined::Judged>(pairs, threads, [](const joined::Pair& pair, const joined::Judged& one) {
    return fmt::format("{}: {} ({:.2f} s)", pair.name, one.text, one.seconds);
  });
  std::map<std::string, std::size_t> counts;
  double seconds = 0, squares = 0;
  std::size_t wrong = 0, right = 0, inside = 0;
  for (const joined::Judged& one : all) {
    const bool is_right = one.outcome == joined::Outcome::right, is_wrong = one.outcome == joined::Outcome::wrong;
    ++counts[std::string(is_right   ? "right"
                         : is_wrong ? "WRONG"
                                    : "refused") +
             (one.belongs ? " of one run" : " of no run")];
    seconds += one.seconds;
    wrong += is_wrong ? 1U : 0U;
    if (!is_right) continue;
    ++right;
    squares += one.error * one.error / (one.std_error * one.std_error);
    inside += std::abs(one.error) < 1.96 * one.std_error ? 1U : 0U;
  }
  for (const auto& [what, count] : counts) fmt::print("{}: {}\n", what, count);
  fmt::print("errors of those that are right: {:.2f} standard errors (root mean square), {} inside 95 %\n",
             std::sqrt(squares / static_cast<double>(right)), share(inside, right));
  fmt::print("{:.2f} s a pair\n", seconds / static_cast<double>(pairs.size()));
  return wrong == 0 ? 0 : 1;
}

/// What came of some of the records.
struct Count {
  std::size_t n = 0, of[4] = {}, loose = 0, inside = 0, slow = 0;

  void add(const altered::Judged& one) {
    const bool is_right = one.outcome == altered::Outcome::right;
    ++n;
    ++of[static_cast<std::size_t>(one.outcome)];
    loose += is_right && !one.strict ? 1 : 0;
    inside += is_right ? static_cast<std::size_t>(one.inside) : 0;
    slow += one.seconds > 10 ? 1 : 0;
  }
  std::string row(const std::string& name) const {
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, n, of[0], loose, of[1], of[2],
                       of[3] == 0 ? "0" : fmt::format("{}: {}", of[3], share(of[3], n)), share(inside, 3 * of[0]));
  }
};

int run_altered(const std::vector<AlteredCase>& cases, int threads) {
  constexpr const char* kNames[] = {"right", "named", "refused", "WRONG"};
  const auto judged =
      judge_all<altered::Judged>(cases, threads, [&](const AlteredCase& what, const altered::Judged& one) {
        return fmt::format("{:<7} {:5.1f} s  {}:{}", kNames[static_cast<std::size_t>(one.outcome)], one.seconds,
                           what.name, one.text);
      });
  std::vector<std::pair<std::string, Count>> groups;
  Count all;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (groups.empty() || groups.back().first != cases[k].group) groups.emplace_back(cases[k].group, Count());
    groups.back().second.add(judged[k]);
    all.add(judged[k]);
  }
  fmt::print(
      "| what was done | n | right | of them beyond 3 standard errors, within 2 % | named | refused | wrong | where "
      "right, 95 % intervals of mu_s, mu_k, alpha hold the truth |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const auto& [name, count] : groups) fmt::print("{}", count.row(name));
  fmt::print("{}\n{} over 10 s\n", all.row("all"), all.slow);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (judged[k].outcome == altered::Outcome::wrong) fmt::print("- wrong: {}:{}\n", cases[k].name, judged[k].text);
  }
  return 0;
}

/// The low-passed records, their filters computed in each way.
std::vector<AlteredCase> in_each_way(altered::AlteredOptions options) {
  using altered::Discretisation;
  constexpr std::pair<const char*, Discretisation> kWays[] = {{"next sample held", Discretisation::next_held},
                                                              {"last sample held", Discretisation::last_held},
                                                              {"straight lines", Discretisation::straight},
                                                              {"bilinear", Discretisation::bilinear}};
  std::vector<AlteredCase> all;
  for (const auto& [order, text] : {std::pair{"first order", "low-pass of"}, {"higher order", "order of"}}) {
    for (const auto& [way, how] : kWays) {
      options.filters = how;
      for (AlteredCase& one : altered::altered_cases(options)) {
        if (one.name.find(text) == std::string::npos) continue;
        one.group = fmt::format("{}, {}", order, way);
        all.push_back(std::move(one));
      }
    }
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Diagnoses good records altered as instruments and recorders do it, or joins two files");
  altered::AlteredOptions options;
  int threads = 0;
  bool joins = false, others = false, each = false;
  std::string only;
  app.add_option("--seed", options.seed, "of noise and scatter")->capture_default_str();
  app.add_flag("--each-filter", each, "only records that were low-passed, their filters computed in each way");
  app.add_flag("--joins", joins, "pairs of files of one run or of two");
  app.add_flag("--other-joins", others, "pairs of other kinds of record");
  app.add_option("--threads", threads, "0: as many as there are");
  app.add_option("TEXT", only, "only cases whose name or group holds it");
  CLI11_PARSE(app, argc, argv);
  const auto has = [&](const std::string& text) { return text.find(only) != std::string::npos; };
  if (joins || others) {
    auto pairs = others ? joined::other_pairs() : joined::pairs();
    std::erase_if(pairs, [&](const auto& pair) { return !has(pair.name); });
    return run_joins(pairs, threads);
  }
  std::vector<AlteredCase> cases = each ? in_each_way(options) : altered::altered_cases(options);
  std::erase_if(cases, [&](const AlteredCase& one) { return !has(one.name) && !has(one.group); });
  return run_altered(cases, threads);
}
