#include "judging.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/spectral_lines.hpp"
#include "fit/starts.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/parallel.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::diagnosis {

namespace {

/// The data draw a parameter that is on its bound beyond it: a tenth of its range inside, the others following, the
/// squares are larger than chance would make them. q: the parameter on the scale of the record.
bool is_drawn_beyond(const Trial& trial, std::size_t k, const Parameter& q, double least_squares) {
  const double range = (q.upper - q.lower) * q.si, middle = 0.5 * (q.upper + q.lower) * q.si;
  Linearised inside = trial.linear;
  const double before = sum(squares_after(inside, gauss_newton_step(inside)));
  const double step = limits::kInside * range * (trial.p[k] > middle ? -1 : 1);
  for (Eigen::MatrixXd& rows : inside.rows) rows.col(rows.cols() - 1) += rows.col(static_cast<Eigen::Index>(k)) * step;
  return sum(squares_after(inside, gauss_newton_step(inside))) - before >
         limits::kDrawnSigmas * limits::kDrawnSigmas * least_squares;
}

/// On its bound the size of an effect, or a time, length or frequency without which it is another effect, is not what
/// the effect says, where the data draw it there. noise: variance of a residual, correlation counted.
bool is_plausible(const DiagnosisContext& context, const Trial& trial, const Candidate& candidate, double noise) {
  const EffectInfo& info = candidate.info;
  const std::size_t offset = trial.model.offset_of(info.key);
  if (candidate.allowed && !candidate.allowed->holds(trial.p[offset])) return false;
  for (std::size_t k = 0; k < info.parameters.size(); ++k) {
    const Parameter q = on_scale_of(info.parameters[k], context.fine.observations);
    const bool decisive = k == 0 || q.decisive;
    const bool away =
        k == 0 && std::abs(trial.p[offset] - q.neutral * q.si) > limits::kAwayFromNone * (q.upper - q.lower) * q.si;
    const bool flat = away && trial.at_bound[offset] && !is_drawn_beyond(trial, offset, q, noise);
    if (decisive && trial.at_bound[offset + k] && !flat) return false;
    // What stands at the far end of its range is asked for more than the effect can be.
    const bool far =
        std::abs(trial.p[offset + k] - q.neutral * q.si) > limits::kAwayFromNone * (q.upper - q.lower) * q.si;
    if (!decisive && !q.periodic && far && trial.at_bound[offset + k]) return false;
    const Observations& seen = context.fine.observations;
    const double slowest = q.search == ParameterSearch::ringing_line  ? lowest_ringing(seen)
                           : q.search == ParameterSearch::steady_line ? lowest_steady_line(seen)
                                                                      : 0;
    if (slowest > 0 && trial.p[offset + k] < slowest) return false;
    const bool at_an_end =
        q.search == ParameterSearch::moment_of_change && !is_amid_slips(context.fine.observations, trial.p[offset + k]);
    if (at_an_end) return false;
  }
  return true;
}

/// The larger of the design effects of the free parameters of an effect, and how many of them there are.
struct Added {
  DesignEffect design;
  std::size_t free = 0;

  double design_effect() const { return std::max(design.of_cycles, design.of_slow); }
};

Added added_by(const Linearised& linear, std::size_t offset, std::size_t count, double noise) {
  Added out;
  const SlowNoise slow = slow_noise_of(linear);
  for (const DesignEffect& own : design_effects(linear, offset, count, noise, slow)) {
    out.design.of_cycles = std::max(out.design.of_cycles, own.of_cycles);
    out.design.of_slow = std::max(out.design.of_slow, own.of_slow);
  }
  for (std::size_t k = offset; k < offset + count; ++k) out.free += linear.free[k] ? 1U : 0U;
  out.free = std::max<std::size_t>(1, out.free);
  return out;
}

/// That the held-out losses of the cycles fall by chance: their differences, cycle by cycle, with a long-run variance.
/// A second effect that is missing too makes what is left look correlated, which the F test counts against every
/// candidate; what both models leave alike is not in the differences.
double paired_p_value(const Trial& poorer, const Trial& richer) {
  if (poorer.held_out.size() != richer.held_out.size()) return 1;
  std::vector<double> falls(richer.held_out.size());
  for (std::size_t c = 0; c < falls.size(); ++c) falls[c] = poorer.held_out[c] - richer.held_out[c];
  const Estimate fall = mean_with_error(falls);
  if (!(fall.value > 0) || !(fall.std_error > 0)) return 1;
  return 0.5 * t_p_value(fall.value / fall.std_error, fall.degrees_of_freedom);
}

/// The same for an effect of the stick time, which explains what otherwise is scatter of break-away from cycle to
/// cycle.
///
/// The whitened squares take that scatter for what it is from one cycle to the next; where it wanders, an effect that
/// acts on the level of single cycles (a longer stick after a pause) may explain much of it and lower them little.
/// Here the squares themselves are compared, with the correlation between cycles as it is.
double level_p_value(const Level& level, const Trial& poorer, const Trial& trial, const EffectInfo& info,
                     double floor) {
  const double fall = poorer.plain_minimum - trial.plain_minimum;
  if (poorer.plain_held_out - trial.plain_held_out <= limits::kLeastSizeOfLevel * floor) return 1;
  const double noise = (trial.plain_minimum + trial.stick.rigid - trial.stick.left) / level.values;
  const Added added = added_by(trial.plain, trial.model.offset_of(info.key), trial.model.count_of(info.key), noise);
  const double freedom = few_frequencies(static_cast<double>(trial.plain.rows.size()));
  return fall_p_value(fall, added.free, noise, added.design_effect(), freedom);
}

}  // namespace

