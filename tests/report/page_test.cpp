#include "tribofit/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "made_up.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kDataBegin = "id=\"data\">";

std::string embedded_text(const std::string& page) {
  const std::size_t begin = page.find(kDataBegin) + kDataBegin.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

json data_of(const std::string& page) {
  return json::parse(embedded_text(page));
}

class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_report_page()) GTEST_SKIP() << "this build leaves the page out";
  }
};

TEST(PageLeftOut, IsSaid) {
  if (has_report_page()) GTEST_SKIP() << "this build has the page";
  EXPECT_THROW(report_page(made_up_result()), InputError);
}

TEST_F(Page, HoldsTheResultAsJsonSaysIt) {
  PageOptions options;
  options.arguments = {"--radius", "15mm"};
  const json data = data_of(report_page(made_up_result(), options));
  EXPECT_EQ(data["kind"], "trace");
  EXPECT_EQ(data["result"]["trace"]["path"], "runs/r15.csv");
  EXPECT_EQ(data["result"]["tool"]["arguments"], json({"--radius", "15mm"}));
  EXPECT_EQ(data["command"], "identify --radius 15mm runs/r15.csv");
  EXPECT_EQ(data["models"][0]["rows"][0][0], "mu_s");
  EXPECT_EQ(data["models"][0]["rows"][0][1], "0.5090");
  EXPECT_EQ(data["models"][0]["rows"][0][3], "0.0012");
  EXPECT_EQ(data["protocols"].size(), 3u);
  EXPECT_EQ(data["curves"].size(), 3u);
  // The best fit comes first beside the samples; the published protocol has a curve only.
  EXPECT_EQ(data["traces"][0]["models"], json({"exponential", "fractional"}));
}

TEST_F(Page, ShowsTheBlockVelocityAndTheDisc) {
  const json record = data_of(report_page(made_up_result()))["traces"][0]["record"];
  // omega r is 6.28 mm/s: the block moves with the disc in stick and swings back in slip.
  EXPECT_NEAR(record["velocity"]["y"][0].get<double>(), 6.28, 1e-6);
  EXPECT_NEAR(record["velocity"]["y"][4].get<double>(), 6.28 - 80, 1e-3);
  EXPECT_NEAR(record["disc"]["y"][0].get<double>(), 6.28, 1e-6);
}

TEST_F(Page, ResidualsOfTheTrueLawAreNought) {
  const json trace = data_of(report_page(made_up_result()))["traces"][0];
  for (const json& branch : trace["residuals"][0]) {
    for (const json& value : branch["middle"]) EXPECT_NEAR(value.get<double>(), 0, 1e-9);
  }
  for (const json& error : trace["errors"][0]["over_speed"]["largest"]) EXPECT_NEAR(error.get<double>(), 0, 1e-9);
}

TEST_F(Page, HoldsTheDiagnosis) {
  const json data = data_of(report_page(made_up_diagnosis()));
  EXPECT_EQ(data["kind"], "diagnosis");
  EXPECT_EQ(data["result"]["diagnosis"]["ladder"].size(), 2u);
  EXPECT_EQ(data["traces"][0]["models"], json({"exponential + runout", "exponential"}));
  EXPECT_THAT(data["command"].get<std::string>(), HasSubstr("identify diagnose"));
}

TEST_F(Page, NoNameIsTakenForMarkup) {
  Identification result = made_up_result();
  result.path = "runs/</script><script>alert(1)</script><!--&\xff.csv";
  result.notes = {"</SCRIPT>", "]]>"};
  const std::string page = report_page(result);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(embedded_text(page), Not(HasSubstr("<")));
  EXPECT_THAT(page, HasSubstr("<title>script&gt;&lt;!--&amp;\xEF\xBF\xBD.csv</title>"));
  EXPECT_EQ(data_of(page)["result"]["notes"], nullptr);
  EXPECT_EQ(data_of(page)["result"]["trace"]["notes"][0], "</SCRIPT>");
}

TEST_F(Page, LoadsNothingFromElsewhere) {
  const std::string page = report_page(made_up_result());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("unsafe-eval'")));
}

/// A noisy record of many cycles, so that nothing is left out because it is smooth.
Identification long_result(std::size_t samples) {
  Identification result = made_up_result();
  Motion& motion = result.motion;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 1);
  motion.step = 5e-5;
  motion.time.resize(samples);
  motion.friction.resize(samples);
  motion.relative_velocity.resize(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    motion.time[i] = motion.step * static_cast<double>(i);
    motion.friction[i] = 0.4 + 0.01 * noise(random);
    motion.relative_velocity[i] = 0.04 * std::abs(noise(random));
  }
  const Cycle cycle = result.segmentation.cycles[1];
  result.segmentation.cycles.clear();
  for (std::size_t begin = 0; begin + 400 <= samples; begin += 400) {
    Cycle c = cycle;
    c.stick = {begin, begin + 300};
    c.slip = {begin + 300, begin + 400};
    c.stick_complete = c.slip_complete = true;
    c.break_away_time = motion.time[begin + 300];
    c.restick_time = motion.time[begin + 399];
    result.segmentation.cycles.push_back(c);
  }
  return result;
}

TEST_F(Page, IsBelowFourMegabytesForALongNoisyRecord) {
  constexpr std::size_t kMost = 4000000;
  const Identification result = long_result(3000000);
  EXPECT_LT(report_page(result).size(), kMost);
  DiagnosedTraces many = made_up_diagnosis();
  many.traces.assign(12, long_result(200000));
  const std::string page = report_page(many);
  EXPECT_LT(page.size(), kMost);
  EXPECT_EQ(data_of(page)["traces"].size(), 8u);
}

TEST_F(Page, ShowsASpikeOfOneSample) {
  Identification result = long_result(400000);
  result.motion.friction[123457] = 3.25;
  const json friction = data_of(report_page(result))["traces"][0]["record"]["friction"];
  EXPECT_EQ(*std::max_element(friction["y"].begin(), friction["y"].end()), 3.25);
}

TEST_F(Page, IsMadeOfDataThatCarryNoAnalysis) {
  Identification result;
  result.path = "empty.csv";
  result.analysed = false;
  EXPECT_EQ(data_of(report_page(result))["traces"][0]["models"].size(), 0u);
  EXPECT_EQ(data_of(report_page(DiagnosedTraces{}))["traces"].size(), 0u);
  Identification sliding = long_result(5000);
  sliding.segmentation.kind = MotionKind::always_slipping;
  sliding.segmentation.cycles.resize(1);
  sliding.segmentation.cycles[0].stick = {0, 0};
  sliding.segmentation.cycles[0].slip = {0, 5000};
  const json trace = data_of(report_page(sliding))["traces"][0];
  EXPECT_EQ(trace["branches"].size(), 1u);
  EXPECT_FALSE(trace.contains("cycles"));
}

}  // namespace
}  // namespace tribofit
