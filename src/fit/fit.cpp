#include "tribofit/fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "stick_evidence.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// Means over the records, in squares.
Floor mean_floor(const std::vector<RecordNoise>& records) {
  Floor floor = floor_of(records[0]);
  if (records.size() == 1) return floor;
  const auto count = static_cast<double>(records.size());
  double noise = floor.noise * floor.noise, scatter = floor.scatter * floor.scatter;
  double sampling = floor.sampling * floor.sampling;
  for (std::size_t r = 1; r < records.size(); ++r) {
    const Floor next = floor_of(records[r]);
    noise += next.noise * next.noise;
    scatter += next.scatter * next.scatter;
    sampling += next.sampling * next.sampling;
  }
  floor.noise = std::sqrt(noise / count);
  floor.sampling = std::sqrt(sampling / count);
  floor.scatter = std::sqrt(scatter / count);
  return floor;
}

FitContext context_of(const FrictionModel& model, std::span<const Record> records, const Observations& observations,
                      const Instruments& instruments, const FitOptions& options) {
  FitContext context{model, records, observations, instruments, options};
  context.bounds = bounds_of(model, observations);
  apply_given(model, options.given, context.bounds);
  context.given = context.bounds;
  context.evaluation.threads = options.threads;
  if (options.loss != Loss::squares) {
    context.evaluation.loss = options.loss;
    context.evaluation.loss_width = options.loss_scale * mean_floor(observations.noise).noise;
  }
  return context;
}

/// A fit of which only the data are known.
Fit empty_fit(const FrictionModel& model, Protocol protocol, const Observations& observations) {
  Fit fit;
  fit.model = model;
  fit.protocol = protocol;
  fit.cycles = observations.cycles;
  fit.fastest = observations.fastest;
  fit.slowest = observations.slowest;
  fit.mean_load = observations.mean_load;
  fit.mean_temperature = observations.mean_temperature;
  for (const auto& slip : observations.slips) {
    fit.disc_speed += slip.disc_speed / static_cast<double>(observations.slips.size());
  }
  fit.stick_rmse = std::numeric_limits<double>::quiet_NaN();
  return fit;
}

Fit failed_fit(Fit fit, const std::string& why) {
  fit.messages.insert(fit.messages.begin(), why);
  fit.converged = false;
  return fit;
}

/// Starts that were given beyond the bounds.
void report_moved_starts(const FitContext& context, Fit& fit) {
  for (std::size_t k = 0; k < context.model.parameters().size(); ++k) {
    const FrictionModel::Slot& slot = context.model.parameters()[k];
    for (const GivenParameter& known : context.options.given) {
      if (!known.start || known.name != slot.full_name()) continue;
      if (*known.start >= context.bounds.lower[k] && *known.start <= context.bounds.upper[k]) continue;
      fit.messages.push_back("the start given for " + known.name +
                             " is outside its bounds; the search began on the nearer bound");
    }
  }
}

void fill_errors(const SampleErrors& errors, Fit& fit) {
  fit.error = errors.figures;
  fit.constant_rmse = errors.constant_rmse;
  fit.observations = static_cast<std::size_t>(std::accumulate(errors.counts.begin(), errors.counts.end(), 0.0));
}

/// Standard deviation of 1/f noise over longer times than sensor noise was taken over, up to the record. 1/f noise has
/// as much in every e-fold of time, and those in which no law has to be right bound what it has over longer times:
/// friction that wanders by more does so itself. left: variance of what a model leaves beside other noise; what a fit
/// takes away at low frequencies is not left.
double slow_sensor_noise(std::span<const Record> records, const Observations& observations, double left) {
  double variance = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const FlickerNoise& flicker = observations.noise[r].flicker;
    if (!(flicker.power > 0)) continue;
    const double times = static_cast<double>(records[r].motion->size()) / (kPartBesideParabola * flicker.samples);
    variance += 2 * flicker.power * std::log(std::max(1.0, times)) / static_cast<double>(records.size());
  }
  return std::sqrt(std::clamp(variance, 0.0, std::max(0.0, left)));
}

