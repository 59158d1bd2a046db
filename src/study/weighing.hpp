#pragma once

#include <functional>
#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// How likely an experiment is to settle a question if one of the models is the true one.
struct Chance {
  double named = 0;       ///< that the rule of evidence names the true answer, and it alone
  bool simulated = true;  ///< false: no run of it could be simulated
};

/// Chance of one draw of the truth from its posterior, by the expected difference of the models (see plan_runs()).
/// truth: index of the model; draw: which one.
Chance expected_chance(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment,
                       std::size_t truth, std::uint64_t draw, const PlanOptions& options);

/// Chance that a value so many of its standard uncertainties from nothing is beyond three of them when it is measured.
double chance_beyond(double sigmas);

/// What a full diagnosis of the records with a simulated one of the experiment comes to.
enum class Answer { named, open, wrong };
Answer diagnose_simulated(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment,
                          std::size_t truth, std::uint64_t draw, const PlanOptions& options);

/// What each model predicts to be seen in an experiment, and over which variables.
std::vector<Prediction> predict_seen(const OpenQuestion& question, const Experiment& experiment,
                                     const PlanOptions& options);
std::vector<PredictedCurves> predict_curves(const OpenQuestion& question, const Experiment& experiment,
                                            const PlanOptions& options);

}  // namespace tribofit
