/// What every effect of the catalogue must satisfy; a new effect is covered as soon as it is in the list.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "samples.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace {

using namespace tribofit;

std::vector<std::string> catalogue_keys() {
  std::vector<std::string> keys;
  for (const Effect& effect : effect_catalogue()) keys.push_back(describe(effect).key);
  return keys;
}

/// With the forms of effects.
std::vector<std::string> every_name() {
  std::vector<std::string> names = catalogue_keys();
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    for (const EffectForm& form : info.forms) names.push_back(info.key + ":" + form.name);
  }
  return names;
}

class EveryEffect : public testing::TestWithParam<std::string> {
 protected:
  FrictionModel model_{ExponentialLaw{}, {make_effect(GetParam())}};

  /// Base law of [D] at 15 mm; effects a third of the way between their bounds, so that each of them acts, and a delay
  /// lies between samples.
  std::vector<double> example() const {
    std::vector<double> p = {0.509, 0.318, 52.14};
    for (std::size_t k = 3; k < model_.parameters().size(); ++k) {
      const Parameter& q = model_.parameters()[k].parameter;
      const double value =
          q.lower > 0 ? q.lower * std::pow(q.upper / q.lower, 0.31) : q.lower + 0.31 * (q.upper - q.lower);
      p.push_back(value * q.si);
    }
    return p;
  }
};

TEST_P(EveryEffect, DescribesItself) {
  const EffectInfo info = describe(model_.effects()[0]);
  EXPECT_GT(info.statement.size(), 20u);
  EXPECT_NE(info.equation.find('='), std::string::npos);
  EXPECT_FALSE(info.source.empty());
  EXPECT_FALSE(info.experiment.empty());
  EXPECT_FALSE(info.parameters.empty());
  std::set<std::string> names;
  for (const Parameter& p : info.parameters) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_LT(p.lower, p.upper) << p.name;
    EXPECT_GE(p.start, p.lower) << p.name;
    EXPECT_LE(p.start, p.upper) << p.name;
    const auto unit = find_unit(p.unit);
    ASSERT_TRUE(unit) << p.name << " [" << p.unit << "]";
    EXPECT_DOUBLE_EQ(unit->factor, p.si) << p.name << " [" << p.unit << "]";
    EXPECT_GT(p.description.size(), 10u) << p.name;
    EXPECT_LT(p.description.size(), 90u) << p.name << ": one line";
    EXPECT_NE(p.description.back(), '.') << p.name;
    EXPECT_EQ(p.periodic, p.unit == "rad") << p.name;
  }
}

TEST_P(EveryEffect, SaysHowItIsDrawnAndSearched) {
  const EffectInfo info = describe(model_.effects()[0]);
  ASSERT_EQ(info.sketch.values.size(), info.parameters.size());
  for (std::size_t k = 0; k < info.parameters.size(); ++k) {
    const Parameter& p = info.parameters[k];
    EXPECT_GE(info.sketch.values[k], p.lower) << p.name;
    EXPECT_LE(info.sketch.values[k], p.upper) << p.name;
    // A search for a time of change looks at the size before it; a line shows at full resolution only.
    if (p.search == ParameterSearch::moment_of_change) {
      EXPECT_GT(k, 0u) << p.name;
    }
    const bool line = p.search == ParameterSearch::steady_line || p.search == ParameterSearch::ringing_line;
    if (line) {
      EXPECT_TRUE(info.needs_full_resolution) << p.name;
    }
    // Where the clock or the disc stood when a record began is another value in the next record.
    const bool of_record = p.periodic && (info.needs.angle || p.search == ParameterSearch::steady_line);
    if (of_record) {
      EXPECT_EQ(p.scope, ParameterScope::record) << p.name;
    }
  }
  // What is seen over the angle of the disc must come back.
  if (info.needs.angle) {
    EXPECT_GE(info.excitation.revolutions, 2);
  }
}

