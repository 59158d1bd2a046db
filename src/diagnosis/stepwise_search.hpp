#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stepwise.hpp"

namespace tribofit::diagnosis {

/// A model at both resolutions.
struct Fitted {
  Trial fine, coarse;
};

/// What is known when a step begins.
struct Progress {
  std::vector<Fitted> laws;  ///< every law with the effects that were found
  std::size_t best = 0;      ///< of them
  std::vector<LadderStep> terms = {};  ///< without their trials
  std::vector<CandidateResult> last = {};
  std::vector<std::size_t> withdrawn = {};
  bool finished = false;
};

/// A candidate that is named beside a law.
struct Named {
  std::size_t law = 0;
  CandidateResult result;
  std::vector<std::size_t> equivalent;
  std::vector<CandidateResult> judged;
};

/// The search of climb(), step by step.
class Stepwise {
 public:
  Stepwise(const DiagnosisContext& context, const std::vector<Candidate>& candidates, const Limits& least)
      : context_(context), candidates_(candidates), least_(least) {}

  void start(const std::vector<Law>& laws, const std::vector<Candidate>& from_the_start);
  /// Adds the effect that leads, if one is named.
  void extend(int most_effects);
  /// What is done once, when nothing more is named.
  void finish();
  Ladder ladder() &&;

  Progress now;
  const Fitted& best() const { return now.laws[now.best]; }

 private:
  const std::string& key(std::size_t candidate) const { return candidates_[candidate].info.key; }
  std::vector<CandidateResult> judge_beside(std::size_t law, const Trial* to_beat = nullptr) const {
    return judge_all(context_, now.laws[law].fine, now.laws[law].coarse, candidates_, least_, to_beat);
  }
  Fitted coarse_too(Trial fine) const;
  std::size_t best_law() const;
  void fit_laws(Fitted known);
  Named leader_beside(std::size_t law, const Trial* to_beat = nullptr) const;
  std::optional<Named> leader_of_all(bool structured);
  bool improve(const Named& leader);
  bool extend_by_pair(const Named* leader, double worth, int most_effects);
  void add(const CandidateResult& result, std::vector<std::size_t> equivalent, std::vector<CandidateResult> judged);
  bool drop_one();
  bool exchange_one();
  std::vector<CandidateResult> judge_instead(const LadderStep& term, const Trial& without) const;
  std::vector<LadderStep> in_order() const;

  const DiagnosisContext& context_;
  const std::vector<Candidate>& candidates_;
  const Limits& least_;
};

}  // namespace tribofit::diagnosis
