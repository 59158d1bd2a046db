#include "tribofit/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "long_result.hpp"
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
  EXPECT_THROW(report_page(report_of(made_up_result())), InputError);
}

TEST_F(Page, NoNameIsTakenForMarkup) {
  Identification result = made_up_result();
  result.path = "runs/</script><script>alert(1)</script><!--&\xff.csv";
  result.notes = {"</SCRIPT>", "]]>"};
  const std::string page = report_page(report_of(result));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(embedded_text(page), Not(HasSubstr("<")));
  EXPECT_THAT(page, HasSubstr("<title>script&gt;&lt;!--&amp;\xEF\xBF\xBD.csv</title>"));
  EXPECT_THAT(data_of(page)["sections"].back()["items"].dump(), HasSubstr("\"</SCRIPT>\""));
}

TEST_F(Page, LoadsNothingFromElsewhere) {
  const std::string page = report_page(report_of(made_up_result()));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("unsafe-eval'")));
}

TEST_F(Page, IsBelowFourMegabytesForALongNoisyRecord) {
  constexpr std::size_t kMost = 4000000;
  const Identification result = long_result(3000000);
  EXPECT_LT(report_page(report_of(result)).size(), kMost);
  DiagnosedTraces many = made_up_diagnosis();
  many.traces.assign(12, long_result(200000));
  const std::string page = report_page(report_of(many));
  EXPECT_LT(page.size(), kMost);
}

TEST_F(Page, LeavesOutWhatIsForATerminal) {
  ReportSection section{"one", "One", {}}, terminal{"two", "Two", {}, Medium::terminal};
  section.plain("for all");
  section.plain("for a terminal", Medium::terminal);
  section.add(ReportFacts{{{"radius", "15 mm"}}});
  terminal.plain("elsewhere");
  Report report;
  report.add({terminal, section});
  const json sections = data_of(report_page(report))["sections"];
  ASSERT_EQ(sections.size(), 1u);
  ASSERT_EQ(sections[0]["items"].size(), 2u);
  EXPECT_EQ(sections[0]["items"][0]["text"], "for all");
  EXPECT_EQ(sections[0]["items"][1]["facts"], json::parse(R"([["radius", "15 mm"]])"));
}

TEST_F(Page, AChartIsAsItWasDescribed) {
  Chart chart;
  chart.id = "one";
  chart.x = {"time", "s"};
  chart.panels[0] = {"v_{r}", "mm/s"};
  chart.lines.push_back({"a", {0, 1, 2}, {1, std::nan(""), 0.123456789}, {Colour::red, Dash::dotted, Symbol::square}});
  Report report;
  report.kind = "study";
  report.title = "x";
  report.sections = {{"s", "S", {chart}}};
  const json line = data_of(report_page(report))["sections"][0]["items"][0]["lines"][0];
  EXPECT_EQ(line["stroke"]["colour"], "red");
  EXPECT_EQ(line["stroke"]["dash"], "dot");
  EXPECT_EQ(line["stroke"]["symbol"], "square");
  EXPECT_EQ(line["x"], json({0, 1, 2}));
  EXPECT_EQ(line["y"], json({1, nullptr, 0.12346}));
}

}  // namespace
}  // namespace tribofit
