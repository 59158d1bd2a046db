#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lagging.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
using workbench_test::lagging;

Identification identified(const Selection& selection) {
  IdentifyOptions options;
  options.read.conditions.radius = {0.015, "command line"};
  options.laws = {Law(ExponentialLaw{})};
  options.selection = selection;
  return identify(lagging().path, options);
}

TEST(Selection, of_cycles_takes_just_those) {
  const Identification all = identified({});
  const Identification some = identified({Selection::Cycles{3, 12}, {}});
  ASSERT_FALSE(all.fits.empty());
  ASSERT_FALSE(some.fits.empty());
  EXPECT_EQ(all.segmentation.cycles.size(), some.segmentation.cycles.size());
  EXPECT_EQ(some.fits[0].cycles, 10u);
  EXPECT_EQ(all.fits[0].cycles, all.segmentation.cycles.size());
}

TEST(Selection, leaves_out_every_cycle_that_reaches_into_a_stretch) {
  const Identification all = identified({});
  const double from = all.motion.time[all.segmentation.cycles[5].slip.begin];
  const double to = all.motion.time[all.segmentation.cycles[7].slip.begin];
  const Identification some = identified({std::nullopt, {{from, to}}});
  // The cycles 5 and 6 wholly or in part, and the stick of 7.
  EXPECT_EQ(some.fits[0].cycles + 3, all.fits[0].cycles);
  EXPECT_LT(some.fits[0].observations, all.fits[0].observations);
}

TEST(Selection, hides_a_bang_from_the_fit) {
  Trace trace = *read_input({lagging().path, {}, {}}, {});
  trace.conditions.radius = {0.015, "command line"};
  IdentifyOptions options;
  options.laws = {Law(ExponentialLaw{})};
  const auto fit_of = [&](const Trace& record, const Selection& selection) {
    options.selection = selection;
    Identification out = prepare_trace({"made", {}, std::make_shared<const Trace>(record)}, options);
    fit_trace(options, out);
    return out.fits.at(0);
  };
  const Fit clean = fit_of(trace, {});
  const auto at = [&](double time) {
    return static_cast<std::size_t>(std::lower_bound(trace.time.begin(), trace.time.end(), time) - trace.time.begin());
  };
  for (std::size_t i = at(4.0); i < at(4.3); ++i) trace.friction[i] += 0.2;
  const Fit banged = fit_of(trace, {}), spared = fit_of(trace, {std::nullopt, {{3.95, 4.35}}});
  EXPECT_GT(banged.error.rmse, 1.3 * clean.error.rmse);
  EXPECT_NEAR(spared.error.rmse, clean.error.rmse, 0.05 * clean.error.rmse);
  EXPECT_NEAR(spared.parameters[0].value, clean.parameters[0].value, 3 * clean.parameters[0].std_error);
}

TEST(Selection, of_too_little_is_no_analysis) {
  const Identification few = identified({Selection::Cycles{0, 1}, {}});
  EXPECT_FALSE(few.analysed);
  EXPECT_THAT(few.warnings.back(), HasSubstr("fewer than three cycles"));
}

TEST(CommandLine, starts_and_bounds_reach_the_fit) {
  const Outcome out = lagging().workshop.identify(
      "--radius 15mm --law exponential --start mu_s=0.45 --bounds alpha=1..2s/m,mu_k=0.3..0.3 --json - lag.csv");
  ASSERT_EQ(out.status, 0) << out.err;
  const Json parameters = Json::parse(out.out)["fits"][0]["parameters"];
  EXPECT_NEAR(parameters[0]["start"].get<double>(), 0.45, 1e-12);
  EXPECT_NEAR(parameters[1]["value"].get<double>(), 0.3, 1e-12);   // held
  EXPECT_NEAR(parameters[2]["value"].get<double>(), 0.002, 1e-6);  // s/mm, on its upper bound
  EXPECT_TRUE(parameters[2]["at_bound"].get<bool>());
  EXPECT_FALSE(parameters[1]["at_bound"].get<bool>());
}

TEST(CommandLine, refuses_what_it_cannot_mean) {
  const auto refused = [](const std::string& options) {
    const Outcome out = lagging().workshop.identify("--radius 15mm " + options + " lag.csv");
    EXPECT_EQ(out.status, 2) << options;
    return out.err;
  };
  EXPECT_THAT(refused("--start mus=0.5"), HasSubstr("did you mean 'mu_s'"));
  EXPECT_THAT(refused("--start tau=2ms"), HasSubstr("no parameter 'tau'"));
  EXPECT_THAT(refused("--start alpha=2mm"), HasSubstr("'2mm' is a length, not an inverse velocity"));
  EXPECT_THAT(refused("--start alpha"), HasSubstr("NAME=VALUE"));
  EXPECT_THAT(refused("--bounds alpha=0.2..0.1s/mm"), HasSubstr("from high to low"));
  EXPECT_THAT(refused("--bounds alpha=0.2"), HasSubstr("not a range; write it as alpha="));
  EXPECT_THAT(refused("--start mu_s=0.9 --bounds mu_s=0.1..0.2"), HasSubstr("beyond"));
  EXPECT_THAT(refused("--cycles 5"), HasSubstr("not a range; write it as 3..40"));
  EXPECT_THAT(refused("--cycles 7..5"), HasSubstr("FIRST..LAST"));
  EXPECT_THAT(refused("--exclude 3s..2s"), HasSubstr("earlier to a later"));
  EXPECT_THAT(refused("--exclude 3mm..4mm"), HasSubstr("'3mm' is a length, not a time"));
}

}  // namespace
}  // namespace tribofit
