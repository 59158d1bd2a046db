// What a fit is taken for beside its own record: failed fits, other loads, several records, what nothing determines.
#include <glog/logging.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"

namespace {

using namespace tribofit;

const FrictionModel kExponential(ExponentialLaw{});
const std::vector<double> kTruth = synthetic::table4_15mm(ExponentialLaw{});

Fit fit_with(const FrictionModel& model, const synthetic::Record& record, const Instruments& instruments = {},
             const FitOptions& options = {}) {
  const Observations observations = observe(record.motion, record.segmentation, model.needs());
  return fit_model(model, record.motion, record.segmentation, observations, instruments, options);
}

/// The same record without any stick: one slip after the other.
synthetic::Record never_sticking(synthetic::Record record) {
  record.segmentation.kind = MotionKind::always_slipping;
  for (Cycle& cycle : record.segmentation.cycles) {
    cycle.stick = {};
    cycle.break_away_friction = cycle.stick_maximum = std::numeric_limits<double>::quiet_NaN();
  }
  return record;
}

TEST(FailedFit, HasNoCurveAndNothingToTry) {
  const synthetic::Record record = never_sticking(synthetic::make(kExponential, kTruth, {}));
  FitOptions published;
  published.protocol = Protocol::published;
  const Fit fit = fit_with(kExponential, record, {}, published);
  ASSERT_FALSE(fit.converged);
  ASSERT_TRUE(fit.parameters.empty());
  const Curve curve = law_curve(fit, std::vector<double>{0.01, 0.02});
  EXPECT_TRUE(curve.velocity.empty() && curve.mu.empty() && curve.lower95.empty());
  const Fit frozen = evaluate_frozen(fit, record.motion, record.segmentation);
  EXPECT_FALSE(frozen.converged);
  EXPECT_TRUE(std::isnan(frozen.error.held_out_rmse));
  EXPECT_FALSE(frozen.messages.empty());
  for (const double mu : predict(fit, record.motion, record.segmentation)) EXPECT_TRUE(std::isnan(mu));
}

synthetic::Record at_load(double mean, double swing, const FrictionModel& model, std::vector<double> p, double n0) {
  synthetic::Options options;
  options.cycles = 12;
  // Levels of the coefficient at this load, by hand: mu (N/N0)^-p, cycle by cycle.
  const double exponent = p.back();
  p.pop_back();
  synthetic::Record record = synthetic::make(model, p, options);
  std::size_t number = 0;
  for (Cycle& cycle : record.segmentation.cycles) {
    const double load = mean + swing * std::sin(static_cast<double>(number++));
    const double factor = std::pow(load / n0, -exponent);
    for (std::size_t i = cycle.stick.begin; i < cycle.slip.end; ++i) {
      record.motion.friction[i] *= factor;
      record.motion.load.push_back(load);
    }
    cycle.break_away_friction *= factor;
  }
  return record;
}

TEST(FrozenFit, ItsParametersReferToItsOwnLoad) {
  constexpr double kExponent = 0.3;
  std::vector<double> p = kTruth;
  p.push_back(kExponent);
  const FrictionModel model(ExponentialLaw{}, {make_effect("load-dependence")});
  const synthetic::Record light = at_load(50, 10, kExponential, p, 50), heavy = at_load(100, 10, kExponential, p, 50);
  const Fit fit = fit_with(model, light);
  ASSERT_NEAR(fit.parameters[3].value, kExponent, 1e-3);
  EXPECT_NEAR(fit.mean_load, 50, 3);
  const Fit there = evaluate_frozen(fit, heavy.motion, heavy.segmentation);
  EXPECT_LT(there.error.rmse, 1e-4);
  const std::vector<double> mu = predict(fit, heavy.motion, heavy.segmentation);
  double worst = 0;
  for (std::size_t i = 0; i < mu.size(); ++i) {
    if (std::isfinite(mu[i])) worst = std::max(worst, std::abs(mu[i] - heavy.motion.friction[i]));
  }
  EXPECT_LT(worst, 1e-3);
}

/// A formula keeps what it is given between two steps of its evaluation: threads must not share one.
TEST(Predictions, OfAFormulaAreTheSameForAnyNumberOfThreads) {
  synthetic::Options options;
  options.cycles = 200;
  const synthetic::Record record = synthetic::make(kExponential, kTruth, options);
  const FrictionModel model(ExponentialLaw{}, {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.01, v0=30mm/s, w=8mm/s")});
  const Fit fit = fit_with(model, record);
  const std::vector<double> alone = predict(fit, record.motion, record.segmentation, 0, 1);
  for (const int threads : {2, 8}) {
    const std::vector<double> shared = predict(fit, record.motion, record.segmentation, 0, threads);
    for (std::size_t i = 0; i < alone.size(); ++i)
      ASSERT_TRUE(shared[i] == alone[i] || (std::isnan(shared[i]) && std::isnan(alone[i]))) << threads << " " << i;
  }
}

TEST(LawCurve, IsTheSameForAnyNumberOfThreads) {
  Fit fit;
  fit.model = FrictionModel(ExponentialLaw{}, {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s")});
  std::vector<double> p = kTruth;
  for (const double value : {0.02, 0.025, 0.006}) p.push_back(value);
  fit.covariance.resize(p.size() * p.size());
  for (std::size_t k = 0; k < p.size(); ++k) {
    fit.parameters.emplace_back();
    fit.parameters.back().value = p[k];
    fit.covariance[k * p.size() + k] = 1e-6 * p[k] * p[k];
  }
  std::vector<double> speeds;
  for (int i = 0; i < 2000; ++i) speeds.push_back(2.5e-5 * i);
  const Curve alone = law_curve(fit, speeds);
  ASSERT_EQ(alone.mu.size(), speeds.size());
  for (const int threads : {2, 3, 8}) {
    const Curve shared = law_curve(fit, speeds, threads);
    EXPECT_EQ(shared.mu, alone.mu) << threads;
    EXPECT_EQ(shared.lower95, alone.lower95) << threads;
    EXPECT_EQ(shared.upper95, alone.upper95) << threads;
  }
}

/// Over a turn a wave averages out, also one of a dozen periods, and what presses at one angle keeps its share.
TEST(LawCurve, OfAFormulaOfTheAngleIsItsMeanOverATurn) {
  const auto mean_of = [](const std::string& formula, const std::vector<double>& values) {
    Fit fit;
    fit.model = FrictionModel(ExponentialLaw{}, {Formula(formula)});
    std::vector<double> p = kTruth;
    p.insert(p.end(), values.begin(), values.end());
    for (const double value : p) {
      fit.parameters.emplace_back();
      fit.parameters.back().value = value;
    }
    fit.covariance.assign(p.size() * p.size(), 0.0);
    const double steady = law_curve(fit, std::vector<double>{0.03}).mu[0];
    fit.model = FrictionModel(ExponentialLaw{}, {Formula("c = a; a=0.01")});
    fit.parameters.resize(kTruth.size() + 1);
    fit.parameters.back().value = 0;
    fit.covariance.assign((kTruth.size() + 1) * (kTruth.size() + 1), 0.0);
    return steady - law_curve(fit, std::vector<double>{0.03}).mu[0];
  };
  EXPECT_NEAR(mean_of("wave = a*cos(12*angle+0.3); a=0.01", {0.01}), 0, 1e-12);
  // 0.01 sqrt(pi) 0.15 / (2 pi)
  EXPECT_NEAR(mean_of("bump = a*exp(-((angle-1)/0.15)^2); a=0.01", {0.01}), 0.01 * 0.042314, 1e-6);
}

/// The reading mu - m_s a/N follows N(t) where it was recorded, in the fit as in its errors.
TEST(FrozenFit, AMassBelowTheSensorSeesTheLoadAsRecorded) {
  synthetic::Options options;
  options.cycles = 20;
  synthetic::Record record = synthetic::make(kExponential, kTruth, options);
  const FrictionModel model(ExponentialLaw{}, {make_effect("sensor-inertia")});
  constexpr double kMass = 0.2;
  std::size_t number = 0;
  for (Cycle& cycle : record.segmentation.cycles) {
    const double load = number++ % 2 == 0 ? 20 : 80;
    const std::vector<double> a = slip_motion(record.motion, cycle.slip).acceleration;
    for (std::size_t i = cycle.stick.begin; i < cycle.slip.end; ++i) {
      record.motion.load.push_back(load);
      if (i >= cycle.slip.begin) record.motion.friction[i] -= kMass * a[i - cycle.slip.begin] / load;
    }
  }
  const Fit fit = fit_with(model, record);
  ASSERT_EQ(fit.parameters.size(), 4u);
  EXPECT_NEAR(fit.parameters[3].value, kMass, 0.02 * kMass);
  EXPECT_LT(fit.error.rmse, 2e-4);
}

/// A drive that turns within a dozen samples, measured without noise and with noise: what is there is not flattened,
/// and where noise hides it no window is too short.
TEST(SlipMotion, IsAsSmoothAsTheNoiseDemands) {
  const auto error_of = [](double noise) {
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal(0, noise);
    Motion motion;
    motion.step = 1e-3;
    motion.velocity_noise = noise;
    const double w = 2 * std::numbers::pi / 0.06;
    for (int i = 0; i < 4000; ++i) {
      motion.time.push_back(1e-3 * i);
      motion.relative_velocity.push_back(0.2 - 0.1 * std::sin(w * 1e-3 * i) + normal(generator));
    }
    const std::vector<double> a = slip_motion(motion, {0, 4000}).acceleration;
    double squares = 0;
    for (std::size_t i = 20; i + 20 < a.size(); ++i)
      squares += std::pow(a[i] - 0.1 * w * std::cos(w * motion.time[i]), 2) / 3960;
    return std::sqrt(squares) / (0.1 * w);
  };
  EXPECT_LT(error_of(1e-7), 2e-3);  // a window of 21 samples: 0.081
  // The best of all windows (11 samples) leaves 0.038 here, central differences 0.24, 21 samples 0.082.
  EXPECT_LT(error_of(3.5e-3), 0.07);
}

TEST(SeveralRecords, PerCycleExtremesAreThoseOfAll) {
  synthetic::Options options;
  options.noise = 0.003;
  options.cycles = 20;
  const synthetic::Record a = synthetic::make(kExponential, kTruth, options);
  options.seed = 2;
  const synthetic::Record b = synthetic::make(kExponential, {0.49, 0.3, 52.14}, options);
  const Record records[] = {{&a.motion, &a.segmentation}, {&b.motion, &b.segmentation}};
  std::vector<Observations> each;
  for (const Record& record : records) each.push_back(observe(*record.motion, *record.segmentation));
  const Observations all = join(each);
  FitOptions published;
  published.protocol = Protocol::published;
  const Fit fit = fit_model(kExponential, records, all, {}, published);
  ASSERT_TRUE(fit.converged);
  double maxima = 0, minima = 0, count = 0;
  for (const Record& record : records) {
    for (const Cycle& cycle : record.segmentation->cycles) {
      maxima += cycle.stick_maximum, minima += cycle.slip_minimum, count += 1;
    }
  }
  EXPECT_NEAR(fit.parameters[0].value, maxima / count, 1e-12);
  EXPECT_NEAR(fit.parameters[1].value, minima / count, 1e-12);
}

/// Systematic parts of one record, of two, with the disc as stated and as a recorded channel.
TEST(SeveralRecords, SystematicPartsDoNotVanish) {
  synthetic::Options options;
  options.noise = 0.001;
  const synthetic::Record stated = synthetic::make(kExponential, kTruth, options);
  synthetic::Record recorded = stated;
  const std::size_t n = stated.motion.size();
  recorded.motion.disc_speed.assign(n, 0.419);
  recorded.motion.disc_velocity.assign(n, 0.00628);
  recorded.motion.constant_disc_velocity = 0;
  recorded.motion.conditions.speed = {};
  Instruments radius, gain;
  radius.rig.radius = Declared{0.015, 0.001};
  gain.vibrometer.gain = Declared{1, 0.01};
  for (const Instruments& declared : {radius, gain}) {
    const Fit one = fit_with(kExponential, stated, declared), channel = fit_with(kExponential, recorded, declared);
    const Record records[] = {{&stated.motion, &stated.segmentation}, {&stated.motion, &stated.segmentation}};
    const Observations single = observe(stated.motion, stated.segmentation);
    const Fit both = fit_model(kExponential, records, join({single, single}), declared);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT(one.parameters[k].systematic, 0) << k;
      EXPECT_NEAR(channel.parameters[k].systematic, one.parameters[k].systematic, 0.01 * one.parameters[k].systematic);
      EXPECT_NEAR(both.parameters[k].systematic, one.parameters[k].systematic, 0.01 * one.parameters[k].systematic);
    }
  }
}

TEST(Systematic, AnOffsetOfTheClocksCountsAsADelayOfTheVibrometer) {
  synthetic::Options options;
  options.noise = 0.001;
  synthetic::Record record = synthetic::make(kExponential, kTruth, options);
  Instruments late;
  late.vibrometer.delay = Declared{0, 1e-4};
  const Fit declared = fit_with(kExponential, record, late);
  record.motion.clock_offset_std_error = 1e-4;
  const Fit joined = fit_with(kExponential, record);
  record.motion.clock_offset_std_error = std::numeric_limits<double>::quiet_NaN();
  const Fit unknown = fit_with(kExponential, record);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(joined.parameters[k].systematic, 0);
    EXPECT_DOUBLE_EQ(joined.parameters[k].systematic, declared.parameters[k].systematic);
    EXPECT_TRUE(std::isnan(unknown.parameters[k].systematic));
  }
}

/// Constant friction: nothing is known of how steeply a law would fall, within what is plausible.
TEST(NotDetermined, AParameterThatFillsItsBoundsHasNoInterval) {
  synthetic::Options options;
  options.noise = 0.003;
  options.cycles = 12;
  const synthetic::Record record = never_sticking(synthetic::make(FrictionModel(CoulombLaw{}), {0.3, 0.3}, options));
  FitOptions within;
  within.given = {{"alpha", std::nullopt, GivenParameter::Bounds{50, 55}}};
  const Fit fit = fit_with(kExponential, record, {}, within);
  ASSERT_EQ(fit.parameters.size(), 3u);
  for (const FitParameter& p : fit.parameters) {
    const bool whole =
        p.lower95 <= p.parameter.lower * p.parameter.si && p.upper95 >= p.parameter.upper * p.parameter.si;
    EXPECT_EQ(p.determined, !whole) << p.parameter.name;
    EXPECT_EQ(std::isfinite(p.std_error), p.determined) << p.parameter.name;
    EXPECT_EQ(std::isfinite(p.upper95 - p.lower95), p.determined) << p.parameter.name;
  }
  EXPECT_FALSE(fit.parameters[2].determined);
  EXPECT_THAT(fit.messages, testing::Contains(testing::HasSubstr("not determined")));
}

TEST(Solver, LeavesTheLoggingOfTheProgramAsItIs) {
  const int before = FLAGS_minloglevel;
  FLAGS_minloglevel = google::GLOG_WARNING;
  fit_with(kExponential, synthetic::make(kExponential, kTruth, {.cycles = 8}));
  EXPECT_EQ(FLAGS_minloglevel, google::GLOG_WARNING);
  FLAGS_minloglevel = before;
}

TEST(Curve, TurnsWithTheDiscOfTheRecord) {
  synthetic::Options options;
  options.noise = 0.001;
  const FrictionModel model(ExponentialLaw{}, {make_effect("drift")});
  const synthetic::Record record = synthetic::make(kExponential, kTruth, options);
  const Fit fit = fit_with(model, record);
  EXPECT_NEAR(fit.disc_speed, 0.419, 1e-12);
  Fit later = fit;  // a drift of 10 % a second is none at the start
  later.parameters[3].value = 0.1;
  later.parameters[0].value = later.parameters[1].value = 0.3;
  EXPECT_NEAR(law_curve(later, std::vector<double>{0.02}).mu[0], 0.3, 1e-12);
}

}  // namespace
