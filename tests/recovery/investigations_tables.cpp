#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/// How often answers that were called so likely before any further run were the truth.
std::string answers_table(const std::vector<const Investigation*>& open) {
  struct Fifth {
    double n = 0, stated = 0, hits = 0;
  };
  std::array<Fifth, 5> fifths{};
  for (const Investigation* one : open) {
    for (const auto& [probability, is_truth] : one->answers) {
      Fifth& fifth = fifths[std::min<std::size_t>(4, static_cast<std::size_t>(5 * probability))];
      fifth.n += 1;
      fifth.stated += probability;
      fifth.hits += is_truth ? 1 : 0;
    }
  }
  std::string text = "| answer called likely by | answers | mean stated | it was the truth |\n|---|---|---|---|\n";
  for (std::size_t k = 0; k < fifths.size(); ++k) {
    const Fifth& f = fifths[k];
    if (f.n == 0) continue;
    text += fmt::format("| {} to {} % | {} | {:.0f} % | {} |\n", 20 * k, 20 * (k + 1), static_cast<std::size_t>(f.n),
                        100 * f.stated / f.n, share_of(f.hits, f.n));
  }
  return text;
}

std::string calibration_table(const std::vector<const Investigation*>& open) {
  struct Tenth {
    double n = 0, stated = 0, hits = 0;
  };
  std::array<Tenth, 10> tenths{};
  for (const Investigation* one : open) {
    for (const auto* arm : {&one->planned, &one->random, &one->tried}) {
      // At random: the first run only, before which the probability was stated.
      const std::size_t count = arm == &one->random ? std::min<std::size_t>(1, arm->size()) : arm->size();
      for (std::size_t k = 0; k < count; ++k) {
        const FurtherRun& run = (*arm)[k];
        Tenth& tenth = tenths[std::min<std::size_t>(9, static_cast<std::size_t>(10 * run.probability))];
        tenth.n += 1;
        tenth.stated += run.probability;
        tenth.hits += run.alone ? 1 : 0;
      }
    }
  }
  std::string text = "| stated | runs | mean stated | named alone |\n|---|---|---|---|\n";
  for (std::size_t k = 0; k < tenths.size(); ++k) {
    const Tenth& t = tenths[k];
    if (t.n == 0) continue;
    text += fmt::format("| {} to {} % | {} | {:.0f} % | {} |\n", 10 * k, 10 * (k + 1), static_cast<std::size_t>(t.n),
                        100 * t.stated / t.n, share_of(t.hits, t.n));
  }
  return text;
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