/// Derivatives of friction along a slip, and of its break-away level, against differences.
void expect_derivatives(const FrictionModel& model, const std::vector<double>& p, const Slip& slip) {
  using Dual = ceres::Jet<double, 8>;
  ASSERT_LE(p.size(), 8u);
  std::vector<Dual> dual, mu(slip.size()), velocity;
  for (std::size_t k = 0; k < p.size(); ++k) dual.emplace_back(p[k], static_cast<int>(k));
  for (const double v : slip.velocity) velocity.emplace_back(v);
  evaluate<Dual>(model, dual.data(), slip, velocity, mu);
  const Dual level = break_away_level(model, dual.data(), slip);
  for (std::size_t k = 0; k < p.size(); ++k) {
    std::vector<double> high = p, low = p, mu_high(slip.size()), mu_low(slip.size());
    const double h = 1e-5 * std::max(std::abs(p[k]), 1e-4);
    high[k] += h;
    low[k] -= h;
    evaluate<double>(model, high.data(), slip, slip.velocity, mu_high);
    evaluate<double>(model, low.data(), slip, slip.velocity, mu_low);
    double scale = 1e-12;
    for (std::size_t i = 0; i < slip.size(); ++i) scale = std::max(scale, std::abs(mu_high[i] - mu_low[i]) / (2 * h));
    for (std::size_t i = 0; i < slip.size(); i += 7) {
      const double slope = (mu_high[i] - mu_low[i]) / (2 * h);
      EXPECT_NEAR(mu[i].v[static_cast<Eigen::Index>(k)], slope, 1e-4 * scale + 1e-9 / h)
          << "parameter " << k << " sample " << i;
    }
    const double slope =
        (break_away_level(model, high.data(), slip) - break_away_level(model, low.data(), slip)) / (2 * h);
    EXPECT_NEAR(level.v[static_cast<Eigen::Index>(k)], slope, 1e-6 * std::abs(slope) + 1e-9 / h);
    EXPECT_EQ(mu[5].a, mu[5].a);  // finite: NaN is not equal to itself
  }
}

TEST_P(EveryEffect, DerivativesAreThoseOfTheValues) {
  for (const double direction : {1.0, -1.0}) {
    const samples::ExampleSlip example_slip(400, 0.08, 0.1, direction);
    expect_derivatives(model_, example(), example_slip.slip);
  }
}

TEST(Derivatives, OfLocalSpeedsReachEveryEffectOnThem) {
  const FrictionModel model(ExponentialLaw{},
                            {make_effect("contact-spin"), make_effect("stribeck-exponent"), make_effect("viscous")});
  const std::vector<double> lead_time = {2.998, 2.999}, lead_velocity = {2e-4, 4e-4};
  for (const double direction : {1.0, -1.0}) {
    samples::ExampleSlip made(400, 0.08, 0.1, direction);
    made.slip.disc_speed = 2;
    for (const double radius : {3e-3, 2e-5}) {  // at the smaller, readings about rest are noise
      expect_derivatives(model, {0.509, 0.318, 52.14, radius, 1.4, 0.8}, made.slip);
    }
    std::vector<double> signed_lead = lead_velocity;
    for (double& v : signed_lead) v *= direction;
    made.slip.lead_time = lead_time;
    made.slip.lead_velocity = signed_lead;
    expect_derivatives(model, {0.509, 0.318, 52.14, 3e-3, 1.4, 0.8}, made.slip);
  }
}

TEST(Derivatives, OfADelayBetweenMeansAndWithoutAStick) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("channel-delay")});
  samples::ExampleSlip made(400, 0.08, 0.1, 1);
  const std::vector<double> variance(400, 1e-8), p = {0.509, 0.318, 52.14, 1.13e-3};
  made.slip.from_stick = false;
  expect_derivatives(model, p, made.slip);  // straight lines between samples
  made.slip.from_stick = true;
  made.slip.velocity_variance = variance;
  expect_derivatives(model, p, made.slip);
}

TEST_P(EveryEffect, IsFiniteAtRestAndAtHighSpeed) {
  for (const double peak : {1e-9, 1e-6, 10.0}) {
    const samples::ExampleSlip example_slip(50, peak);
    const std::vector<double> p = example();
    std::vector<double> mu(example_slip.slip.size());
    evaluate<double>(model_, p.data(), example_slip.slip, example_slip.slip.velocity, mu);
    for (const double value : mu) EXPECT_TRUE(std::isfinite(value)) << peak;
    EXPECT_TRUE(std::isfinite(break_away_level(model_, p.data(), example_slip.slip)));
  }
}

TEST_P(EveryEffect, MirrorsWithTheDirection) {
  // A contact has no preferred direction unless the effect says so, and then by name.
  const std::set<std::string> one_sided = {"asymmetry", "sensor-offset", "zero-drift",
                                           "crosstalk", "interference",  "load-coupling"};
  if (one_sided.contains(GetParam())) return;
  const samples::ExampleSlip forward(100, 0.08, 0.1, 1), backward(100, 0.08, 0.1, -1);
  const std::vector<double> p = example();
  std::vector<double> a(100), b(100);
  evaluate<double>(model_, p.data(), forward.slip, forward.slip.velocity, a);
  evaluate<double>(model_, p.data(), backward.slip, backward.slip.velocity, b);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(a[i], -b[i], 1e-12);
}

/// One slip of a simulated motion as a fit sees it, with the last samples of the stick before it.
struct CutOut {
  Slip slip;
  std::vector<double> velocity;
  std::size_t begin = 0, end = 0;