CandidateResult compare(const DiagnosisContext& context, const Level& level, const Trial& poorer, Trial richer,
                        const Candidate& candidate, double tests, const Limits& least) {
  const EffectInfo& info = candidate.info;
  CandidateResult out;
  out.trial = std::move(richer);
  const Trial& trial = out.trial;
  if (!trial.usable) return out;
  const double noise = noise_of(level, trial);
  const Added added = added_by(trial.linear, trial.model.offset_of(info.key), trial.model.count_of(info.key), noise);
  out.design_effect = added.design_effect();
  // The noise is known from all cycles where neighbours are independent, and from few frequencies where they are not. A
  // line stands among as many frequencies as it likes.
  const auto cycles = static_cast<double>(trial.held_out.size());
  const bool few = out.design_effect > limits::kCorrelated && !info.needs_full_resolution;
  const double known = std::max(3.0, cycles / 3), freedom = few ? few_frequencies(cycles) : known;
  const double fall = poorer.squares - trial.squares;
  const double of_squares = fall_p_value(fall, added.free, noise, out.design_effect, freedom);
  out.fall = poorer.held_out_squares - trial.held_out_squares;
  const double floor = context.floor_squares(trial.whitening);
  out.size = std::max(out.fall / context.noise_squares(), (poorer.plain_squares - trial.plain_squares) / floor);
  out.plausible = is_plausible(context, trial, candidate, noise * out.design_effect);
  // Where few sticks were recorded, what goes with the stick time goes with time.
  const auto& slips = level.observations.slips;
  const auto breaks = std::count_if(slips.begin(), slips.end(), [](const auto& slip) { return slip.from_stick; });
  const bool has_level = info.needs.stick_time && breaks >= limits::kBreakAwaysOfStickSlip;
  // A line is one among many frequencies: its cycles are no evidence beside that of its own frequency.
  // Slow noise is predicted by what changes slowly, on held-out cycles too: their losses are no evidence against it.
  const double of_slow = fall_p_value(fall, added.free, noise, added.design.of_slow, known);
  const double of_pairs = info.needs_full_resolution ? 1 : std::max(of_slow, paired_p_value(poorer, trial));
  const double of_level = has_level ? level_p_value(level, poorer, trial, info, floor) : 1;
  const double views = 1 + (info.needs_full_resolution ? 0 : 1) + (has_level ? 1 : 0);
  const double of_cycles = std::min(of_squares, of_pairs);
  out.p_value = std::min(1.0, views * tests * std::min(of_cycles, of_level));
  out.by_level = of_level < of_cycles && !(out.fall > 0 && views * tests * of_cycles < least.p_value);
  const bool lower = trial.plain_held_out < poorer.plain_held_out && (out.fall > 0 || out.by_level);
  out.passes = out.plausible && lower && out.size > least.least_size && out.p_value < least.p_value;
  out.by_level = out.by_level && out.passes;
  return out;
}

namespace {

/// Every testable candidate beside the top of a ladder, judged first at low resolution and then, those that may lead
/// or be in the leader's group, at full resolution.
class CandidateScreening {
 public:
  CandidateScreening(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                     const std::vector<Candidate>& candidates, const Limits& least);

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
  const LeastFalls least_falls_;
  double next_ = 0;  ///< what may be added before a line
  std::vector<CandidateResult> out_;
  std::vector<SearchStart> search_starts_;
  std::vector<double> at_low_;  ///< held-out squares at low resolution
  std::vector<bool> judged_finely_;
};

CandidateScreening::CandidateScreening(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                       const std::vector<Candidate>& candidates, const Limits& least)
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
    out_.emplace_back().candidate = k;
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
  double best = coarse_top_.held_out_squares;
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
    coarse.linear = coarse.plain = {};  // large, and not asked for again
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
                                       const std::vector<Candidate>& candidates, const Limits& least) {
  CandidateScreening screening(context, top, coarse_top, candidates, least);
  screening.judge_coarsely();
  // Which turn out implausible at full resolution stand before the others no longer, and those get their turn.
  while (screening.judge_promising()) {
  }
  return std::move(screening).result();
}

}  // namespace tribofit::diagnosis
