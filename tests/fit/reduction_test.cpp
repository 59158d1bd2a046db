/// Searches run on fewer values than there are. What they find is what all values say: each parameter within a
/// hundredth of its standard error of a fit that never saw means.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fit/model_residuals.hpp"
#include "fit/observing.hpp"
#include "fit/starts.hpp"
#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace {

using namespace tribofit;

/// Where all values lead from p: passes of the whole problem, with the scatter of break-away seen anew in each, until
/// nothing moves.
std::vector<double> of_all_values(const FrictionModel& model, const Observations& observations, std::vector<double> p) {
  const Bounds bounds = bounds_of(model, observations);
  const ModelResiduals plain(model, observations, all_slips(observations));
  for (int pass = 0; pass < 12; ++pass) {
    const ModelResiduals::Whitening whitening = plain.whitening_at(p.data());
    ModelResiduals residuals(model, observations, all_slips(observations));
    residuals.whiten(whitening, true);
    p = minimize(residuals, p, bounds.lower, bounds.upper, {.max_iterations = 40, .relative_cost = 1e-12}).p;
  }
  return p;
}

struct Case {
  const char* name;
  Law law;
  std::vector<Effect> effects;
  std::vector<double> extra;  ///< SI values of their parameters
};

class Reduction : public testing::TestWithParam<Case> {};

TEST_P(Reduction, MovesNoParameterByAHundredthOfItsStandardError) {
  const Case& c = GetParam();
  const FrictionModel model(c.law, c.effects);
  std::vector<double> truth = synthetic::table4_15mm(c.law);
  truth.insert(truth.end(), c.extra.begin(), c.extra.end());
  synthetic::Options options;
  options.noise = 0.003;
  options.scatter = 0.004;
  options.cycles = 30;
  options.seed = 11;
  const synthetic::Record record = synthetic::make(model, truth, options);
  const Observations all = observe(record.motion, record.segmentation, model.needs(), 0);
  ASSERT_TRUE(reduced_for_search(model, all, 100).has_value());
  const Fit fit = fit_model(model, record.motion, record.segmentation, all);
  ASSERT_TRUE(fit.converged);
  const std::vector<double> p = of_all_values(model, all, truth);
  for (std::size_t k = 0; k < p.size(); ++k) {
    EXPECT_NEAR(fit.parameters[k].value, p[k], 0.01 * fit.parameters[k].std_error) << fit.parameters[k].parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Reduction,
    testing::Values(Case{"lag", Law(ExponentialLaw{}), {make_effect("frictional-lag")}, {2e-3}},
                    Case{"rate_state", Law(ExponentialLaw{}), {make_effect("rate-state")}, {60e-6, 0.004}},
                    Case{"bandwidth", Law(ExponentialLaw{}), {make_effect("force-bandwidth")}, {150, 0.7}}),
    [](const auto& c) { return std::string(c.param.name); });

/// Means of the channels, the spread of v_r within them, and which values belong to which slip.
TEST(Reduced, KeepsMeansAndWeights) {
  synthetic::Options options;
  options.cycles = 4;
  const FrictionModel law(ExponentialLaw{});
  const synthetic::Record record = synthetic::make(law, synthetic::table4_15mm(ExponentialLaw{}), options);
  const Observations all = observe(record.motion, record.segmentation, {.angle = true}, 0);
  const Observations few = reduced(all, 7), at_once = observe(record.motion, record.segmentation, {.angle = true}, 143);
  ASSERT_EQ(at_once.samples_per_value, 7u);
  EXPECT_EQ(few.samples_per_value, 7u);
  ASSERT_EQ(few.size(), at_once.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few.weight[i], at_once.weight[i]);
    EXPECT_NEAR(few.time[i], at_once.time[i], 1e-12);
    EXPECT_NEAR(few.friction[i], at_once.friction[i], 1e-12);
    EXPECT_NEAR(few.velocity[i], at_once.velocity[i], 1e-12);
    EXPECT_NEAR(few.velocity_variance[i], at_once.velocity_variance[i], 1e-12);
    EXPECT_NEAR(few.angle[i], at_once.angle[i], 1e-12);
  }
  for (std::size_t k = 0; k < few.slips.size(); ++k) {
    EXPECT_EQ(few.slips[k].begin, at_once.slips[k].begin);
    EXPECT_EQ(few.slips[k].end, at_once.slips[k].end);
    EXPECT_EQ(few.slips[k].earlier_begin, at_once.slips[k].earlier_begin);
    EXPECT_EQ(few.slips[k].earlier_end, at_once.slips[k].earlier_end);
  }
}

}  // namespace