  CutOut(const SimulatedMotion& motion, const Trace& trace, const SimulatedSlip& event) {
    const auto index = [&](double t) {
      return static_cast<std::size_t>(std::upper_bound(motion.time.begin(), motion.time.end(), t) -
                                      motion.time.begin());
    };
    begin = index(event.break_away_time);
    end = index(event.restick_time);
    const auto cut = [this](const std::vector<double>& x) {
      return x.empty() ? std::span<const double>() : std::span(x).subspan(begin, end - begin);
    };
    velocity.assign(motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(begin),
                    motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(end));
    slip.time = cut(motion.time);
    slip.velocity = velocity;
    slip.acceleration = cut(motion.acceleration);
    slip.angle = cut(motion.disc_angle);
    slip.distance = cut(motion.distance);
    slip.load = cut(trace.load);
    slip.temperature = cut(motion.temperature);
    slip.from_stick = true;
    slip.break_away_time = event.break_away_time;
    slip.stick_time = event.stick_time;
    slip.stick_slope = (motion.friction[begin - 20] - motion.friction[begin - 40]) * motion.rate / 20;
    slip.direction = event.direction;
    slip.mean_load = motion.mean_load;
    slip.mean_temperature = motion.mean_temperature;
    slip.disc_speed = motion.disc_speed[begin];
    constexpr std::size_t kLead = 100;
    slip.lead_time = std::span(motion.time).subspan(begin - kLead, kLead);
    slip.lead_velocity = std::span(motion.relative_velocity).subspan(begin - kLead, kLead);
    slip.lead_friction = motion.friction[begin - kLead];
  }
  CutOut(const CutOut&) = delete;
  CutOut& operator=(const CutOut&) = delete;
};

TEST_P(EveryEffect, IsTheSameInARecordAndInAFit) {
  // Hidden in a simulated record and cut out of it, a slip must read as the fit evaluates it. Noise is 0.003.
  const PublishedTest test = published_test(0.015, ExponentialLaw{});
  const Drive drive = {.speed = constant_speed(test.speed),
                       .radius = test.radius,
                       .mean_load = test.load,
                       .load = [](double t) { return 50 + 5 * std::sin(2 * t); },
                       .temperature = [](double t) { return 20 + 5 * std::cos(3 * t); }};
  const std::vector<double> p = example();
  const SimulatedRecording hidden = simulate_recording(model_, p, test.rig, drive, {.duration = 1.5, .settle = 2});
  const double largest = *std::ranges::max_element(hidden.motion.friction);
  int slips = 0;
  for (const SimulatedSlip& event : hidden.motion.slips) {
    if (event.break_away_time < 0.05 || std::isnan(event.restick_time)) continue;
    CutOut cut(hidden.motion, hidden.recording.trace, event);
    // kinematics/ would have found it.
    if (GetParam() == "force-bandwidth:first-order") cut.slip.friction_low_pass = 1 / (2 * std::numbers::pi * p[3]);
    std::vector<double> mu(cut.slip.size());
    evaluate<double>(model_, p.data(), cut.slip, cut.slip.velocity, mu);
    double worst = 0;
    for (std::size_t i = 0; i < mu.size(); ++i) {
      // A channel that runs early shows what comes after the slip.
      if (GetParam() == "channel-delay" && cut.slip.time[i] - p[3] > event.restick_time) break;
      double reading = hidden.recording.trace.friction[cut.begin + i];
      if (GetParam() == "friction-compression") {  // kinematics/ undoes it: reading = mu (1 - c (mu/mu_max)^2)
        const double true_mu = hidden.motion.friction[cut.begin + i];
        EXPECT_NEAR(reading, true_mu * (1 - p[3] * std::pow(true_mu / largest, 2)), 1e-12);
        reading = true_mu;
      }
      worst = std::max(worst, std::abs(mu[i] - reading));
    }
    EXPECT_LT(worst, 3e-4) << "slip at " << event.break_away_time << " s";
    ++slips;
  }
  EXPECT_GE(slips, 3);
}

