#pragma once

#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// What each model predicts to be seen in an experiment, and over which variables.
struct Seen {
  std::vector<Prediction> predictions;  ///< those that are furthest apart first
  std::vector<PredictedCurves> curves;
};
Seen predict_seen(const OpenQuestion& question, const Experiment& experiment, bool with_curves,
                  const PlanOptions& options);

}  // namespace tribofit
