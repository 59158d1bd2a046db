#include <algorithm>
#include <limits>
#include <optional>

#include "evidence.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// Part of the squares of the noise from which a difference counts.
double least_size(const DiagnosisContext& context) {
  return limits::kDistinguishableSize * context.noise_squares();
}

/// Difference of held-out squares from which two models are distinguishable. unit: noise of such a difference.
double least_difference(const DiagnosisContext& context, double unit) {
  return std::max(limits::kDistinguishable * unit, least_size(context));
}

}  // namespace

bool are_distinguishable(const DiagnosisContext& context, const CandidateResult& better, const CandidateResult& worse) {
  const double unit = noise_of(context.fine, better.trial) * better.design_effect;
  return worse.trial.held_out_squares - better.trial.held_out_squares > least_difference(context, unit);
}

namespace {

/// Of the forms of one effect one has the name: the plain one, unless the data tell another from it.
void keep_one_form(const DiagnosisContext& context, const std::vector<Candidate>& candidates,
                   std::vector<CandidateResult>& judged) {
  for (CandidateResult& form : judged) {
    const EffectInfo& info = candidates[form.candidate].info;
    if (info.option.empty() || !form.passes) continue;
    const auto plain = std::find_if(judged.begin(), judged.end(), [&](const CandidateResult& other) {
      const EffectInfo& known = candidates[other.candidate].info;
      return known.key == info.key && known.option.empty();
    });
    if (plain == judged.end() || !plain->passes) continue;
    (are_distinguishable(context, form, *plain) ? *plain : form).passes = false;
  }
}

/// Held-out squares of those that pass, less those of the best.
class Standings {
 public:
  Standings(const DiagnosisContext& context, const std::vector<CandidateResult>& judged)
      : behind_(judged.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t k = 0; k < judged.size(); ++k) {
      if (judged[k].passes && (!best_ || squares(judged, k) < squares(judged, *best_))) best_ = k;
    }
    if (!best_) return;
    for (std::size_t k = 0; k < judged.size(); ++k) {
      if (judged[k].passes) behind_[k] = squares(judged, k) - squares(judged, *best_);
    }
    judge_by(context, noise_of(context.fine, judged[*best_].trial) * judged[*best_].design_effect);
    compare_contenders(context, judged);
  }

  std::optional<std::size_t> best() const { return best_; }
  double behind(std::size_t k) const { return behind_[k]; }
  /// Noise of a difference of squares.
  double unit() const { return unit_; }
  /// It passes, and fits no worse than the best by more than chance would make them differ.
  bool is_as_good(std::size_t k) const { return behind_[k] <= least_; }

 private:
  void judge_by(const DiagnosisContext& context, double unit) {
    unit_ = unit;
    least_ = least_difference(context, unit);
  }

  static double squares(const std::vector<CandidateResult>& judged, std::size_t k) {
    return judged[k].trial.held_out_squares;
  }

  /// Those that come near the best are fitted to as many values as there are: means over a good part of the time of an
  /// effect prefer another one. Others stay as far behind as they were.
  void compare_contenders(const DiagnosisContext& context, const std::vector<CandidateResult>& judged) {
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < judged.size(); ++k) {
      const bool is_near = judged[k].fall > limits::kContenderPart * judged[*best_].fall || is_as_good(k);
      if (judged[k].passes && !judged[k].by_level && is_near) near.push_back(k);
    }
    const bool is_among = std::find(near.begin(), near.end(), *best_) != near.end();
    if (near.size() < 2 || !is_among) return;
    const Level& finest = context.finest();
    std::vector<Trial> trials(near.size());
    run_tasks(near.size(), context.threads, [&](std::size_t t) {
      const Trial& found = judged[near[t]].trial;
      trials[t] = try_model(context, finest, found.model, found.p, context.threads_each(near.size()));
      if (trials[t].usable) trials[t].held_out_squares -= squares_of_velocity_noise(finest, trials[t]);
    });
    if (!std::all_of(trials.begin(), trials.end(), [](const Trial& trial) { return trial.usable; })) return;
    const auto least = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
      return a.held_out_squares < b.held_out_squares;
    });
    best_ = near[static_cast<std::size_t>(least - trials.begin())];
    for (std::size_t t = 0; t < near.size(); ++t)
      behind_[near[t]] = trials[t].held_out_squares - least->held_out_squares;
    // The design effect is that of the fine values; noise that correlates over a few samples is smaller between single
    // ones.
    const double noise = std::max(noise_of(context.fine, judged[*best_].trial), noise_of(finest, *least));
    judge_by(context, noise * judged[*best_].design_effect);
  }

  std::optional<std::size_t> best_;
  std::vector<double> behind_;
  double unit_ = 1, least_ = 0;
};

}  // namespace

Choice choose(const DiagnosisContext& context, std::vector<CandidateResult>& judged,
              const std::vector<Candidate>& candidates) {
  keep_one_form(context, candidates, judged);
  Choice choice;
  const Standings standings(context, judged);
  choice.leader = standings.best();
  if (!choice.leader) return choice;
  for (std::size_t k = 0; k < judged.size(); ++k) choice.behind.push_back(standings.behind(k) / standings.unit());
  choice.least_by_size = least_size(context) / standings.unit();
  // The simplest of those that do as well leads.
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (!standings.is_as_good(k)) continue;
    const std::size_t now = judged[*choice.leader].trial.p.size(), other = judged[k].trial.p.size();
    const bool lower = standings.behind(k) < standings.behind(*choice.leader);
    if (other < now || (other == now && lower)) choice.leader = k;
  }
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (k != *choice.leader && standings.is_as_good(k)) choice.group.push_back(judged[k].candidate);
  }
  // What the declared uncertainty of an instrument leaves room for is no reason to name anything else.
  for (std::size_t k = 0; k < judged.size(); ++k) {
    const std::optional<AllowedRange>& allowed = candidates[judged[k].candidate].allowed;
    if (!allowed || !allowed->is_uncertainty || !standings.is_as_good(k)) continue;
    choice.leader = k;
    choice.group.clear();
  }
  return choice;
}

}  // namespace tribofit::diagnosis