TEST(Catalogue, EffectsSayTheSameOfAWholeSlipAsOfEverySample) {
  // Slow turns, a sample that is far on, and turns as fast as samples show.
  std::vector<double> time, velocity, angle;
  for (int i = 0; i < 6000; ++i) {
    time.push_back(i < 4500 ? 1e-4 * i : i < 4800 ? 0.45 + 9e-4 * (i - 4500) : 0.72 + 5e-3 * (i - 4800));
    velocity.push_back(0.05 + 0.04 * std::sin(0.01 * i));
    angle.push_back(0.7 + (i < 3000 ? 1e-3 * i : i < 4000 ? 40 + 0.02 * i : 200 - 0.9 * i));
  }
  Slip slip;
  slip.time = time, slip.velocity = velocity, slip.angle = angle;
  slip.mean_load = 50;
  slip.from_stick = true, slip.break_away_time = 0.01;
  const std::vector<double> p = {0.05, 40, 0.002, -2};
  std::vector<std::string> with_both;
  for (const std::string& key : catalogue_keys()) {
    const FrictionModel model(ExponentialLaw{}, {make_effect(key)});
    std::vector<double> values(model.base_count(), 0.3);
    for (std::size_t k = 0; values.size() < model.parameters().size(); ++k) values.push_back(p[k % p.size()]);
    for_each_effect(model, values.data(), [&]<class E>(const E& effect, const double* q) {
      if constexpr (hooks::Modulates<E, double> && hooks::ModulatesAll<E, double>) {
        with_both.push_back(key);
        std::vector<double> whole(time.size(), 0.4);
        effect.modulate_all(q, slip, slip.velocity, std::span<double>(whole));
        for (std::size_t i = 0; i < whole.size(); ++i)
          ASSERT_NEAR(whole[i], effect.modulate(q, slip.at(i, velocity[i]), 0.4), 1e-12) << key << " " << i;
      }
      if constexpr (hooks::AddsToReadings<E, double>) {
        with_both.push_back(key);
        for (const auto& [direction, from_stick] : {std::pair{1, true}, std::pair{-1, true}, std::pair{1, false}}) {
          Slip one = slip;
          one.direction = direction, one.from_stick = from_stick;
          std::vector<double> whole(time.size(), 0.4);
          effect.add_to_readings(q, one, std::span<double>(whole));
          for (std::size_t i = 0; i < whole.size(); ++i)
            ASSERT_NEAR(whole[i], effect.add_to_reading(q, one.at(i, velocity[i]), 0.4), 1e-14) << key << " " << i;
        }
      }
    });
  }
  EXPECT_EQ(with_both, (std::vector<std::string>{"runout", "disc-pattern", "ringing", "interference"}));
}

TEST(Catalogue, AContactThatSpinsSlidesLocallyForEveryEffectOnItsSpeed) {
  const FrictionModel model(ExponentialLaw{},
                            {make_effect("contact-spin"), make_effect("stribeck-exponent"), make_effect("viscous")});
  const std::vector<double> p = {0.509, 0.318, 52.14, 3e-3, 1.4, 0.8};
  for (const double direction : {1.0, -1.0}) {
    samples::ExampleSlip made(400, 0.08, 0.1, direction);
    made.slip.disc_speed = 2;  // the rim turns at 6 mm/s
    std::vector<double> mu(made.slip.size());
    evaluate<double>(model, p.data(), made.slip, made.slip.velocity, mu);
    const LawValues<double> law = law_for(model, p.data(), made.slip);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const double alone = steady_friction(model, p.data(), law, made.slip.at(i, made.slip.velocity[i]));
      EXPECT_NEAR(mu[i], direction * alone, 1e-13) << i;
    }
  }
}

TEST(Catalogue, HasOneEffectForWhatOthersAskFor) {
  for (bool EffectInfo::*property : {&EffectInfo::proportional_to_speed, &EffectInfo::creeps_like_sag}) {
    const auto catalogue = effect_catalogue();
    EXPECT_EQ(std::count_if(catalogue.begin(), catalogue.end(), [&](const Effect& e) { return describe(e).*property; }),
              1);
    EXPECT_TRUE(describe(effect_with(property)).*property);
  }
  for (const InstrumentValue value :
       {InstrumentValue::force_mass_below, InstrumentValue::force_bandwidth, InstrumentValue::vibrometer_delay}) {
    EXPECT_EQ(describe(effect_declared_by(value)).declared_by, value);
  }
}

TEST(Pairs, AreOfTheCatalogueAndMutual) {
  for (const std::string& key : catalogue_keys()) {
    for (const LookAlike& pair : describe(make_effect(key)).pairs) {
      EXPECT_EQ(discriminating_experiment(key, pair.key), pair.test);
      EXPECT_EQ(discriminating_experiment(pair.key, key), pair.test);
      EXPECT_EQ(describe(make_effect(pair.key)).key, pair.key);
    }
  }
  EXPECT_NE(discriminating_experiment("heating", "run-in").find("pause"), std::string::npos);
  EXPECT_EQ(discriminating_experiment("heating", "interference"), "");
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(every_name()), [](const auto& key) {
  std::string name = key.param;
  for (char& c : name) c = c == '-' || c == ':' ? '_' : c;
  return name;
});

}  // namespace
