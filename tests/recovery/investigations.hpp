#pragma once

/// Simulated investigations: a hidden truth, a first record that leaves it open, and then, up to three times, a plan
/// (study/plan.hpp), the run that it puts first, and a diagnosis of all records together. Beside it the same with runs
/// drawn at random from those that the plan could choose from.

#include <string>
#include <utility>
#include <vector>

#include "hidden_effects.hpp"
#include "tribofit/study/plan.hpp"

namespace recovery {

/// One further run.
struct FurtherRun {
  std::string what;        ///< "8 rpm", "tap"
  double probability = 0;  ///< as the plan stated it
  double expected = 0;     ///< the same from the expected difference alone
  double minutes = 0;
  bool alone = false;  ///< afterwards the truth is named, and nothing beside it
  bool wrong = false;  ///< afterwards something else is named without the truth
  std::string names;   ///< afterwards
};

struct Investigation {
  Case tested;
  std::string first;      ///< names after the first record
  bool open = false;      ///< the truth was among those that the first record left open
  bool hopeless = false;  ///< a plan said that nothing settles it
  std::vector<std::pair<double, bool>>
      answers;                      ///< of the first plan: how likely each was, and whether it is the truth
  std::vector<FurtherRun> planned;  ///< until the truth is named alone, or three
  std::vector<FurtherRun> random;   ///< the same, or `most_random`
  std::vector<FurtherRun> tried;    ///< runs that the first plan thinks uncertain, each made by itself
  double seconds = 0;               ///< of one processor, for the first plan
  std::string failure;

  /// Runs until the truth is named alone; 0: it never was.
  static std::size_t runs_until_alone(const std::vector<FurtherRun>& runs);
};

struct InvestigationOptions {
  std::size_t count = 200;        ///< of investigations that are open after the first record
  std::size_t most_tried = 3000;  ///< first records that are diagnosed to find them
  std::size_t most_runs = 3, most_random = 6;
  std::size_t most_tried_alone = 0;  ///< runs of the first plan, stated 10 to 90 %, that are made for the calibration
  double effort = 0.5;               ///< see PlanOptions
  std::uint64_t seed = 1;
  int threads = 0;
};

/// The cases: each pair of effects that look alike, either as the truth, in short and noisy records of the smallest
/// size, which leave much open.
std::vector<Case> investigated_cases(std::size_t count, std::uint64_t seed);

/// Never throws: what is thrown is in `failure`.
Investigation investigate(const Case& c, const InvestigationOptions& options);

/// Shares named alone, wrong names, random runs, and the calibration of the stated probabilities, as Markdown.
std::string investigations_tables(const std::vector<Investigation>& all);

}  // namespace recovery
