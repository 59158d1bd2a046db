#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"

namespace {

using namespace tribofit;

/// Every systematic part against a rerun with the quantity moved by its uncertainty.
struct Moved {
  const char* name;
  Instruments instruments;
  double (*friction)(double mu);
  double (*velocity)(double v, double disc);
};

class Systematic : public testing::TestWithParam<Protocol> {};

TEST_P(Systematic, PartIsWhatARerunWithTheMovedQuantityGives) {
  Instruments zero, gain, vibrometer, load;
  zero.force_sensor.zero = Declared{0, 0.002};
  gain.force_sensor.gain = Declared{1, 0.01};
  vibrometer.vibrometer.gain = Declared{1, 0.01};
  load.rig.load = Declared{50, 0.5};
  const auto same = [](double x) { return x; };
  const auto same_velocity = [](double v, double) { return v; };
  const Moved cases[] = {
      {"zero", zero, [](double mu) { return mu - 0.002; }, same_velocity},
      {"force gain", gain, [](double mu) { return mu / 1.01; }, same_velocity},
      {"load", load, [](double mu) { return mu / 1.01; }, same_velocity},
      {"vibrometer gain", vibrometer, same, [](double v, double disc) { return disc - (disc - v) / 1.01; }}};
  const FrictionModel model(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.001;
  const synthetic::Record record = synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options);
  FitOptions with;
  with.protocol = GetParam();
  for (const Moved& c : cases) {
    const Fit fit = fit_model(model, record.motion, record.segmentation, observe(record.motion, record.segmentation),
                              c.instruments, with);
    synthetic::Record moved = record;
    for (double& mu : moved.motion.friction) mu = c.friction(mu);
    for (double& v : moved.motion.relative_velocity) v = c.velocity(v, moved.motion.constant_disc_velocity);
    for (Cycle& cycle : moved.segmentation.cycles) {
      for (double* level : {&cycle.break_away_friction, &cycle.stick_maximum, &cycle.slip_minimum})
        *level = c.friction(*level);
    }
    const Fit again =
        fit_model(model, moved.motion, moved.segmentation, observe(moved.motion, moved.segmentation), {}, with);
    for (std::size_t k = 0; k < 3; ++k) {
      const double change = std::abs(again.parameters[k].value - fit.parameters[k].value);
      EXPECT_NEAR(fit.parameters[k].systematic, change, 0.03 * change + 2e-5 * fit.parameters[k].value)
          << c.name << " " << fit.parameters[k].parameter.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Protocols, Systematic, testing::Values(Protocol::joint, Protocol::published),
                         [](const auto& protocol) { return std::string(to_string(protocol.param)); });

}  // namespace
