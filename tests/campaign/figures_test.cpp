/// The figures of [D] as data, against signals and laws that are known.
#include "tribofit/campaign/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "../recovery/twin.hpp"
#include "campaign/kept_samples.hpp"

namespace {

using namespace tribofit;

/// A twin of the 15 mm test with both laws fitted by both protocols.
const Identification& analysed_twin() {
  static const Identification result = [] {
    recovery::TwinOptions options;
    options.duration = 12;
    recovery::Twin twin = recovery::make_twin(options);
    Identification out;
    for (const Protocol protocol : {Protocol::joint, Protocol::published}) {
      for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
        out.fits.push_back(recovery::fit_twin(twin, law, protocol));
      }
    }
    out.motion = std::move(twin.motion);
    out.segmentation = std::move(twin.segmentation);
    out.spectral_peak = fundamental(out.motion.relative_velocity, out.motion.step);
    return out;
  }();
  return result;
}

/// 12 s of a signal with the first and third harmonic of 4.13 Hz.
Identification signal_of(double rate) {
  Identification result;
  Motion& motion = result.motion;
  motion.step = 1 / rate;
  for (int i = 0; i < static_cast<int>(12 * rate); ++i) {
    const double t = i / rate, turn = 2 * std::numbers::pi * 4.13 * t;
    motion.time.push_back(t);
    motion.relative_velocity.push_back(0.050 + 0.030 * std::sin(turn) + 0.010 * std::cos(3 * turn));
    motion.friction.push_back(0.4);
  }
  result.spectral_peak.frequency = 4.13;
  return result;
}

TEST(Figures, AmplitudesOfTheLinesOfAKnownSignal) {
  for (const double rate : {20e3, 1e3}) {  // 32768 samples, and 1638, which the transform pads
    const RunFigures figures = figures_of(signal_of(rate));
    ASSERT_EQ(figures.harmonics.size(), 8u);
    EXPECT_NEAR(figures.harmonics[0].amplitude, 30, 0.3);
    EXPECT_NEAR(figures.harmonics[1].amplitude, 0, 0.3);
    EXPECT_NEAR(figures.harmonics[2].amplitude, 10, 0.1);
    EXPECT_NEAR(figures.harmonics[2].frequency, 12.39, 1e-9);
    EXPECT_TRUE(figures.errors.empty());
    EXPECT_TRUE(figures.time.empty());
    if (rate == 20e3) {
      EXPECT_DOUBLE_EQ(figures.spectrum_step, 20e3 / 32768);  // the bins of [D]
    }
  }
}

TEST(Figures, TheErrorCurveIsThatOfTheFitOverSpeed) {
  const Identification& result = analysed_twin();
  const RunFigures figures = figures_of(result);
  ASSERT_EQ(figures.errors.size(), 4u);
  ASSERT_EQ(figures.bin_samples.size(), 40u);
  double fastest = 0;
  for (const Cycle& cycle : result.segmentation.cycles) fastest = std::max(fastest, cycle.peak_velocity);
  EXPECT_NEAR(40 * figures.bin_width, 1e3 * fastest, 0.2);
  const double samples =
      static_cast<double>(std::accumulate(figures.bin_samples.begin(), figures.bin_samples.end(), std::size_t{0}));
  for (std::size_t k = 0; k < 4; ++k) {
    const Fit& fit = result.fits[k];
    const ErrorCurve& curve = figures.errors[k];
    EXPECT_EQ(curve.law, to_string(fit.model.law()));
    EXPECT_EQ(curve.protocol, to_string(fit.protocol));
    EXPECT_NEAR(curve.mean_relative, fit.error.mean_relative, 1e-12);
    EXPECT_NEAR(curve.max_relative, fit.error.max_relative, 1e-12);
    double sum = 0, largest = 0;
    for (std::size_t b = 0; b < 40; ++b) {
      if (figures.bin_samples[b] == 0) continue;
      sum += static_cast<double>(figures.bin_samples[b]) * curve.bin_mean_relative[b];
      largest = std::max(largest, curve.bin_max_relative[b]);
    }
    EXPECT_NEAR(sum / samples, curve.mean_relative, 1e-12);
    EXPECT_EQ(largest, curve.max_relative);
  }
  // The law of Table 4 that the twin was made with, in the middle of the bins.
  for (std::size_t b = 5; b < 35; ++b) {
    const double v = (static_cast<double>(b) + 0.5) * figures.bin_width;
    EXPECT_NEAR(figures.bin_friction[b], 0.318 + 0.191 * std::exp(-0.05214 * v), 0.002) << v;
    EXPECT_NEAR(figures.errors[0].fitted[b], 0.318 + 0.191 * std::exp(-0.05214 * v), 0.002) << v;
  }
}

TEST(Figures, SharesBelowTheLimitOfD) {
  Identification result = analysed_twin();
  const RunFigures good = figures_of(result);
  EXPECT_EQ(good.errors[0].below_limit, 1);
  EXPECT_EQ(good.errors[0].bins_below_limit, 1);
  EXPECT_LT(good.errors[0].largest_of_bins, 0.01);
  for (double& mu : result.motion.friction) mu *= 1.2;  // every e near 1/6
  const RunFigures wrong = figures_of(result);
  EXPECT_EQ(wrong.errors[0].below_limit, 0);
  EXPECT_EQ(wrong.errors[0].bins_below_limit, 0);
  EXPECT_NEAR(wrong.errors[0].mean_relative, 1.0 / 6, 0.005);
}

TEST(Figures, ThreeWholeCyclesInOrder) {
  const RunFigures figures = figures_of(analysed_twin());
  EXPECT_EQ(figures.time.size(), 180u);
  EXPECT_TRUE(std::is_sorted(figures.time.begin(), figures.time.end()));
  EXPECT_NEAR(figures.time.back() - figures.time.front(), 3 / 4.883, 0.03);
  EXPECT_EQ(figures.velocity.size(), 180u);
  EXPECT_NEAR(*std::max_element(figures.velocity.begin(), figures.velocity.end()), 84, 2);
}

TEST(Figures, ComeBackFromTheirText) {
  const RunFigures figures = figures_of(analysed_twin());
  const std::string text = line_of(json_of(figures));
  EXPECT_LT(text.size(), 14000u);
  const RunFigures back = read_from<RunFigures>(Json::parse(text));
  EXPECT_EQ(back.bin_samples, figures.bin_samples);
  ASSERT_EQ(back.errors.size(), 4u);
  EXPECT_NEAR(back.errors[2].fitted[7], figures.errors[2].fitted[7], 1e-6);
  EXPECT_NEAR(back.errors[3].max_relative, figures.errors[3].max_relative, 1e-6);
  EXPECT_EQ(back.harmonics.size(), figures.harmonics.size());
  EXPECT_EQ(line_of(json_of(back)), text);
}

}  // namespace
