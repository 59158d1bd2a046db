#include "tribofit/fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "cross_validation.hpp"
#include "errors.hpp"
#include "estimate.hpp"
#include "influence.hpp"
#include "limits.hpp"
#include "messages.hpp"
#include "parameter_errors.hpp"
#include "points.hpp"
#include "profile.hpp"
#include "stick.hpp"
#include "systematic.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit {

namespace {

/// Means over the records, in squares.
Floor mean_floor(std::span<const Record> records) {
  Floor floor = estimate_floor(*records[0].motion, *records[0].segmentation);
  if (records.size() == 1) return floor;
  const auto count = static_cast<double>(records.size());
  double noise = floor.noise * floor.noise, scatter = floor.scatter * floor.scatter;
  for (std::size_t r = 1; r < records.size(); ++r) {
    const Floor next = estimate_floor(*records[r].motion, *records[r].segmentation);
    noise += next.noise * next.noise;
    scatter += next.scatter * next.scatter;
  }
  floor.noise = std::sqrt(noise / count);
  floor.scatter = std::sqrt(scatter / count);
  return floor;
}

FitContext context_of(const FrictionModel& model, std::span<const Record> records, const Observations& observations,
                      const Instruments& instruments, const FitOptions& options) {
  FitContext context{model, records, observations, instruments, options};
  context.bounds = bounds_of(model, observations);
  apply_given(model, options.given, context.bounds);
  context.given = context.bounds;
  if (options.loss != Loss::squares) context.loss = {options.loss, options.loss_scale * mean_floor(records).noise};
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

/// What the model leaves may be 1/f noise, and is not rather of another kind, which may be a cause that was not
/// recorded.
bool is_slow_sensor_noise(const SlowNoise& slow) {
  return slow.is_flicker && !slow.is_rather_other;
}

/// Standard deviation of 1/f noise over longer times than sensor noise was taken over; 0 where there is none.
double slow_noise_beyond_stretches(const SampleErrors& errors) {
  const SlowNoise slow = slow_noise(errors.levels);
  if (!is_slow_sensor_noise(slow)) return 0;
  const std::size_t stretch = errors.levels_per_noise_stretch;
  const std::vector<double> mean(stretch, 1 / static_cast<double>(stretch));
  const double within_stretch = slow.covariance[0] - slow.variance_of_sum(mean);
  // What a fit takes away at low frequencies is not left.
  double squares = 0;
  for (const double level : errors.levels) squares += level * level / static_cast<double>(errors.levels.size());
  return std::sqrt(std::clamp(slow.variance_within() - within_stretch, 0.0, squares));
}

/// The same from one slip to the next, beside the scatter of break-away: slips are far apart, and what 1/f noise does
/// within them is known from the stick.
///
/// 1/f noise has as much in every octave, and those that the stick shows bound what it has over longer times: friction
/// that wanders by more from slip to slip does so itself.
double slow_noise_between_slips(const FitContext& context, const std::vector<double>& p,
                                const NormalEquations& equations, const std::vector<bool>& free) {
  if (context.records.size() > 1) return 0;  // levels of their own are no noise
  const SlowLevels slow = slow_levels(equations, level_change(context.model, p), free);
  if (!is_slow_sensor_noise(slow.noise)) return 0;
  const Observations& data = context.observations;
  double squares = 0, weights = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    squares += data.weight[i] * data.friction[i] * data.friction[i];
    weights += data.weight[i];
  }
  const auto& [motion, segmentation] = context.records[0];
  const FlickerInStick flicker = flicker_in_stick(*motion, *segmentation);
  if (!(flicker.variance > 0)) return 0;
  const double seen = kPartBesideParabola * flicker.samples;
  const double most = flicker.variance * std::log(std::max(1.0, static_cast<double>(motion->size()) / seen));
  return std::sqrt(std::min(most, std::min(slow.noise.variance_within(), slow.mean_square) * squares / weights));
}

/// What a fit with so many parameters leaves of points, as one value: their noise is no larger, though points that are
/// far apart in speed differ by more.
double noise_beside(const Fit& fit, std::size_t parameters) {
  const auto count = static_cast<double>(fit.observations), left = count - static_cast<double>(parameters);
  return fit.error.rmse * std::sqrt(count / std::max(1.0, left));
}

void fill_floor(const FitContext& context, const std::vector<double>& p, const NormalEquations& equations,
                const std::vector<bool>& free, const SampleErrors& errors, Fit& fit) {
  Floor floor = mean_floor(context.records);
  const double count = std::accumulate(errors.counts.begin(), errors.counts.end(), 0.0);
  const ModelResiduals::Whitening whitening =
      context.whitening.part > 0 ? context.whitening
                                 : context.residuals(all_slips(context.observations)).whitening_at(p.data());
  double sensitivity = 0;  // sum of squares of d model/d mu_s over the samples
  for (const Eigen::VectorXd& g : whitening.g) sensitivity += g.squaredNorm();
  const double scatter = std::pow(floor.scatter, 2) * sensitivity / std::max(1.0, count);
  const bool sticks = std::any_of(context.records.begin(), context.records.end(), [](const Record& record) {
    return record.segmentation->kind != MotionKind::always_slipping;
  });
  const bool points = are_points(context.records);
  if (points) floor.noise = std::min(floor.noise, noise_beside(fit, p.size()));
  if (!points) {
    floor.slow_noise =
        sticks ? slow_noise_between_slips(context, p, equations, free) : slow_noise_beyond_stretches(errors);
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
void fill_errors_of_records(const FitContext& context, const std::vector<double>& p, const std::vector<bool>& free,
                            Fit& fit) {
  const std::vector<double> systematic = systematic_errors(context.model, p, context.records, context.observations,
                                                           context.instruments, free, context.by_extremes());
  for (std::size_t k = 0; k < p.size(); ++k) fit.parameters[k].systematic = systematic[k];
  const std::vector<double> smoothing =
      smoothing_errors(context.model, p, context.records, context.observations, free, context.by_extremes());
  for (std::size_t k = 0; k < p.size(); ++k) widen(smoothing[k], fit.parameters[k]);
  const Record& record = context.records[0];
  if (context.records.size() == 1 && context.model.acts_in_stick())
    fit.stick_rmse = stick_creep_rmse(context.model, p, *record.motion, *record.segmentation);
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
  const Solution solution = estimate(context, fit);
  if (!solution.has_levels) return fit;
  const std::vector<double>& p = solution.values();

  const ModelResiduals residuals = context.residuals(all_slips(observations));
  const NormalEquations equations = normal_equations(residuals, observations, p);
  if (!equations.finite) {
    return failed_fit(std::move(fit),
                      "the model is not finite on these data: an effect or formula divides by zero, "
                      "overflows or leaves its domain");
  }
  const Freedom freedom = freedom_of(context, p, equations);
  fill_parameters(context, solution, equations, freedom, fit);

  const SampleErrors errors = sample_errors(model, p, FullRecord(records, observations, model.needs()), observations);
  fill_errors(errors, fit);
  fill_floor(context, p, equations, freedom.inside, errors, fit);
  cross_validate(context, solution, equations, freedom.inside, errors, fit);
  fill_errors_of_records(context, p, freedom.inside, fit);
  if (!context.by_extremes()) {
    const Eigen::MatrixXd inverse = inverse_over(equations.total, freedom.inside);
    open_whole_ranges(residuals, context.given, inverse, fit);
    if (options.profile) add_profiles(residuals, context.given, inverse, fit);
  }
  add_messages(freedom.unconstrained, freedom.groups, fit);
  return fit;
}

}  // namespace tribofit
