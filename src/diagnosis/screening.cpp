#include "evidence.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "tribofit/execution/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// Every testable candidate beside the top of a ladder, judged first at low resolution and then, those that may lead
/// or be in the leader's group, at full resolution.
class CandidateScreening {
 public:
  CandidateScreening(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                     const std::vector<Candidate>& candidates, const Limits& least, const Trial* to_beat);

  void judge_coarsely();
  /// Judges anew at full resolution what promises enough beside the best; false where nothing more does.
  bool judge_promising();
  std::vector<CandidateResult> result() &&;

 private:
  const EffectInfo& info(std::size_t t) const { return candidates_[out_[t].candidate].info; }
  void judge(std::size_t t, const Level& level, const Trial& beside, const FrictionModel& model,
             const std::vector<double>& start, int threads);
  void search(std::size_t t, const Level& level, const Trial& beside);
  bool is_hopeless(std::size_t t, double best) const;

  const DiagnosisContext& context_;
  const Trial &top_, &coarse_top_;
  const std::vector<Candidate>& candidates_;
  const Limits& least_passing_;
  LeastFalls least_falls_;
  double best_elsewhere_ = std::numeric_limits<double>::infinity();  ///< held-out squares at low resolution
  double next_ = 0;                                                  ///< what may be added before a line
  std::vector<CandidateResult> out_;
  std::vector<SearchStart> search_starts_;
  std::vector<double> at_low_;  ///< held-out squares at low resolution
  std::vector<bool> judged_finely_;
};

CandidateScreening::CandidateScreening(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                       const std::vector<Candidate>& candidates, const Limits& least,
                                       const Trial* to_beat)
    : context_(context),
      top_(top),
      coarse_top_(coarse_top),
      candidates_(candidates),
      least_passing_(least),
      least_falls_(worth_fitting(context, coarse_top, top.whitening, least)) {
  const std::vector<std::string> present = top.model.effect_keys();
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (!candidates[k].untestable.empty()) continue;
    if (std::find(present.begin(), present.end(), candidates[k].info.key) != present.end()) continue;
    if (!top.model.acts_with(candidates[k].effect)) continue;
    if (to_beat != nullptr && candidates[k].info.needs_full_resolution) continue;
    out_.emplace_back().candidate = k;
  }
  if (to_beat != nullptr) {
    const double behind = limits::kWorthFitting * (coarse_top.squares - to_beat->squares);
    least_falls_ = {std::max(least_falls_.whitened, behind), std::max(least_falls_.plain, behind)};
    best_elsewhere_ = to_beat->held_out_squares;
  }
  search_starts_.resize(out_.size());
  judged_finely_.assign(out_.size(), false);
}

void CandidateScreening::judge(std::size_t t, const Level& level, const Trial& beside, const FrictionModel& model,
                               const std::vector<double>& start, int threads) {
  const std::size_t candidate = out_[t].candidate;
  const double tests = search_starts_[t].places * static_cast<double>(candidates_.size());
  out_[t] = compare(context_, level, beside, try_model(context_, level, model, start, threads), candidates_[candidate],
                    tests, least_passing_);
  out_[t].candidate = candidate;
}

void CandidateScreening::search(std::size_t t, const Level& level, const Trial& beside) {
  const FrictionModel model = with_effect(top_.model, candidates_[out_[t].candidate].effect);
  judge(t, level, beside, model, nearest_if_several(level, model, beside.whitening, search_starts_[t].starts), 1);
}

void CandidateScreening::judge_coarsely() {
  const std::vector<double> residual = residual_of(context_, top_);
  run_tasks(out_.size(), context_.threads, [&](std::size_t t) {
    const bool narrow = info(t).needs_full_resolution;
    const Level& level = narrow ? context_.fine : context_.coarse;
    const Trial& beside = narrow ? top_ : coarse_top_;
    const Candidate& candidate = candidates_[out_[t].candidate];
    search_starts_[t] = search_start_of(context_, level, beside, candidate, residual, least_falls_);
    if (!narrow && !search_starts_[t].starts.empty()) search(t, level, beside);
  });
  for (const CandidateResult& judged : out_) {
    at_low_.push_back(judged.trial.held_out_squares);
    if (judged.passes) next_ = std::max(next_, judged.fall);
  }
}

bool CandidateScreening::is_hopeless(std::size_t t, double best) const {
  const CandidateResult& judged = out_[t];
  if (info(t).needs_full_resolution) {
    // A line beside something much larger can wait: it is as clear, and sooner found, once that is out of the way.
    return search_starts_[t].starts.empty() || search_starts_[t].promised < limits::kPutOffLine * next_;
  }
  const double fallen = coarse_top_.held_out_squares - best;
  const bool small = judged.size < limits::kWorthFitting * least_passing_.least_size ||
                     (judged.p_value > limits::kHopelessChance && !judged.passes) ||
                     (judged.fall < least_falls_.whitened && judged.fall < limits::kWorthPart * fallen);
  const bool far = is_far_behind(context_, at_low_[t] - best, fallen);
  return !judged.by_level && (far || judged.fall < 0 || small);
}

bool CandidateScreening::judge_promising() {
  double best = std::min(coarse_top_.held_out_squares, best_elsewhere_);
  for (std::size_t t = 0; t < out_.size(); ++t) {
    if (out_[t].trial.usable && out_[t].plausible && !info(t).needs_full_resolution) best = std::min(best, at_low_[t]);
  }
  std::vector<std::size_t> promising;
  for (std::size_t t = 0; t < out_.size(); ++t) {
    if (judged_finely_[t] || (!out_[t].trial.usable && !info(t).needs_full_resolution)) continue;
    out_[t].hopeless = is_hopeless(t, best);
    if (!out_[t].hopeless) promising.push_back(t);
  }
  run_tasks(promising.size(), context_.threads, [&](std::size_t k) {
    const std::size_t t = promising[k];
    if (info(t).needs_full_resolution) return search(t, context_.fine, top_);
    Trial coarse = std::move(out_[t].trial);
    judge(t, context_.fine, top_, coarse.model, coarse.p, context_.threads_each(promising.size()));
    coarse.evidence = coarse.plain = {};  // large, and not asked for again
    out_[t].coarse = std::move(coarse);
  });
  for (const std::size_t t : promising) judged_finely_[t] = true;
  return !promising.empty();
}

std::vector<CandidateResult> CandidateScreening::result() && {
  for (CandidateResult& judged : out_) judged.passes = judged.passes && !judged.hopeless;
  return std::move(out_);
}

}  // namespace

LeastFalls worth_fitting(const DiagnosisContext& context, const Trial& coarse,
                         const ModelResiduals::Whitening& whitening, const Limits& least) {
  const auto enough = [&](double floor, double squares) {
    return std::max(limits::kWorthFitting * least.least_size * floor, limits::kWorthPart * (squares - floor));
  };
  return {enough(context.noise_squares(), coarse.squares),
          enough(context.floor_squares(whitening), coarse.plain_squares)};
}

bool is_far_behind(const DiagnosisContext& context, double behind, double fallen) {
  return behind > limits::kFarPart * fallen + limits::kFarNoise * context.noise_squares();
}

std::vector<CandidateResult> judge_all(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                       const std::vector<Candidate>& candidates, const Limits& least,
                                       const Trial* to_beat) {
  CandidateScreening screening(context, top, coarse_top, candidates, least, to_beat);
  screening.judge_coarsely();
  // Which turn out implausible at full resolution stand before the others no longer, and those get their turn.
  while (screening.judge_promising()) {
  }
  return std::move(screening).result();
}

}  // namespace tribofit::diagnosis
