#include "tribofit/report/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "../folder.hpp"
#include "drawn_svg.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::string kAwkward = "it's \"q\" \\n <b>&amp; %d 50% $x `ls` | @m v_{r} ^{2} ~ \\ {";

Report report_with(Chart chart) {
  Report report;
  report.kind = "test";
  report.sections.push_back({"one", "One", {ReportText{"words"}, std::move(chart)}});
  return report;
}

/// A line from (0, 0) to (10, 5) and a second one.
Chart straight_chart() {
  Chart chart;
  chart.id = "straight";
  chart.title = "A straight <line>";
  chart.note = "It is straight.";
  chart.x = {"speed |v_{r}|", "mm/s", 0, 10};
  chart.panels[0] = {"acceleration", "mm/s^{2}", 0, 5};
  ChartLine line{"straight", {}, {}, {Colour::blue}};
  for (int k = 0; k <= 1000; ++k) {
    line.x.push_back(k / 100.0);
    line.y.push_back(k / 200.0);
  }
  chart.lines = {line, {"other", {0, 10}, {4, 1}, {Colour::red, Dash::dashed}}};
  return chart;
}

const std::string kBlue = "#0072b2", kGreen = "#009e73";

class Pictures : public ::testing::Test {
 protected:
  std::string svg_of(const Chart& chart) {
    const std::string path = folder_.path("svg-" + std::to_string(++count_));
    PictureFiles(report_with(chart), path, PictureFormat::svg).commit();
    return contents(path + "/" + chart.id + ".svg");
  }
  Folder folder_;
  int count_ = 0;
};

TEST_F(Pictures, HaveTheWidthOfAColumn) {
  const std::string svg = svg_of(straight_chart());
  EXPECT_THAT(svg, HasSubstr("width=\"85mm\""));
  if (!can_write_pictures(PictureFormat::pdf)) GTEST_SKIP() << "there is no rsvg-convert (scripts/setup figures)";
  PictureFiles(report_with(straight_chart()), folder_.path("p"), PictureFormat::pdf).commit();
  const std::string pdf = contents(folder_.path("p/straight.pdf"));
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  std::smatch box;
  ASSERT_TRUE(std::regex_search(pdf, box, std::regex("/MediaBox \\[ *0 +0 +([0-9.]+) +([0-9.]+)")));
  EXPECT_NEAR(std::stod(box[1]) / 72 * 25.4, 85, 0.2);
  EXPECT_THAT(pdf, AllOf(HasSubstr("/FontFile"), HasSubstr("/Font")));  // embedded
  PictureFiles(report_with(straight_chart()), folder_.path("p"), PictureFormat::png).commit();
  const std::string png = contents(folder_.path("p/straight.png"));
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8U | static_cast<unsigned char>(png[at + k]);
    return value;
  };
  ASSERT_GT(png.size(), 100u);
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  const std::size_t dots = png.find("pHYs");
  ASSERT_NE(dots, std::string::npos);
  EXPECT_NEAR(number(16) / (number(dots + 4) / 1000.0), 85, 0.1);  // dots over dots a millimetre
}

TEST_F(Pictures, HoldTheirTextsAsText) {
  const std::string svg = svg_of(straight_chart());
  EXPECT_THAT(texts_of(svg), AllOf(Contains("speed |vr| [mm/s]"), Contains("acceleration [mm/s2]"),
                                   Contains("straight"), Contains("other")));
  EXPECT_EQ(parsed(svg).get<std::string>("svg.title"), "A straight <line>");
  EXPECT_THAT(texts_of(svg), Not(Contains(HasSubstr("A straight"))));  // the caption belongs to the paper
  EXPECT_EQ(contents(folder_.path("svg-1/figures.txt")), "straight.svg\nA straight <line>\nIt is straight.\n");
}

TEST_F(Pictures, AStraightLineEndsAtItsTics) {
  const std::string svg = svg_of(straight_chart());
  const auto points = path_in(svg, kBlue);
  ASSERT_EQ(points.size(), 2u);  // of 1001 samples on a line two are enough
  EXPECT_NEAR(points[0][0], word(svg, "0").x, 0.02);
  EXPECT_NEAR(points[1][0], word(svg, "10").x, 0.02);
  EXPECT_NEAR(points[1][1] - points[0][1], 5 * (word(svg, "5").y - word(svg, "3").y) / 2, 0.02);
  EXPECT_LT(points[1][1], points[0][1]);
}

TEST_F(Pictures, LogarithmicAxesHoldTheirValues) {
  Chart chart = straight_chart();
  chart.x = {"period", "s", 1, 1000, false, true};
  chart.lines = {{"decades", {1, 1000}, {0, 5}, {Colour::blue}},
                 {"middle", {10}, {2}, {Colour::red, {}, Symbol::circle}}};
  const std::string svg = svg_of(chart);
  const auto points = path_in(svg, kBlue);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0][0], word(svg, "1").x, 0.02);
  EXPECT_NEAR(points[1][0], word(svg, "1000").x, 0.02);
  EXPECT_LT(points[0][0], points[1][0]);
  EXPECT_NEAR(word(svg, "10").x, points[0][0] + (points[1][0] - points[0][0]) / 3, 0.02);
}

