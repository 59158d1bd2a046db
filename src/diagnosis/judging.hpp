#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trial.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// A candidate judged beside the model so far.
struct CandidateResult {
  std::size_t candidate = 0;
  Trial trial;
  double fall = 0;  ///< of the whitened squares on held-out cycles
  /// That fall over the squares that sensor noise leaves, or the fall of the plain squares over those that noise and
  /// scatter leave: the larger.
  double size = 0;
  double p_value = 1;  ///< corrected for the number of candidates and of places looked at
  double design_effect = 1;
  bool hopeless = false;  ///< far behind the best already at low resolution, and judged there only
  bool plausible = true;  ///< no telling parameter on its bound
  bool passes = false;
  bool by_level = false;  ///< it passes by the levels of break-away alone
};

/// What must be passed for a name.
struct Limits {
  double p_value = 0.01;
  double least_size = 0.02;   ///< of the squares that sensor noise leaves
  double obvious_size = 0.5;  ///< a fall beyond this many times those squares,
  double obvious_part = 0.3;  ///< and beyond this part of all that is above them, is no chance
};

/// Two models are told apart when their squares differ by more than chance would make them: with the right one known
/// the difference is d^2 -+ 2 d sqrt(noise) in units in which the noise of the difference is one; 40 is beyond three
/// standard deviations, with some room for the models themselves being approximations.
inline constexpr double kToldApart = 40;
inline constexpr double kToldApartSize = 0.003;  ///< and by this part of the squares of the noise

/// The leader among those that pass, with those that cannot be told from it.
struct Choice {
  std::optional<std::size_t> leader;  ///< index in `judged`
  std::vector<std::size_t> group;     ///< candidates
};

/// How much better `richer` is than `poorer`, from which it differs by one effect. tests: the p-value is corrected for
/// as many.
CandidateResult compare(const DiagnosisContext& bench, const Level& level, const Trial& poorer, Trial richer,
                        const Candidate& candidate, double tests, const Limits& limits);

/// Every testable candidate beside the top of a ladder (top, and the same at low resolution).
std::vector<CandidateResult> judge_all(const DiagnosisContext& bench, const Trial& top, const Trial& coarse_top,
                                       const std::vector<Candidate>& candidates, const Limits& limits);

/// Who leads, and who cannot be told from the leader. Of the forms of one effect one passes afterwards.
Choice choose(const DiagnosisContext& bench, std::vector<CandidateResult>& judged,
              const std::vector<Candidate>& candidates);

}  // namespace tribofit::diagnosis
