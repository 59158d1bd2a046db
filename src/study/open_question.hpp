#pragma once

#include <string>
#include <vector>

#include "plausible_draws.hpp"
#include "simulated_run.hpp"
#include "tribofit/study/identified.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// What a diagnosis leaves open, with what it takes to simulate every answer.
struct OpenQuestion {
  QuestionKind kind = QuestionKind::nothing;
  Law law = ExponentialLaw{};
  std::vector<Effect> beside;               ///< effects found that are not asked about
  std::vector<Effect> asked;                ///< one of them is there; of QuestionKind::possible one or none
  std::vector<ModelInQuestion> models;      ///< for each asked; where they are possible, the last without any
  std::vector<IdentifiedMachine> machines;  ///< for each model
  std::vector<PlausibleDraws> draws;        ///< the same
  RecordToContinue record;
  std::size_t trace = 0;              ///< whose conditions the runs go on from
  std::string reason;                 ///< why nothing can be simulated
  std::vector<double> p_values = {};  ///< of effects that are possible, the least first
  /// Held-out squares of each model behind the best by the records so far, over the noise of a difference (see Ruling);
  /// 0 where they are possible.
  std::vector<double> behind;

  bool without(std::size_t model) const { return kind == QuestionKind::possible && model == asked.size(); }
};

/// The first group of the ladder that is open, else an effect that is possible.
OpenQuestion open_question(const DiagnosedTraces& diagnosed, const PlanOptions& options);

std::vector<Record> records_of(const DiagnosedTraces& diagnosed);

}  // namespace tribofit
