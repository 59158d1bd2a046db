#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "investigations.hpp"

namespace recovery {

namespace {

/// Upper and lower end of the two-sided 95 % interval of a share (Wilson).
std::string share_of(double hits, double n) {
  if (n == 0) return "-";
  const double z = 1.96, p = hits / n, middle = (p + z * z / (2 * n)) / (1 + z * z / n),
               half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return fmt::format("{:.0f} % ({:.0f} of {}; {:.0f} to {:.0f} %)", 100 * p, hits, static_cast<std::size_t>(n),
                     100 * std::max(0.0, middle - half), 100 * (middle + half));
}

/// Of the runs of each arm, how many named the truth alone after so many.
std::string progress_table(const std::vector<const Investigation*>& open, std::size_t most) {
  std::string text = "| further runs | planned: truth alone | at random: truth alone |\n|---|---|---|\n";
  const auto within = [&](std::vector<FurtherRun> Investigation::*arm, std::size_t runs) {
    return static_cast<double>(std::count_if(open.begin(), open.end(), [&](const Investigation* one) {
      const std::size_t until = Investigation::runs_until_alone(one->*arm);
      return until > 0 && until <= runs;
    }));
  };
  const auto n = static_cast<double>(open.size());
  for (std::size_t k = 1; k <= most; ++k) {
    text += fmt::format("| {} | {} | {} |\n", k, k <= 3 ? share_of(within(&Investigation::planned, k), n) : "",
                        share_of(within(&Investigation::random, k), n));
  }
  return text;
}

/// What was stated with some probability, and whether it came true.
using Stated = std::vector<std::pair<double, bool>>;

/// One row for each of so many equal ranges of the probability.
std::string stated_table(const std::string& header, std::size_t ranges, const Stated& all) {
  struct Range {
    double n = 0, stated = 0, hits = 0;
  };
  std::vector<Range> found(ranges);
  for (const auto& [probability, came_true] : all) {
    Range& own = found[std::min(ranges - 1, static_cast<std::size_t>(static_cast<double>(ranges) * probability))];
    own.n += 1;
    own.stated += probability;
    own.hits += came_true ? 1 : 0;
  }
  std::string text = header;
  const std::size_t width = 100 / ranges;
  for (std::size_t k = 0; k < ranges; ++k) {
    const Range& own = found[k];
    if (own.n == 0) continue;
    text += fmt::format("| {} to {} % | {} | {:.0f} % | {} |\n", width * k, width * (k + 1),
                        static_cast<std::size_t>(own.n), 100 * own.stated / own.n, share_of(own.hits, own.n));
  }
  return text;
}

/// How often answers that were called so likely before any further run were the truth.
std::string answers_table(const std::vector<const Investigation*>& open) {
  Stated all;
  for (const Investigation* one : open) all.insert(all.end(), one->answers.begin(), one->answers.end());
  return stated_table("| answer called likely by | answers | mean stated | it was the truth |\n|---|---|---|---|\n", 5,
                      all);
}

std::string calibration_table(const std::vector<const Investigation*>& open) {
  Stated all;
  for (const Investigation* one : open) {
    for (const auto* arm : {&one->planned, &one->random, &one->tried}) {
      // At random: the first run only, before which the probability was stated.
      const std::size_t count = arm == &one->random ? std::min<std::size_t>(1, arm->size()) : arm->size();
      for (std::size_t k = 0; k < count; ++k) all.emplace_back((*arm)[k].probability, (*arm)[k].alone);
    }
  }
  return stated_table("| stated | runs | mean stated | named alone |\n|---|---|---|---|\n", 10, all);
}

}  // namespace

std::string investigations_tables(const std::vector<Investigation>& all) {
  std::vector<const Investigation*> open, planned;
  double failures = 0, hopeless = 0, wrong = 0, wrong_random = 0, runs = 0, random_runs = 0;
  for (const Investigation& one : all) {
    failures += one.failure.empty() ? 0 : 1;
    if (!one.open) continue;
    open.push_back(&one);
    if (one.planned.empty()) {
      hopeless += 1;
      continue;
    }
    planned.push_back(&one);
    for (const FurtherRun& run : one.planned) wrong += run.wrong ? 1 : 0, runs += 1;
    for (const FurtherRun& run : one.random) wrong_random += run.wrong ? 1 : 0, random_runs += 1;
  }
  std::string text = fmt::format(
      "First records: {}; open after them: {}; of these {} where the first plan said that nothing settles it; "
      "failures: "
      "{}.\n\n",
      all.size(), open.size(), static_cast<std::size_t>(hopeless), static_cast<std::size_t>(failures));
  std::size_t most = 3;  // and as many at random as were made
  for (const Investigation* one : planned) most = std::max(most, one->random.size());
  text += progress_table(planned, most);
  text += fmt::format("\nWrong names: {} of the diagnoses after planned runs, {} after random ones.\n\n",
                      share_of(wrong, runs), share_of(wrong_random, random_runs));
  return text + calibration_table(planned) + "\n" + answers_table(open);
}

}  // namespace recovery