/// What a fit with so many parameters leaves of points, as one value: their noise is no larger, though points that are
/// far apart in speed differ by more.
double noise_beside(const Fit& fit, std::size_t parameters) {
  const auto count = static_cast<double>(fit.observations), left = count - static_cast<double>(parameters);
  return fit.error.rmse * std::sqrt(count / std::max(1.0, left));
}

void fill_floor(const FitContext& context, const std::vector<double>& p, const SampleErrors& errors, Fit& fit) {
  Floor floor = mean_floor(context.observations.noise);
  const double count = std::accumulate(errors.counts.begin(), errors.counts.end(), 0.0);
  ModelResiduals::Whitening here;
  if (!context.whitening.any()) here = context.residuals(all_slips(context.observations)).whitening_at(p.data());
  const ModelResiduals::Whitening& whitening = context.whitening.any() ? context.whitening : here;
  double sensitivity = 0;  // sum of squares of d model/d mu_s over the samples
  for (const Eigen::VectorXd& g : whitening.g) sensitivity += g.squaredNorm();
  // Break-away scatters with the level too: that part of it is not counted twice.
  double model_squares = 0, break_away = 0;
  for (const Eigen::VectorXd& u : whitening.u) model_squares += u.squaredNorm();
  for (const auto& slip : context.observations.slips) {
    if (slip.from_stick) break_away = std::max(break_away, std::pow(slip.break_away_friction, 2));
  }
  const double level = whitening.slow * whitening.noise, own = std::pow(floor.scatter, 2) - level * break_away;
  floor.level_scatter = std::sqrt(level);
  const double scatter = (std::max(0.0, own) * sensitivity + level * model_squares) / std::max(1.0, count);
  const bool points = are_points(context.records);
  if (points) floor.noise = std::min(floor.noise, noise_beside(fit, p.size()));
  if (!points) {
    floor.slow_noise = slow_sensor_noise(context.records, context.observations,
                                         std::pow(fit.error.rmse, 2) - std::pow(floor.noise, 2) - scatter);
  }
  floor.rmse = std::sqrt(std::pow(floor.noise, 2) + std::pow(floor.slow_noise, 2) + scatter);
  set_floor(floor, fit);
}

/// Adds an error that all cycles share to those from cycle to cycle.
void widen(double error, FitParameter& p) {
  if (!(error > 0) || !std::isfinite(p.std_error)) return;
  const bool positive = p.lower95 >= 0;
  p.upper95 = p.value + std::hypot(p.upper95 - p.value, kNormalQuantile95 * error);
  p.lower95 = p.value - std::hypot(p.value - p.lower95, kNormalQuantile95 * error);
  if (positive) p.lower95 = std::max(p.lower95, 0.0);
  p.std_error = std::hypot(p.std_error, error);
}

/// What the declared instruments make uncertain, and of one record the creep in stick.
void fill_errors_of_records(const FitContext& context, const std::vector<bool>& free, Fit& fit) {
  const std::vector<double>& p = context.minimum.p;
  const std::vector<double> systematic = systematic_errors(context, free), smoothing = smoothing_errors(context, free);
  for (std::size_t k = 0; k < p.size(); ++k) fit.parameters[k].systematic = systematic[k];
  for (std::size_t k = 0; k < p.size(); ++k) widen(smoothing[k], fit.parameters[k]);
  const Record& record = context.records[0];
  if (context.records.size() == 1 && context.model.acts_in_stick())
    fit.stick_rmse = stick_creep_rmse(context.model, p, *record.motion, *record.segmentation);
}

/// What sampling leaves is noise that all cycles share.
void widen_by_sampling(const Eigen::MatrixXd& inverse, Fit& fit) {
  const double shared = fit.floor.sampling * std::sqrt(static_cast<double>(fit.cycles));
  for (std::size_t k = 0; k < fit.parameters.size(); ++k)
    widen(shared * std::sqrt(inverse(Eigen::Index(k), Eigen::Index(k))), fit.parameters[k]);
}