TEST_F(Pictures, AGapInALineStaysOne) {
  Chart chart = straight_chart();
  chart.lines[0].x = {0, 1, 2, 3, 4, 5};
  chart.lines[0].y = {0, 1, kNaN, 3, 2, 4};
  const std::string svg = svg_of(chart);
  const std::string drawn = plotted(svg), path = drawn.substr(drawn.find(" d=\"M"));
  EXPECT_EQ(std::count(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(path.find('"', 4)), 'M'), 2);
  EXPECT_EQ(path_in(svg, kBlue).size(), 5u);
}

TEST_F(Pictures, ASpikeOfOneSampleIsDrawn) {
  Chart chart = straight_chart();
  chart.panels[0].low = chart.panels[0].high = kFromData;
  chart.lines.resize(1);
  ChartLine& line = chart.lines[0];
  line.x.clear(), line.y.clear();
  for (int k = 0; k < 200000; ++k) {
    line.x.push_back(k / 20000.0);
    line.y.push_back(k == 123457 ? 5 : 0.01 * (k * 7919 % 101 - 50));
  }
  const std::string svg = svg_of(chart);
  EXPECT_LT(svg.size(), 200000u);
  const auto points = path_in(svg, kBlue);
  const auto highest = std::min_element(points.begin(), points.end(), [](auto& a, auto& b) { return a[1] < b[1]; });
  const double left = word(svg, "0").x, right = word(svg, "10").x;
  EXPECT_NEAR((*highest)[0], left + 0.617285 * (right - left), 0.02);
}

TEST_F(Pictures, NamesAreShownAsTheyAre) {
  Chart chart = straight_chart();
  chart.lines[0].name = kAwkward;
  chart.panels[0].quantity = "50% `d` $H \\a it's a_b {";
  chart.panels[0].part = 2;  // room for it on one line
  chart.marks = {{3, true, Dash::dotted, "it's `here` {"}, {2, false, Dash::dotted, "a \\ 100%"}};
  const std::string svg = svg_of(chart);
  EXPECT_THAT(texts_of(svg), AllOf(Contains(kAwkward), Contains("50% `d` $H \\a it's a_b { [mm/s2]"),
                                   Contains("it's `here` {"), Contains("a \\ 100%")));
  chart = straight_chart();
  chart.x = {"run", ""};
  chart.x.names = {kAwkward, "b\xff\nb", "c"};
  chart.lines.resize(1);
  EXPECT_THAT(texts_of(svg_of(chart)), AllOf(Contains("b\xEF\xBF\xBD b"), Contains(HasSubstr("it's \"q\" \\n <"))));
}

TEST_F(Pictures, WhatIsSwitchedOffIsLeftOut) {
  Chart chart = straight_chart();
  chart.lines[0].shown = false;
  chart.lines.push_back({"other", {0, 10}, {1, 1}, {Colour::green}});  // the legend has it already
  chart.lines.push_back({"third", {0, 10}, {2, 2}, {Colour::purple}});
  const std::string svg = svg_of(chart);
  EXPECT_THAT(texts_of(svg), AllOf(Contains("other").Times(1), Contains("third"), Not(Contains("straight"))));
  EXPECT_TRUE(path_in(svg, kBlue).empty());
  EXPECT_FALSE(path_in(svg, kGreen).empty());
}

TEST_F(Pictures, PanelsShareTheAbscissa) {
  Chart chart = straight_chart();
  chart.panels.push_back({.quantity = "residual", .unit = "1", .low = -1, .high = 1, .part = 0.5});
  chart.lines.push_back({"below", {0, 10}, {-1, 1}, {Colour::green}});
  chart.lines.back().panel = 1;
  chart.stretches = {{2, 4, Shade::stick}, {4, 5, Shade::slip}};
  const std::string svg = svg_of(chart);
  const auto above = path_in(svg, kBlue), below = path_in(svg, kGreen);
  ASSERT_EQ(above.size(), 2u);
  ASSERT_EQ(below.size(), 2u);
  EXPECT_NEAR(above[0][0], below[0][0], 0.02);
  EXPECT_NEAR(above[1][0], below[1][0], 0.02);
  EXPECT_GT(below[1][1], above[0][1]);  // lower on paper
  EXPECT_NEAR((above[0][1] - above[1][1]) / (below[0][1] - below[1][1]), 2, 0.01);
  EXPECT_THAT(texts_of(svg), AllOf(Contains("stick"), Contains("slip"), Contains("residual [1]")));
}

