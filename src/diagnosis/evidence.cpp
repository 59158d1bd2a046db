#include "evidence.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "fit/spectral_lines.hpp"
#include "fit/starts.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::diagnosis {

namespace {

std::span<const double> numbers_of(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// Degrees of freedom of a variance of what correlates between cycles: see standard_error_of_mean().
double few_frequencies(std::size_t cycles) {
  return std::max(3.0, 0.4 * std::pow(static_cast<double>(cycles), 2.0 / 3));
}

/// Squares of all cycles at their minimum.
double least_squares_of(const CycleEvidence& evidence, const std::vector<bool>& free) {
  return sum(squares_after(evidence, gauss_newton_step(evidence, free)));
}

/// Of the parameters of an effect.
DesignEffect design_effect_of(const CycleEvidence& evidence, const Trial& trial, const EffectInfo& info, double noise) {
  return design_effect(evidence, trial.free, trial.model.offset_of(info.key), trial.model.count_of(info.key), noise,
                       slow_noise_of(evidence));
}

/// One at the least.
std::size_t free_parameters_of(const Trial& trial, const EffectInfo& info) {
  const auto first = trial.free.begin() + static_cast<std::ptrdiff_t>(trial.model.offset_of(info.key));
  const auto count = std::count(first, first + static_cast<std::ptrdiff_t>(trial.model.count_of(info.key)), true);
  return std::max<std::size_t>(1, static_cast<std::size_t>(count));
}

}  // namespace

DesignEffect design_effect(const CycleEvidence& evidence, const std::vector<bool>& free, std::size_t first,
                           std::size_t count, double noise, const SlowNoise& slow) {
  DesignEffect out;
  if (!(noise > 0)) return out;
  const Eigen::MatrixXd directions = known_directions(evidence.total, free);
  const auto cycles = static_cast<Eigen::Index>(evidence.gradient.size());
  for (std::size_t k = first; k < first + count; ++k) {
    // Row of the inverse curvature.
    const Eigen::VectorXd inverse = directions * directions.row(static_cast<Eigen::Index>(k)).transpose();
    const double independent = noise * inverse(static_cast<Eigen::Index>(k));
    if (!free[k] || !(independent > 0)) continue;
    // By what each cycle leaves, and by a change of its level.
    Eigen::VectorXd influence(cycles), pull = Eigen::VectorXd::Zero(slow.covariance.empty() ? 0 : cycles);
    for (Eigen::Index c = 0; c < cycles; ++c) {
      const auto i = static_cast<std::size_t>(c);
      influence(c) = static_cast<double>(cycles) * inverse.dot(evidence.gradient[i]);
      if (pull.size() > 0) pull(c) = inverse.dot(evidence.curvature[i] * evidence.level);
    }
    const double error = standard_error_of_mean(numbers_of(influence)).std_error;
    out.of_cycles = std::max(out.of_cycles, error * error / independent);
    out.of_slow = std::max(out.of_slow, 1 + slow.variance_of_sum(numbers_of(pull)) / independent);
  }
  return out;
}

double fall_p_value(double fall, std::size_t parameters, double noise, double design_effect, double freedom) {
  if (!(fall > 0) || !(noise > 0)) return 1;
  const auto k = static_cast<double>(parameters);
  return f_p_value(fall / (k * noise * design_effect), k, std::max(1.0, freedom));
}

namespace {

/// The data draw a parameter that is on its bound beyond it: a tenth of its range inside, the others following, the
/// squares are larger than chance would make them. q: the parameter on the scale of the record.
bool is_drawn_beyond(const Trial& trial, std::size_t k, const Parameter& q, double chance) {
  const double range = (q.upper - q.lower) * q.si, middle = 0.5 * (q.upper + q.lower) * q.si;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(trial.p.size()));
  step(static_cast<Eigen::Index>(k)) = limits::kInside * range * (trial.p[k] > middle ? -1 : 1);
  const double rise =
      least_squares_of(moved(trial.evidence, step), trial.free) - least_squares_of(trial.evidence, trial.free);
  return rise > limits::kDeclaredSigmas * limits::kDeclaredSigmas * chance;
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
  const double design = design_effect_of(trial.plain, trial, info, noise).largest();
  return fall_p_value(fall, free_parameters_of(trial, info), noise, design, few_frequencies(trial.held_out.size()));
}

}  // namespace

namespace {

/// By how much slow noise makes two shapes of friction differ more than independent noise would: the largest design
/// effect of what no change of level can do.
double slow_design(const DiagnosisContext& context, const Trial& trial) {
  const SlowNoise slow = slow_noise_of(trial.evidence);
  if (slow.covariance.empty()) return 1;
  const double noise = noise_of(context.fine, trial);
  double largest = 1;
  for (std::size_t k = 0; k < trial.p.size(); ++k) {
    if (trial.evidence.level(static_cast<Eigen::Index>(k)) != 0) continue;
    largest = std::max(largest, design_effect(trial.evidence, trial.free, k, 1, noise, slow).of_slow);
  }
  return largest;
}

}  // namespace

double size_of_fall(const DiagnosisContext& context, const Trial& poorer, const Trial& richer) {
  return std::max((poorer.held_out_squares - richer.held_out_squares) / context.noise_squares(),
                  (poorer.plain_squares - richer.plain_squares) / context.floor_squares(richer.whitening));
}

