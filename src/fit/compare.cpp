#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dual.hpp"
#include "errors.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

Comparison compare_held_out(const Fit& first, const Fit& second) {
  Comparison comparison;
  const std::size_t n = std::min(first.cycle_squares.size(), second.cycle_squares.size());
  double counts = 0;
  for (std::size_t c = 0; c < n; ++c) counts += first.cycle_counts[c];
  if (n < 3 || counts <= 0) return comparison;
  // Cycles weigh by their samples, so that the mean is the difference of the mean squared errors.
  std::vector<double> difference(n);
  for (std::size_t c = 0; c < n; ++c) {
    difference[c] = (first.cycle_squares[c] - second.cycle_squares[c]) * static_cast<double>(n) / counts;
    comparison.difference += difference[c] / static_cast<double>(n);
  }
  const Estimate error = standard_error_of_mean(difference);
  comparison.std_error = error.std_error;
  if (error.std_error > 0) {
    comparison.p_value = t_p_value(comparison.difference / error.std_error, error.degrees_of_freedom);
  }
  comparison.first_better = comparison.difference < 0;
  return comparison;
}

namespace {

/// The observations of a record as the fit means them. noise: which weighs break-aways.
Observations observed_for(const Fit& fit, const Motion& motion, const Segmentation& segmentation,
                          const SensorNoise& noise) {
  Observations out = observe_motion(motion, segmentation, noise, fit.model.needs());
  refer_to_conditions_of(fit, out);
  return out;
}

}  // namespace

Fit evaluate_frozen(const Fit& fit, const Motion& motion, const Segmentation& segmentation) {
  Fit out = fit;
  if (fit.parameters.empty()) {
    out.messages.insert(out.messages.begin(), "the fit failed: there is nothing to try on another record");
    out.converged = false;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    out.error = {unknown, unknown, unknown, unknown};
    return out;
  }
  const Observations observations = observed_for(fit, motion, segmentation, sensor_noise(motion, segmentation));
  const Record one = {&motion, &segmentation};
  const FullRecord record(std::span(&one, 1), observations, fit.model.needs());
  const SampleErrors errors = sample_errors(fit.model, fit.values(), record, observations);
  out.error = errors.figures;
  out.error.held_out_rmse = out.error.rmse;
  out.cycles = observations.cycles;
  out.cycle_squares = errors.squares;
  out.cycle_counts = errors.counts;
  out.constant_rmse = errors.constant_rmse;
  return out;
}

double held_out_std_error(const Fit& fit) {
  const std::size_t n = fit.cycle_squares.size();
  double counts = 0;
  for (const double count : fit.cycle_counts) counts += count;
  if (n < 3 || !(counts > 0)) return std::numeric_limits<double>::quiet_NaN();
  if (!(fit.error.held_out_rmse > 0)) return 0;
  std::vector<double> squares(n);
  for (std::size_t c = 0; c < n; ++c) squares[c] = fit.cycle_squares[c] * static_cast<double>(n) / counts;
  return standard_error_of_mean(squares).std_error / (2 * fit.error.held_out_rmse);
}

namespace {

/// Angles whose mean is that over a turn of the disc.
int angles_of_turn(const FrictionModel& model) {
  if (!model.needs().angle) return 1;
  constexpr int kOfWaves = 12, kOfFormula = 48;  // exact up to the eleventh wave; effects of the catalogue have four
  const auto is_formula = [](const Effect& effect) { return describe(effect).group == EffectGroup::user; };
  return std::any_of(model.effects().begin(), model.effects().end(), is_formula) ? kOfFormula : kOfWaves;
}

}  // namespace

Curve law_curve(const Fit& fit, std::span<const double> velocity, int threads) {
  Curve curve;
  const std::vector<double> p = fit.values();
  if (p.empty()) return curve;
  curve.velocity.assign(velocity.begin(), velocity.end());
  for (auto* side : {&curve.mu, &curve.lower95, &curve.upper95}) side->resize(velocity.size());
  const std::size_t n = p.size();
  // Two samples of a slip at constant speed that begins in steady state; a law of the disc angle stands for its mean
  // over a turn.
  const int turns = angles_of_turn(fit.model);
  const auto steady = [&]<class T>(const FrictionModel& model, const std::vector<T>& q, double v) {
    const double time[] = {-1, 0}, speed[] = {v, v};
    const T sliding[] = {T(v), T(v)};
    T mu[2], sum = T(0.0);
    for (int k = 0; k < turns; ++k) {
      const double theta = 2 * std::numbers::pi * k / turns, angle[] = {theta, theta};
      Slip slip;
      slip.mean_load = fit.mean_load;
      slip.mean_temperature = fit.mean_temperature;
      slip.disc_speed = fit.disc_speed;
      slip.time = time;
      slip.velocity = speed;
      slip.angle = angle;
      evaluate<T>(model, q.data(), slip, sliding, mu);
      sum += mu[1];
    }
    return T(sum / static_cast<double>(turns));
  };
  const double t = t_quantile_95(fit.degrees_of_freedom);
  constexpr std::size_t kOfTask = 16, kDirections = 8;  // speeds; derivatives of one evaluation
  run_tasks((velocity.size() + kOfTask - 1) / kOfTask, threads, [&](std::size_t task) {
    const FrictionModel model(fit.model);  // its formulas must not be shared between threads
    std::vector<double> slope(n);
    for (std::size_t at = task * kOfTask; at < std::min(velocity.size(), (task + 1) * kOfTask); ++at) {
      const double v = velocity[at];
      double mu = 0;
      for (std::size_t first = 0; first < n; first += kDirections) {
        const std::size_t last = std::min(n, first + kDirections);
        std::vector<Dual<kDirections>> q(p.begin(), p.end());
        for (std::size_t k = first; k < last; ++k) q[k] = Dual<kDirections>(p[k], k - first);
        const Dual<kDirections> found = steady(model, q, v);
        mu = found.a;
        for (std::size_t k = first; k < last; ++k) slope[k] = found.v[k - first];
      }
      double variance = 0;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) variance += slope[i] * slope[j] * fit.covariance[i * n + j];
      }
      const double half = t * std::sqrt(std::max(0.0, variance));
      curve.mu[at] = mu;
      curve.lower95[at] = mu - half;
      curve.upper95[at] = mu + half;
    }
  });
  return curve;
}

std::vector<double> predict(const Fit& fit, const Motion& motion, const Segmentation& segmentation, std::size_t record,
                            int threads) {
  std::vector<double> mu(motion.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> p = fit.values();
  if (p.empty()) return mu;
  const Observations observations = observed_for(fit, motion, segmentation, {});  // nothing is weighed
  const Record one = {&motion, &segmentation};
  const FullRecord samples(std::span(&one, 1), observations, fit.model.needs());
  const std::span<const Observations::SlipObservation> slips = observations.slips;
  run_tasks((slips.size() + kSlipsOfPart - 1) / kSlipsOfPart, threads, [&](std::size_t k) {
    const FrictionModel model(fit.model);  // its formulas must not be shared between threads
    FullRecord::Made made;
    for (const auto& range : slips.subspan(k * kSlipsOfPart, std::min(kSlipsOfPart, slips.size() - k * kSlipsOfPart))) {
      Slip slip = samples.slip(range, made);
      slip.record = record;
      evaluate<double>(model, p.data(), slip, slip.velocity,
                       std::span<double>(mu).subspan(range.samples.begin, range.samples.size()));
    }
  });
  return mu;
}

}  // namespace tribofit