/// Why a model cannot be fitted to these data; empty where it can.
std::string refusal(const FrictionModel& model, const Observations& observations, Protocol protocol) {
  if (observations.cycles < kFewestCycles)
    return "there are fewer than three cycles: no law can be fitted with an uncertainty";
  if (observations.size() <= model.parameters().size()) {
    return fmt::format("there are {} values for {} parameters: nothing is left to test", observations.size(),
                       model.parameters().size());
  }
  if (protocol == Protocol::published && !describe(model.law()).has_per_cycle_extremes())
    return "per-cycle extremes are for laws of mu_s, mu_k and at most one more parameter";
  return "";
}

}  // namespace

bool on_bound(double value, double lower, double upper) {
  const double tolerance = 1e-6 * (upper - lower);
  return lower < upper && (value <= lower + tolerance || value >= upper - tolerance);
}

std::string_view to_string(Protocol protocol) {
  return protocol == Protocol::published ? "published" : "joint";
}

std::string protocol_text(Protocol protocol) {
  return protocol == Protocol::published ? "per-cycle extremes" : "joint fit";
}

std::vector<double> Fit::values() const {
  std::vector<double> p;
  for (const FitParameter& parameter : parameters) p.push_back(parameter.value);
  return p;
}

double Fit::correlation(std::size_t first, std::size_t second) const {
  const std::size_t n = parameters.size();
  const double size = std::sqrt(covariance.at(first * n + first) * covariance.at(second * n + second));
  return size > 0 ? covariance.at(first * n + second) / size : std::nan("");
}

void set_floor(const Floor& floor, Fit& fit) {
  fit.floor = floor;
  const double above = std::pow(fit.constant_rmse, 2) - std::pow(floor.rmse, 2);
  const double left = std::pow(fit.error.rmse, 2) - std::pow(floor.rmse, 2);
  fit.explained = above > 0 ? std::clamp(1 - left / above, 0.0, 1.0) : 0;
}

Fit fit_model(const FrictionModel& model, const Motion& motion, const Segmentation& segmentation,
              const Observations& observations, const Instruments& instruments, const FitOptions& options) {
  const Record record = {&motion, &segmentation};
  return fit_model(model, std::span(&record, 1), observations, instruments, options);
}

Fit fit_model(const FrictionModel& model, std::span<const Record> records, const Observations& observations,
              const Instruments& instruments, const FitOptions& options) {
  Fit fit = empty_fit(model, options.protocol, observations);
  if (std::string why = refusal(model, observations, options.protocol); !why.empty())
    return failed_fit(std::move(fit), std::move(why));

  FitContext context = context_of(model, records, observations, instruments, options);
  report_moved_starts(context, fit);
  if (!estimate(context, fit)) return fit;
  const std::vector<double>& p = context.minimum.p;

  if (!context.at_minimum) context.at_minimum.emplace(context.residuals(all_slips(observations)));
  CycleEvidence evidence = evidence_at(*context.at_minimum, observations, p);
  if (!evidence.finite) {
    return failed_fit(std::move(fit),
                      "the model is not finite on these data: an effect or formula divides by zero, "
                      "overflows or leaves its domain");
  }
  // Several records have levels of their own, which are no noise that wanders from one to the next.
  if (records.size() == 1) evidence.level = level_change(model, p), evidence.known_flicker = observations.flicker;
  const Freedom freedom = freedom_of(context, evidence);
  fill_parameters(context, evidence, freedom, fit);

  const SampleErrors errors =
      sample_errors(model, p, FullRecord(records, observations, model.needs()), observations, options.threads);
  fill_errors(errors, fit);
  fill_floor(context, p, errors, fit);
  cross_validate(context, evidence, freedom.inside, errors, fit);
  fill_errors_of_records(context, freedom.inside, fit);
  if (!context.by_extremes()) {
    const Eigen::MatrixXd inverse = inverse_over(evidence.total, freedom.inside);
    widen_by_sampling(inverse, fit);
    if (!context.is_look()) open_whole_ranges(*context.at_minimum, context.given, inverse, fit);
    if (options.profile) add_profiles(*context.at_minimum, context.given, inverse, fit);
  }
  add_messages(freedom, fit);
  return fit;
}

}  // namespace tribofit