bool beats(const DiagnosisContext& context, const Trial& first, const Trial& second) {
  if (!first.usable || !second.usable) return first.usable;
  const std::size_t own = first.p.size(), other = second.p.size();
  const double more = own > other ? static_cast<double>(own - other) : 0;
  const double least = std::max(limits::kDistinguishableSize, limits::kSizeOfParameter * more);
  const double fall = second.held_out_squares - first.held_out_squares;
  if (!(fall > 0) || !(size_of_fall(context, second, first) > least)) return false;
  const bool longer = first.model.effects().size() > second.model.effects().size();
  if (longer && !(first.plain_held_out < second.plain_held_out)) return false;
  // Few speeds that are held for long leave few independent losses, however large.
  return paired_p_value(second, first) < limits::kChance ||
         fall > limits::kDistinguishable * noise_of(context.fine, first) * slow_design(context, first);
}

CandidateResult compare(const DiagnosisContext& context, const Level& level, const Trial& poorer, Trial richer,
                        const Candidate& candidate, double tests, const Limits& least) {
  const EffectInfo& info = candidate.info;
  CandidateResult out;
  out.trial = std::move(richer);
  const Trial& trial = out.trial;
  if (!trial.usable) return out;
  const double noise = noise_of(level, trial);
  const DesignEffect design = design_effect_of(trial.evidence, trial, info, noise);
  const std::size_t parameters = free_parameters_of(trial, info);
  out.design_effect = design.largest();
  // The noise is known from all cycles where neighbours are independent, and from few frequencies where they are not. A
  // line stands among as many frequencies as it likes.
  const std::size_t cycles = trial.held_out.size();
  const bool few = out.design_effect > limits::kCorrelated && !info.needs_full_resolution;
  const double known = std::max(3.0, static_cast<double>(cycles) / 3), freedom = few ? few_frequencies(cycles) : known;
  const double fall = poorer.squares - trial.squares;
  const double of_squares = fall_p_value(fall, parameters, noise, out.design_effect, freedom);
  out.fall = poorer.held_out_squares - trial.held_out_squares;
  const double floor = context.floor_squares(trial.whitening);
  out.size = size_of_fall(context, poorer, trial);
  out.plausible = is_plausible(context, trial, candidate, noise * out.design_effect);
  // Where few sticks were recorded, what goes with the stick time goes with time.
  const auto& slips = level.observations.slips;
  const auto breaks = std::count_if(slips.begin(), slips.end(), [](const auto& slip) { return slip.from_stick; });
  const bool has_level = info.needs.stick_time && breaks >= limits::kBreakAwaysOfStickSlip;
  // A line is one among many frequencies: its cycles are no evidence beside that of its own frequency.
  // Slow noise is predicted by what changes slowly, on held-out cycles too: their losses are no evidence against it.
  const double of_slow = fall_p_value(fall, parameters, noise, design.of_slow, known);
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

Eigen::VectorXd judge_probe(const DiagnosisContext& context, const Level& level, const Trial& trial,
                            const ModelResiduals::FurtherColumns& columns, double places, Probe& probe) {
  stop_point();
  const Observations& observations = level.observations;
  const std::vector<std::size_t> all = all_slips(observations);
  ModelResiduals residuals(trial.model, observations, all);
  residuals.weaken_stick(trial.whitening.stick);
  if (trial.whitening.any()) residuals.whiten(trial.whitening);
  CycleEvidence wide = evidence_of(residuals.white_rows(trial.p.data(), columns));
  if (!wide.finite) return {};
  const auto width = static_cast<std::size_t>(wide.total.rows()), own = trial.p.size();
  std::vector<bool> free = trial.free;
  free.resize(width, true);
  wide.level = Eigen::VectorXd::Zero(trial.evidence.level.size() > 0 ? wide.total.rows() : 0);
  wide.level.head(trial.evidence.level.size()) = trial.evidence.level;
  wide.known_flicker = trial.evidence.known_flicker;
  const Eigen::VectorXd step = gauss_newton_step(wide, free);
  const double before = least_squares_of(trial.evidence, trial.free);
  probe.fall = trial.row_held_out_squares - sum(held_out_squares(wide, free, context.blocks));
  ModelResiduals plain(trial.model, observations, all);
  plain.weaken_stick(trial.whitening.stick);
  const CycleEvidence flat = evidence_of(plain.white_rows(trial.p.data(), columns));
  const double fall = trial.plain_squares - (least_squares_of(flat, free) - trial.stick.rigid);
  probe.size = std::max(probe.fall / context.noise_squares(), fall / context.floor_squares(trial.whitening));
  wide = moved(std::move(wide), step);
  const double after = sum(wide.squares), noise = (after - trial.stick.left) / level.values;
  const double design = design_effect(wide, free, own, width - own, noise, slow_noise_of(wide)).largest();
  const double freedom = few_frequencies(wide.squares.size());
  probe.p_value = std::min(1.0, places * fall_p_value(before - after, width - own, noise, design, freedom));
  return step.tail(static_cast<Eigen::Index>(width - own));
}

}  // namespace tribofit::diagnosis
