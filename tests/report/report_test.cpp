#include "tribofit/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "long_result.hpp"
#include "made_up.hpp"

namespace tribofit {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Kind>
std::vector<Kind> all(const Report& report) {
  std::vector<Kind> found;
  for (const ReportSection& section : report.sections) {
    for (const ReportItem& item : section.items) {
      if (const auto* one = std::get_if<Kind>(&item)) found.push_back(*one);
    }
  }
  return found;
}

/// The chart of that id; an empty one where there is none.
Chart chart_of(const Report& report, const std::string& id) {
  for (const Chart& chart : all<Chart>(report)) {
    if (chart.id == id) return chart;
  }
  return {};
}

std::string commands_of(const Report& report) {
  std::string text;
  for (const ReportText& item : all<ReportText>(report)) {
    if (item.kind == ReportText::Kind::command) text += item.text + "\n";
  }
  return text;
}

TEST(ReportOfATrace, HoldsCommandParametersAndBothProtocols) {
  ReportOptions options;
  options.arguments = {"--radius", "15mm"};
  const Report report = report_of(made_up_result(), options);
  EXPECT_EQ(report.title, "r15.csv");
  EXPECT_THAT(commands_of(report), HasSubstr("identify --radius 15mm runs/r15.csv\n"));
  const std::vector<ReportTable> tables = all<ReportTable>(report);
  const auto parameters = std::find_if(
      tables.begin(), tables.end(), [](const ReportTable& table) { return table.columns.front().name == "parameter"; });
  ASSERT_NE(parameters, tables.end());
  EXPECT_THAT(parameters->rows[0],
              ElementsAre("mu_s", "0.5090", "0.0012", "(0.24 %)", ::testing::_, "1", ::testing::_));
  const auto protocols = std::find_if(tables.begin(), tables.end(),
                                      [](const ReportTable& table) { return table.columns[0].name == "law"; });
  ASSERT_NE(protocols, tables.end());
  EXPECT_EQ(protocols->rows.size(), 3u);
}

TEST(ReportOfATrace, BestLawComesFirstAndThePublishedProtocolCanBeSwitchedOn) {
  const Chart law = chart_of(report_of(made_up_result()), "t1-law");
  std::map<std::string, bool> shown;
  for (const ChartLine& line : law.lines) {
    if (line.panel == 0) shown.emplace(line.name, line.shown);
  }
  EXPECT_TRUE(shown.at("exponential"));
  EXPECT_TRUE(shown.at("fractional"));
  EXPECT_FALSE(shown.at("exponential, per-cycle extremes"));
}

TEST(ReportOfATrace, ShowsTheBlockVelocityAndTheDisc) {
  // omega r is 6.28 mm/s: the block moves with the disc in stick and swings back in slip.
  const Chart record = chart_of(report_of(made_up_result()), "t1-record");
  ASSERT_EQ(record.lines.size(), 3u);
  EXPECT_NEAR(record.lines[1].y[0], 6.28, 1e-6);
  EXPECT_NEAR(record.lines[1].y[4], 6.28 - 80, 1e-3);
  EXPECT_NEAR(record.lines[2].y[0], 6.28, 1e-6);
}

TEST(ReportOfATrace, ResidualsAndErrorsOfTheTrueLawAreNought) {
  const Report report = report_of(made_up_result());
  std::size_t residuals = 0;
  for (const ChartLine& line : chart_of(report, "t1-law").lines) {
    if (line.panel != 1 || line.name != "exponential") continue;
    for (const double value : line.y) EXPECT_NEAR(value, 0, 1e-9);
    residuals += line.y.size();
  }
  EXPECT_GT(residuals, 0u);
  for (const ChartLine& line : chart_of(report, "t1-error-speed").lines) {
    if (line.name.rfind("exponential", 0) != 0) continue;
    for (const double error : line.y) EXPECT_NEAR(error, 0, 1e-9);
  }
}

TEST(ReportOfATrace, EachChartHasItsOwnIdATitleAndUnits) {
  for (const Report& report : {report_of(long_result(40000)), report_of(made_up_diagnosis())}) {
    std::set<std::string> ids;
    for (const Chart& chart : all<Chart>(report)) {
      EXPECT_TRUE(ids.insert(chart.id).second) << chart.id;
      EXPECT_FALSE(chart.title.empty()) << chart.id;
      EXPECT_TRUE(!chart.x.unit.empty() || !chart.x.names.empty()) << chart.id;
      for (const ChartLine& line : chart.lines) {
        EXPECT_TRUE(line.y.empty() || line.y.size() == line.x.size()) << chart.id;
        EXPECT_EQ(line.low.size(), line.high.size()) << chart.id;
        EXPECT_LT(line.panel, chart.panels.size()) << chart.id;
      }
    }
    EXPECT_GT(ids.size(), 5u);
  }
}

TEST(ReportOfATrace, ShowsASpikeOfOneSample) {
  Identification result = long_result(400000);
  result.motion.friction[123457] = 3.25;
  const std::vector<double> friction = chart_of(report_of(result), "t1-record").lines[0].y;
  EXPECT_EQ(*std::max_element(friction.begin(), friction.end()), 3.25);
}

TEST(ReportOfATrace, ProfilesAreDrawnWhereTheyWereAskedFor) {
  Identification result = made_up_result();
  result.fits[0].parameters[2].profile = {{50, 4}, {52.14, 0}, {54, 4}};
  const Chart chart = chart_of(report_of(result), "best-profile-alpha");
  ASSERT_EQ(chart.lines.size(), 1u);
  EXPECT_NEAR(chart.lines[0].x[1], 0.05214, 1e-12);  // s/mm
  EXPECT_EQ(chart.lines[0].y[1], 0);
}

TEST(ReportOfADiagnosis, TheLadderFallsToItsFloor) {
  const Report report = report_of(made_up_diagnosis());
  EXPECT_THAT(commands_of(report), HasSubstr("identify diagnose"));
  const Chart ladder = chart_of(report, "ladder");
  EXPECT_THAT(ladder.x.names, ElementsAre("exponential law", "+ runout"));
  EXPECT_THAT(ladder.lines[0].y, ElementsAre(0.0088, 0.0032));
  EXPECT_EQ(ladder.marks[0].at, 0.0031);
  // (0.0088^2 - 0.0032^2)/(0.0088^2 - 0.0031^2) is 99.07 %; shares are never rounded up
  EXPECT_EQ(ladder.marks[1].text, "99.0 % gone");
}

TEST(ReportOfADiagnosis, ErrorsBeforeAndAfterStandBesideTheSameNames) {
  const Chart where = chart_of(report_of(made_up_diagnosis()), "where");
  EXPECT_THAT(where.panels[0].names, ElementsAre("velocity", "time", "angle", "whole error"));
  // Shares of the square above the noise floor: 2, 7 and 82 % of 0.0088^2 - 0.0031^2, 3 % of 0.0032^2 - 0.0031^2.
  const auto above = [](double share, double whole) {
    return ::testing::DoubleNear(std::sqrt(share * (whole * whole - 0.0031 * 0.0031)), 1e-12);
  };
  EXPECT_THAT(where.lines[0].x, ElementsAre(above(0.02, 0.0088), above(0.07, 0.0088), above(0.82, 0.0088), 0.0088));
  EXPECT_THAT(where.lines[1].x, ElementsAre(above(0.03, 0.0032), 0, 0, 0.0032));
}

TEST(ReportOfADiagnosis, OfManyTracesEightAreDrawn) {
  DiagnosedTraces many = made_up_diagnosis();
  many.traces.assign(12, long_result(4000));
  std::size_t records = 0;
  for (const Chart& chart : all<Chart>(report_of(many))) records += chart.title == "The whole record" ? 1u : 0u;
  EXPECT_EQ(records, 8u);
}

TEST(Report, IsMadeOfDataThatCarryNoAnalysis) {
  Identification result;
  result.path = "empty.csv";
  result.analysed = false;
  EXPECT_TRUE(all<Chart>(report_of(result)).empty());
  EXPECT_TRUE(all<Chart>(report_of(DiagnosedTraces{})).empty());
  Identification sliding = long_result(5000);
  sliding.segmentation.kind = MotionKind::always_slipping;
  sliding.segmentation.cycles.resize(1);
  sliding.segmentation.cycles[0].stick = {0, 0};
  sliding.segmentation.cycles[0].slip = {0, 5000};
  const Report report = report_of(sliding);
  EXPECT_TRUE(chart_of(report, "t1-cycles").id.empty());
  EXPECT_EQ(chart_of(report, "t1-law").lines.front().name, "measured, slip");
}

}  // namespace
}  // namespace tribofit
