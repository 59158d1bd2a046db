#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"

namespace {

using namespace tribofit;

/// A record that begins a few samples before a break-away does not show how fast the spring pulled there. A reading
/// that is late looks back along that stick all the same.
TEST(SlipRanges, AStickOfWhichLittleWasRecordedPullsLikeTheOthers) {
  for (const double direction : {1.0, -1.0}) {
    const FrictionModel model(ExponentialLaw{}, {make_effect("channel-delay")});
    std::vector<double> truth = synthetic::table4_15mm(ExponentialLaw{});
    truth.push_back(1e-3);
    synthetic::Options options;
    options.noise = 0.003;
    options.cycles = 15;
    options.direction = direction;
    synthetic::Record record = synthetic::make(model, truth, options);
    record.segmentation.cycles[0].stick_slope = std::numeric_limits<double>::quiet_NaN();
    const Observations all = observe(record.motion, record.segmentation, model.needs(), 0);
    const Fit fit = fit_model(model, record.motion, record.segmentation, all);
    ASSERT_TRUE(fit.converged) << direction;
    EXPECT_NEAR(fit.parameters[3].value, 1e-3, 4 * fit.parameters[3].std_error) << direction;
    EXPECT_LT(fit.parameters[3].std_error, 5e-5) << direction;
  }
}

}  // namespace
