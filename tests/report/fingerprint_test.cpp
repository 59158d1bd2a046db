#include "tribofit/study/fingerprint.hpp"
#include "report/terminal_text.hpp"
#include "tribofit/report/terminal.hpp"
/// Pictures of fingerprints fit the page.

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace tribofit {
namespace {

TEST(Fingerprint, FitsEightyColumnsAndTwentyLines) {
  for (const Effect& effect : effect_catalogue()) {
    for (const bool unicode : {false, true}) {
      TerminalOptions options;
      options.unicode = unicode;
      options.width = 80;
      std::istringstream text(render_fingerprint(fingerprint(effect), options));
      std::string line;
      std::size_t lines = 0;
      for (; std::getline(text, line); ++lines) {
        EXPECT_LE(displayed(line), 80u) << line;
        EXPECT_EQ(unicode || line.size() == displayed(line), true) << line;
      }
      EXPECT_LE(lines, 20u);
    }
  }
}

TEST(Fingerprint, PutsPointsWhereTheyBelong) {
  const Fingerprint corners = {{"x", "mm", 1e-3}, {"y", "", 1}, {{"a", {0, 0.004}, {1, 2}}}, ""};
  std::istringstream text(render_fingerprint(corners, {}));
  std::string line, top, bottom;
  std::getline(text, line);
  std::getline(text, top);
  for (int i = 0; i < 12; ++i) std::getline(text, bottom);
  EXPECT_EQ(top.back(), '*');
  EXPECT_EQ(top.find('*'), top.size() - 1);
  EXPECT_EQ(bottom.substr(bottom.size() - 2), "|*");
  std::getline(text, line);
  std::getline(text, line);
  EXPECT_NE(line.find("x [mm]"), std::string::npos);
  EXPECT_EQ(line.back(), '4');
}

TEST(Fingerprint, SurvivesNothingAndFlatness) {
  EXPECT_NE(render_fingerprint({{"x", "", 1}, {"y", "", 1}, {{"", {}, {}}}, ""}, {}), "");
  EXPECT_NE(render_fingerprint({{"x", "", 1}, {"y", "", 1}, {{"", {1, 2}, {3, 3}}}, ""}, {}).find('*'),
            std::string::npos);
}

TEST(Effects, ListFitsEightyColumnsAndNamesEveryParameter) {
  TerminalOptions options;
  options.width = 80;
  std::vector<EffectInfo> effects;
  for (const Effect& effect : effect_catalogue()) effects.push_back(describe(effect));
  const std::string list = render_terminal(effects_report(effects), options);
  std::istringstream text(list);
  for (std::string line; std::getline(text, line);) EXPECT_LE(line.size(), 80u) << line;
  for (const EffectInfo& effect : effects) {
    EXPECT_NE(list.find("  " + effect.key + "\n"), std::string::npos);
    for (const Parameter& p : effect.parameters) EXPECT_NE(list.find(p.name + " "), std::string::npos) << p.name;
    std::istringstream page(render_terminal(effect_report(effect), options));
    for (std::string line; std::getline(page, line);) EXPECT_LE(line.size(), 80u) << line;
  }
}

}  // namespace
}  // namespace tribofit
