#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit {

/// A result with the published numbers of [D] at 15 mm, filled by hand: two cycles of four samples each.
inline FitParameter made_up_parameter(const FrictionModel& model, std::size_t k, double value, double error) {
  FitParameter p;
  p.parameter = model.parameters()[k].parameter;
  p.effect = model.parameters()[k].effect;
  p.value = value;
  p.std_error = error;
  p.lower95 = value - 2 * error;
  p.upper95 = value + 2 * error;
  p.start = 0.9 * value;
  p.profile_lower95 = p.profile_upper95 = std::numeric_limits<double>::quiet_NaN();
  return p;
}

inline Fit made_up_fit(Law law, double decay, Protocol protocol = Protocol::joint) {
  Fit fit;
  fit.model = FrictionModel(law);
  fit.protocol = protocol;
  fit.parameters = {made_up_parameter(fit.model, 0, 0.509, 0.0012), made_up_parameter(fit.model, 1, 0.318, 0.0021),
                    made_up_parameter(fit.model, 2, decay, 0.43)};
  fit.error = {0.0031, 0.006, 0.05, 0.0032};
  fit.floor = {.noise = 0.0030, .scatter = 0.0040, .rmse = 0.0031, .source = "stick"};
  fit.explained = 0.9987;
  fit.converged = true;
  fit.observations = 6;
  fit.cycles = 2;
  fit.stick_rmse = std::numeric_limits<double>::quiet_NaN();
  fit.fastest = 0.0839;
  fit.covariance.assign(9, 0.0);
  for (std::size_t k = 0; k < 3; ++k) fit.covariance[4 * k] = std::pow(fit.parameters[k].std_error, 2);
  fit.cycle_squares = {1e-5, 2e-5};
  fit.cycle_counts = {3, 3};
  fit.fold_parameters = {fit.values(), fit.values()};
  fit.cycle_folds = {0, 1};
  return fit;
}

inline Motion made_up_motion() {
  Motion motion;
  motion.step = 0.1;
  const double v[] = {0, 0, 0.01, 0.05, 0.08, 0.04, 0, 0, 0.02, 0.06, 0.07, 0.03};
  for (std::size_t i = 0; i < 12; ++i) {
    motion.time.push_back(0.1 * static_cast<double>(i));
    motion.relative_velocity.push_back(v[i]);
    motion.friction.push_back(0.318 + 0.191 * std::exp(-52.14 * v[i]));
  }
  motion.constant_disc_velocity = 0.00628;
  motion.conditions.radius = {0.015, "command line"};
  motion.conditions.speed = {4 * 2 * 3.14159265358979323846 / 60, "plateau"};
  motion.steps = {{0, 12, "", motion.conditions}};
  motion.health = {{"clipping", HealthItem::Status::ok, "none"},
                   {"revolutions", HealthItem::Status::warning, "1.3 revolutions recorded"}};
  return motion;
}

inline Segmentation made_up_segmentation() {
  Segmentation s;
  s.slip_threshold = 0.005;
  for (const std::size_t begin : {std::size_t{0}, std::size_t{6}}) {
    Cycle c;
    c.stick = {begin, begin + 2};
    c.slip = {begin + 2, begin + 6};
    c.stick_complete = begin > 0;
    c.slip_complete = true;
    c.break_away_time = 0.1 * static_cast<double>(begin) + 0.15;
    c.stick_time = begin > 0 ? 0.175 : std::numeric_limits<double>::quiet_NaN();
    c.slip_time = 0.0295;
    c.period = begin == 0 ? 0.6 : std::numeric_limits<double>::quiet_NaN();
    c.break_away_friction = 0.509;
    c.stick_maximum = 0.512;
    c.slip_minimum = 0.3205;
    c.stick_slope = 2.03;
    c.peak_velocity = 0.0839;
    s.cycles.push_back(c);
  }
  s.frequency = {4.883, 0.012};
  s.amplitude = {0.0839, 0.0002};
  s.stick_time = {0.1754, 0.0003};
  s.slip_time = {0.0295, 0.0001};
  s.rms_velocity = 0.0191;
  return s;
}

inline Identification made_up_result() {
  Identification r;
  r.path = "runs/r15.csv";
  r.checksum = 0xabcdef;
  r.samples = 2400000;
  r.duration = 120;
  r.rate = 20000;
  r.motion = made_up_motion();
  r.segmentation = made_up_segmentation();
  r.spectral_peak = {4.881, 0.0264, 4.883, 0.6104};
  r.fits = {made_up_fit(ExponentialLaw{}, 52.14), made_up_fit(FractionalLaw{}, 95.33),
            made_up_fit(ExponentialLaw{}, 60.1, Protocol::published)};
  r.fits[1].error.held_out_rmse = 0.0060;
  return r;
}

/// A runout found in that trace, and what became of the other effects.
inline DiagnosedTraces made_up_diagnosis() {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  DiagnosedTraces out;
  out.traces = {made_up_result()};
  out.traces[0].fits.clear();
  out.traces[0].motion.conditions.load = {50, "command line"};
  Fit fit = made_up_fit(ExponentialLaw{}, 52.14);
  out.fits = {fit};
  out.fits[0].error.held_out_rmse = 0.0088;
  fit.model = FrictionModel(ExponentialLaw{}, {make_effect("runout")});
  fit.parameters.push_back(made_up_parameter(fit.model, 3, 0.048, 0.001));
  fit.parameters.push_back(made_up_parameter(fit.model, 4, 0.3, 0.02));
  fit.covariance.assign(25, 0.0);
  fit.fold_parameters = {fit.values(), fit.values()};
  fit.cycle_folds = {0, 1, 0, 1};  // two traces of two cycles, or one
  out.fits.push_back(fit);
  out.best = 1;
  Diagnosis& d = out.diagnosis;
  d.verdict = Verdict::effect_found;
  d.where = {{ResidualVariable::angle, 0.82, 1e-6},
             {ResidualVariable::time, 0.07, 0.01},
             {ResidualVariable::velocity, 0.02, 0.4}};
  d.remaining = {{ResidualVariable::velocity, 0.03, 0.5}};
  d.ladder = {{"", 0.0088, 0.0002, 0.0086, {}}, {"runout", 0.0032, 0.0001, 0.0031, {}}};
  d.floor_rmse = 0.0031;
  d.effects = {
      {"runout", EffectStatus::found, 0.0032, 0.99, 1e-6, {fit.parameters[3], fit.parameters[4]}, "it is periodic"},
      {"drift", EffectStatus::not_supported, 0.0088, 0, 0.7, {}, "takes nothing away"},
      {"heating", EffectStatus::superseded, 0.008, 0.1, 0.01, {}, "helps alone only"},
      {"load-dependence", EffectStatus::untestable, unknown, unknown, unknown, {}, "there is no load channel"},
      {"crosstalk", EffectStatus::untestable, unknown, unknown, unknown, {}, "there is no load channel"}};
  return out;
}

}  // namespace tribofit
