#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "report/pictures/picture.hpp"

namespace tribofit {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::StartsWith;

Extent extent(double low, double high, bool logarithmic = false) {
  Extent out(logarithmic);
  out.add(low);
  out.add(high);
  return out;
}

std::vector<std::string> numbers(const Scale& scale) {
  std::vector<std::string> out;
  for (const Scale::Tic& tic : scale.tics) out.push_back(tic.text);
  return out;
}

TEST(Scale, HasRoundNumbers) {
  EXPECT_THAT(numbers(scale_of({}, extent(0, 10), 0, 5)), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(numbers(scale_of({}, extent(0.31, 0.52), 0, 5)), ElementsAre("0.35", "0.40", "0.45", "0.50"));
  EXPECT_THAT(numbers(scale_of({}, extent(-1, 1), 0, 4)), ElementsAre("\xE2\x88\x92"
                                                                      "1.0",
                                                                      "\xE2\x88\x92"
                                                                      "0.5",
                                                                      "0.0", "0.5", "1.0"));
  EXPECT_THAT(numbers(scale_of({}, extent(0, 1), 0, 4)), ElementsAre("0.00", "0.25", "0.50", "0.75", "1.00"));
  EXPECT_THAT(numbers(scale_of({}, extent(0, 4e-5), 0, 4)), ElementsAre("0",
                                                                        "1\xC2\xB7"
                                                                        "10^{\xE2\x88\x92"
                                                                        "5}",
                                                                        "2\xC2\xB7"
                                                                        "10^{\xE2\x88\x92"
                                                                        "5}",
                                                                        "3\xC2\xB7"
                                                                        "10^{\xE2\x88\x92"
                                                                        "5}",
                                                                        "4\xC2\xB7"
                                                                        "10^{\xE2\x88\x92"
                                                                        "5}"));
}

TEST(Scale, HasDecades) {
  const ChartAxis axis{.logarithmic = true};
  EXPECT_THAT(numbers(scale_of(axis, extent(0.1, 1000, true), 0, 5)), ElementsAre("0.1", "1", "10", "100", "1000"));
  EXPECT_THAT(numbers(scale_of(axis, extent(1, 20, true), 0, 5)), ElementsAre("1", "2", "5", "10", "20"));
  Extent with_zero(true);
  for (const double value : {0.0, -1.0, 10.0, 1000.0}) with_zero.add(value);
  EXPECT_EQ(scale_of(axis, with_zero, 0, 5).low, 1);  // its logarithm
}

TEST(Scale, ShowsWhatIsSaidAndElseTheData) {
  const Scale given = scale_of({.low = 2, .high = 4}, extent(0, 10), 0.05, 5);
  EXPECT_EQ(given.low, 2);
  EXPECT_EQ(given.high, 4);
  const Scale data = scale_of({.unit = "mm"}, extent(0, 10), 0.05, 5);
  EXPECT_DOUBLE_EQ(data.low, -0.5);
  EXPECT_DOUBLE_EQ(data.high, 10.5);
  const Scale from_zero = scale_of({.from_zero = true}, extent(3, 10), 0.05, 5);
  EXPECT_EQ(from_zero.low, 0);
  EXPECT_DOUBLE_EQ(from_zero.high, 10.5);
  EXPECT_EQ(scale_of({.quantity = "v_{r}", .unit = "mm/s"}, extent(0, 1), 0, 5).title, "v_{r} [mm/s]");
}

TEST(Scale, HasNoPlaceForZeroOnDecades) {
  const Scale decades = scale_of({.logarithmic = true}, extent(1, 100, true), 0, 5);
  EXPECT_DOUBLE_EQ(decades.part(10), 0.5);
  EXPECT_TRUE(std::isnan(decades.part(0)));
}

TEST(Scale, IsThereWhateverTheData) {
  const double most = std::numeric_limits<double>::max();
  for (const Extent& range : {extent(5, 5), extent(0, 0), Extent(false), extent(-most, most), extent(1e17, 1e17 + 16),
                              extent(1, std::nextafter(1.0, 2.0)), extent(0, 5e-324)}) {
    const Scale scale = scale_of({}, range, 0.05, 5);
    EXPECT_LE(scale.tics.size(), 12u);
  }
  EXPECT_LE(scale_of({.logarithmic = true}, extent(5e-324, most, true), 0, 5).tics.size(), 12u);
}

TEST(PictureText, IsOneLineOfValidCharacters) {
  EXPECT_EQ(one_line("it's \\"), "it's \\");
  EXPECT_EQ(one_line("a\nb\tc\x7f\xC2\x85"
                     "d"),
            "a b c  d");
  EXPECT_EQ(one_line("\xff'\\"), "\xEF\xBF\xBD'\\");
  // The longest forms, a half of UTF-16, what is beyond Unicode and a letter that is cut off are none (RFC 3629).
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(one_line("\xC0\xAF"), bad + bad);
  EXPECT_EQ(one_line("\xE0\x80\xAF"), bad + bad + bad);
  EXPECT_EQ(one_line("\xED\xA0\x80"), bad + bad + bad);
  EXPECT_EQ(one_line("\xF4\x90\x80\x80"), bad + bad + bad + bad);
  EXPECT_EQ(one_line("v\xCF"), "v" + bad);
  EXPECT_EQ(one_line("\xEF\xBF\xBE"), bad);  // valid UTF-8, but in no XML
  EXPECT_EQ(one_line("\xCE\xBC \xE2\x82\xAC \xF0\x9F\x98\x80"), "\xCE\xBC \xE2\x82\xAC \xF0\x9F\x98\x80");
}

TEST(PictureText, IsCutAtWhatIsSetLowAndHigh) {
  const auto cut = [](const char* text) {
    std::string out;
    for (const TextPiece& piece : pieces_of(text)) out += std::to_string(piece.level) + "<" + piece.text + ">";
    return out;
  };
  EXPECT_EQ(cut("v_{r} [s^{2}] a_b {x}"), "0<v>-1<r>0< [s>1<2>0<] a_b {x}>");
  EXPECT_EQ(cut("_{open"), "0<_{open>");
  EXPECT_EQ(cut(""), "");
}

/// Widths of Helvetica as Adobe's metrics have them (AFM): 722 + 556 + 222 = 1500 thousandths of the size.
TEST(PictureText, HasTheWidthsOfHelvetica) {
  EXPECT_NEAR(width_of("Hel", 10), 1.5 * 10 * 25.4 / 72, 1e-9);
  EXPECT_NEAR(width_of("0123456789", 8), 5.56 * 8 * 25.4 / 72, 1e-9);
}

TEST(PictureText, IsShortenedInItsMiddle) {
  const std::string path(300, 'x');
  const std::string text = shortened("first" + path + "last", 30);
  EXPECT_THAT(text, StartsWith("first"));
  EXPECT_THAT(text, EndsWith("last"));
  EXPECT_LE(width_of(text), 30);
  EXPECT_GT(width_of(text), 27);
  EXPECT_EQ(shortened("short", 30), "short");
  EXPECT_DOUBLE_EQ(width_of("v_{r}"), width_of("vr"));
}

TEST(CellEdges, LieHalfwayBetweenCentres) {
  EXPECT_THAT(cell_edges({1, 2, 4}), ElementsAre(0.5, 1.5, 3, 5));
  EXPECT_TRUE(cell_edges({}).empty());
}

TEST(PictureLayout, KeepsTheLegendBelowTheData) {
  Chart chart;
  chart.x = {.quantity = "time", .unit = "s"};
  chart.panels = {{.quantity = "friction"}, {.quantity = "velocity", .unit = "mm/s", .part = 0.5}};
  for (int k = 0; k < 7; ++k) {
    chart.lines.push_back({"a line with a name of some length, " + std::to_string(k), {0, 1}, {0, 1}});
  }
  const PictureLayout layout = layout_of(chart);
  ASSERT_EQ(layout.keys.size(), 7u);
  for (const Key& key : layout.keys) {
    EXPECT_LT(key.y, layout.x_title_y);
    EXPECT_GT(key.y, 0);
    EXPECT_LT(key.x + sizes.key_sample + sizes.key_gap + width_of(key.name), sizes.width);
  }
  ASSERT_EQ(layout.panels.size(), 2u);
  EXPECT_GT(layout.panels[0].bottom, layout.panels[1].bottom + layout.panels[1].height);
  EXPECT_GT(layout.panels[1].bottom, layout.x_title_y);
  EXPECT_NEAR(layout.panels[0].height / layout.panels[1].height, 2, 1e-9);
  EXPECT_LT(layout.panels[0].bottom + layout.panels[0].height, layout.height);
  chart.lines.resize(1);
  EXPECT_TRUE(layout_of(chart).keys.empty());  // one alone needs no name
}

}  // namespace
}  // namespace tribofit
