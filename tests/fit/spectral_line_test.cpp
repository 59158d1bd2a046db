/// A line of fixed frequency is found without a start for its frequency.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fit/fit_laws.hpp"
#include "fit/spectral_lines.hpp"
#include "fit/starts.hpp"
#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"

namespace {

using namespace tribofit;

TEST(SpectralLine, OfAnyFrequencyIsFoundWithoutAStart) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("interference")});
  for (const double frequency : {31.3, 50.0, 412.7}) {
    synthetic::Options options;
    options.noise = 0.003;
    synthetic::Record made = synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, options);
    for (std::size_t i = 0; i < made.motion.size(); ++i) {
      made.motion.friction[i] += 0.01 * std::cos(2 * std::numbers::pi * frequency * made.motion.time[i] + 1);
    }
    const Record record = {&made.motion, &made.segmentation};
    const Fit fit = fit_model(model, {&record, 1}, observations_for(model, {&record, 1}));
    EXPECT_NEAR(fit.parameters.at(3).value, 0.01, 0.0005) << frequency;
    EXPECT_NEAR(fit.parameters.at(4).value, frequency, 0.02) << frequency;
  }
}

TEST(SpectralLine, ThoseOfARecordAreThoseThatAnyFitWouldFind) {
  synthetic::Options options;
  options.noise = 0.003;
  synthetic::Record made = synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, options);
  for (std::size_t i = 0; i < made.motion.size(); ++i) {
    const double turn = 2 * std::numbers::pi * made.motion.time[i];
    made.motion.friction[i] += 0.01 * std::cos(50 * turn) + 0.02 * std::cos(412.7 * turn);
  }
  const Record record = {&made.motion, &made.segmentation};
  const Observations observations = observe(made.motion, made.segmentation, {}, 0);
  LinesOfRecord lines;
  for (const double highest : {1000.0, 1000.0, 200.0, 1000.0}) {  // known, and anew for other limits
    const SpectralLines found = lines.find(record, observations, 20, highest, 2);
    ASSERT_FALSE(found.frequencies.empty());
    EXPECT_LT(found.frequencies[0], highest);
    if (highest > 412.7) {
      EXPECT_NEAR(found.frequencies[0], 412.7, 0.02);
    }
    EXPECT_EQ(found.frequencies,
              strongest_lines(record, observations, about_mean_curve(observations), 20, highest).frequencies);
  }
}

}  // namespace
