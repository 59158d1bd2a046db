#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "limits.hpp"
#include "probes.hpp"
#include "trial.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// A candidate judged beside the model so far.
struct CandidateResult {
  std::size_t candidate = 0;
  Trial trial;
  /// The same at low resolution, without its rows, where it was judged there first; else not usable.
  Trial coarse;
  double fall = 0;  ///< of the whitened squares on held-out cycles
  /// That fall over the squares that sensor noise leaves, or the fall of the plain squares over those that noise and
  /// scatter leave: the larger.
  double size = 0;
  double p_value = 1;  ///< corrected for the number of candidates and of places looked at
  double design_effect = 1;
  bool hopeless = false;  ///< far behind the best already at low resolution, and judged there only
  bool plausible = true;  ///< no decisive parameter on its bound
  bool passes = false;
  bool by_level = false;  ///< it passes by the levels of break-away alone
};

/// The leader among those that pass, with those that are not distinguishable from it.
struct Choice {
  std::optional<std::size_t> leader;  ///< index in `judged`
  std::vector<std::size_t> group;     ///< candidates
  /// Held-out squares of each above the best, over the noise of a difference; infinite where it does not pass.
  std::vector<double> behind = {};
  /// What the least size of a difference is in the same unit: it grows with the record, as differences do.
  double least_by_size = 0;
};

/// How much larger the variance of a parameter is than independent residuals of one variance would make it.
struct DesignEffect {
  double of_cycles = 1;  ///< correlation within and between cycles, as the cycles themselves show it. At least 1
  double of_slow = 1;    ///< the same where all correlation is that of slow noise. At least 1
  double largest() const { return std::max(of_cycles, of_slow); }
};
/// The largest of `count` parameters from `first` on. noise: variance of a residual.
DesignEffect design_effect(const CycleEvidence& evidence, const std::vector<bool>& free, std::size_t first,
                           std::size_t count, double noise, const SlowNoise& slow);

/// p-value of a fall of the squares by `fall` for `parameters` more parameters, when independent residuals of variance
/// `noise` count for 1/design_effect each and the variance is known with `freedom` degrees of freedom (F test).
double fall_p_value(double fall, std::size_t parameters, double noise, double design_effect, double freedom);

/// How much better `richer` is than `poorer`, from which it differs by one effect. tests: the p-value is corrected for
/// as many.
CandidateResult compare(const DiagnosisContext& context, const Level& level, const Trial& poorer, Trial richer,
                        const Candidate& candidate, double tests, const Limits& least);

/// Fits further columns beside a trial and writes what that takes off its squares into the probe: fall, size, p_value.
/// columns: one row a value of each slip and one for its break-away; places: where else the same would have been looked
/// for. Returns their coefficients, none where the model is not finite there. Cost: one pass over the values of the
/// level.
Eigen::VectorXd judge_probe(const DiagnosisContext& context, const Level& level, const Trial& trial,
                            const ModelResiduals::FurtherColumns& columns, double places, Probe& probe);

/// What an effect must promise to be worth a fit beside a model that leaves the squares of `coarse`, with scatter as
/// `whitening` says.
LeastFalls worth_fitting(const DiagnosisContext& context, const Trial& coarse,
                         const ModelResiduals::Whitening& whitening, const Limits& least);

/// So far behind the best at low resolution that more resolution will not change it. behind: held-out squares above
/// those of the best; fallen: what the best explains.
bool is_far_behind(const DiagnosisContext& context, double behind, double fallen);

/// What the richer of two models takes off: see CandidateResult::size.
double size_of_fall(const DiagnosisContext& context, const Trial& poorer, const Trial& richer);

/// The first predicts held-out cycles better than the second: by more than a least size, which each of its further
/// parameters must earn, and by more than chance: of their losses cycle by cycle, with a long-run variance, or of the
/// fall of the squares, with slow noise as the record shows it. With more effects by plain squares too.
bool beats(const DiagnosisContext& context, const Trial& first, const Trial& second);

/// Every testable candidate beside the model so far (top, and the same at low resolution). to_beat: a model at low
/// resolution; what does not promise to come near it is not fitted, and lines are not looked for again.
std::vector<CandidateResult> judge_all(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                       const std::vector<Candidate>& candidates, const Limits& least,
                                       const Trial* to_beat = nullptr);

/// The two fit differently well, by more than chance would make them differ.
bool are_distinguishable(const DiagnosisContext& context, const CandidateResult& better, const CandidateResult& worse);

/// Who leads, and who is not distinguishable from the leader. Of the forms of one effect one passes afterwards.
Choice choose(const DiagnosisContext& context, std::vector<CandidateResult>& judged,
              const std::vector<Candidate>& candidates);

}  // namespace tribofit::diagnosis