TEST_F(Pictures, AMapHasABoxForEachCellAndNoneForNaN) {
  Chart chart;
  chart.id = "map";
  chart.x = {"speed", "mm/s"};
  chart.panels[0] = {"damping", "1"};
  chart.map = HeatMap{{1, 2, 3}, {0, 1}, {{0, 1, 2}, {3, kNaN, 5}}, "amplitude", "mm"};
  const std::string svg = svg_of(chart);
  const std::string drawn = plotted(svg);
  const std::regex box("fill=\"#(..)(..)(..)\"");
  std::vector<double> lightness;
  for (std::sregex_iterator it(drawn.begin(), drawn.end(), box), end; it != end; ++it) {
    const auto channel = [&](std::size_t k) { return std::stoi((*it)[k], nullptr, 16); };
    lightness.push_back(0.2126 * channel(1) + 0.7152 * channel(2) + 0.0722 * channel(3));
  }
  const auto steps = static_cast<std::size_t>(sizes.colour_steps);
  ASSERT_EQ(lightness.size(), 5u + steps);                                // then those of the box beside the map
  EXPECT_TRUE(std::is_sorted(lightness.begin(), lightness.begin() + 5));  // the values rise in this order
  EXPECT_TRUE(std::is_sorted(lightness.begin() + 5, lightness.end()));
  EXPECT_GT(lightness[4] - lightness[0], 150);
  EXPECT_THAT(texts_of(svg), AllOf(Contains("amplitude [mm]"), Contains("speed [mm/s]"), Contains("damping [1]")));
}

TEST_F(Pictures, EveryFormatDrawsWhateverAChartHolds) {
  Chart full = straight_chart();
  full.id = "full";
  full.lines[0].low.assign(1001, 0.5);
  full.lines[0].high.assign(1001, 1.5);
  full.lines.push_back({"points", {1, 2, 3}, {1, 2, 1}, {Colour::purple, {}, Symbol::cross, 1, 5, false}});
  full.lines.push_back({"bars", {4, 5}, {1, 2}, {Colour::green, {}, Symbol::diamond}, {0.5, 1}, {2, 3}, true});
  full.marks = {{4, false, Dash::dotted, "limit"}, {2.5, true, Dash::dashed, "f_{1}"}};
  Chart empty;
  empty.id = "empty";
  Chart nothing = straight_chart();
  nothing.id = "nothing";
  nothing.x = {"x", "1"};
  nothing.panels[0] = {"y", "1"};
  nothing.lines = {{"gone", {kNaN, 1}, {1, kNaN}, {}}, {"short", {1, 2, 3}, {1}, {}}};
  Report report = report_with(full);
  report.sections.push_back({"two", "Two", {empty, nothing, full}});
  for (const PictureFormat format : {PictureFormat::svg, PictureFormat::pdf, PictureFormat::png}) {
    if (!can_write_pictures(format)) continue;
    const std::string path = folder_.path(name_of(format)), end = "." + name_of(format);
    PictureFiles(report, path, format).commit();
    for (const char* id : {"full", "empty", "nothing", "full-2"}) {
      EXPECT_GT(std::filesystem::file_size(path + "/" + id + end), 1000u) << id << end;
    }
  }
  const std::string once = contents(folder_.path("svg/full.svg"));
  PictureFiles(report, folder_.path("svg"), PictureFormat::svg).commit();
  EXPECT_EQ(contents(folder_.path("svg/full.svg")), once);
}

std::string refusal(const std::string& folder, PictureFormat format = PictureFormat::svg) {
  try {
    PictureFiles(report_with(straight_chart()), folder, format).commit();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Pictures, NeedRsvgConvertForSomeFormats) {
  if (can_write_pictures(PictureFormat::pdf)) GTEST_SKIP() << "rsvg-convert is installed";
  EXPECT_THAT(refusal(folder_.path("out"), PictureFormat::pdf), HasSubstr("--format svg"));
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Pictures, NeedAFolderAndSayThatThereIsNoChart) {
  Report bare;
  bare.lead = "Nothing slips.";
  PictureFiles(bare, folder_.path("none"), PictureFormat::svg).commit();
  std::ifstream captions(folder_.path("none/figures.txt"));
  std::string line;
  std::getline(captions, line);
  EXPECT_EQ(line, "There is no chart to draw: Nothing slips.");
  std::ofstream(folder_.path("file")) << "x";
  EXPECT_THAT(refusal(folder_.path("file")), HasSubstr("not a folder"));
  EXPECT_THAT(folder_.names(), ElementsAre("file", "none"));
}

TEST_F(Pictures, HaveNamesOnlyWhenCommitted) {
  {
    const PictureFiles files(report_with(straight_chart()), folder_.path("out"), PictureFormat::svg);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("out/straight.svg")));
  }
  EXPECT_TRUE(folder_.names().empty());
}

}  // namespace
}  // namespace tribofit
