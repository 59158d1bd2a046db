// Every verb that reads records, with every output it has, on every kind of record: it ends as documented, and what it
// writes is whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

#include "command.hpp"
#include "tribofit/report/report.hpp"

namespace {

using nlohmann::json;

constexpr double kPi = std::numbers::pi;

/// A record of controlled speed: v_r [m/s] over time, friction by a Stribeck curve.
struct Programme {
  double duration = 20, rate = 200;
  std::function<double(double)> speed;
  bool force = false, channels = false;  ///< newtons; load and temperature beside it
};

std::string csv_of(const Programme& p) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::string text = p.force ? "time_s,force [N],v_r [mm/s]" : "time_s,mu,v_r [mm/s]";
  text += p.channels ? ",load [N],temperature [degC]\n" : "\n";
  char line[160];
  for (double t = 0; t < p.duration; t += 1 / p.rate) {
    const double v = p.speed(t), size = 0.25 + 0.15 * std::exp(-std::abs(v) / 0.02) + 0.8 * std::abs(v);
    const double mu = (v == 0 ? 0.3 : std::copysign(size, v)) + 0.003 * normal(engine);
    std::snprintf(line, sizeof line, "%.6g,%.6g,%.6g", t, p.force ? 50 * mu : mu, 1e3 * v + 0.05 * normal(engine));
    text += line;
    if (p.channels) {
      std::snprintf(line, sizeof line, ",%.6g,%.6g", 50 + 5 * std::sin(0.7 * t), 25 + 0.1 * t);
      text += line;
    }
    text += "\n";
  }
  return text;
}

double sliding(double t) {
  return 0.08 + 0.079 * std::sin(2 * kPi * t / 5);
}

/// A name and the text of the file.
struct Kind {
  const char* name;
  std::string text;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = [] {
    const Workshop shop;
    shop.identify(
        "simulate --radius 15mm --speed 4rpm --duration 4s --rate 2kHz --noise-mu 0.003 --noise-v 0.02mm/s "
        "--scatter 0.004 --out trace.csv --quiet");
    const auto steps = [](double t) { return 1e-3 * std::pow(2, std::floor(t / 2.5)); };
    const auto reversing = [](double t) { return 0.1 * std::sin(2 * kPi * t / 5); };
    const auto rest = [](double) { return 0.0; };
    return std::vector<Kind>{{"stick-slip", contents(shop / "trace.csv")},
                             {"steps", csv_of({.speed = steps})},
                             {"sliding", csv_of({.speed = sliding})},
                             {"reversing", csv_of({.speed = reversing})},
                             {"sticks", csv_of({.speed = rest})},
                             {"force", csv_of({.speed = sliding, .force = true})},
                             {"channels", csv_of({.speed = sliding, .channels = true})}};
  }();
  return all;
}

/// A verb and the outputs that it has beside --json.
struct Verb {
  const char* words;
  bool tables = false, pictures = false;
};

/// Every row of a table has as many cells as its header, and the last one its line break.
void expect_whole_table(const std::filesystem::path& path) {
  const std::string text = contents(path);
  ASSERT_FALSE(text.empty()) << path;
  EXPECT_EQ(text.back(), '\n') << path;
  const std::vector<std::string> lines = lines_of(text);
  const auto cells = std::count(lines[0].begin(), lines[0].end(), ',');
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), cells) << path;
}

class Matrix : public testing::TestWithParam<Verb> {};

TEST_P(Matrix, EveryOutputOfEveryKindOfRecordIsWhole) {
  const Verb& verb = GetParam();
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(std::string(verb.words) + " on " + kind.name);
    const Workshop shop;
    shop.write("trace.csv", kind.text);
    std::string arguments = std::string(verb.words) + " --radius 15mm --json r.json";
    if (verb.tables) arguments += " --csv tables";
    const bool page = verb.pictures && tribofit::has_report_page();
    if (page) arguments += " --report r.html";
    if (verb.pictures) arguments += " --figures pictures";
    const Outcome outcome = shop.identify(arguments + " trace.csv");
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.status << "\n" << outcome.err;
    EXPECT_EQ(outcome.status == 0, outcome.err.empty()) << outcome.err;
    const bool written = std::filesystem::exists(shop / "r.json");
    EXPECT_TRUE(written || outcome.status == 1);
    if (!written) continue;
    EXPECT_TRUE(json::accept(contents(shop / "r.json")));
    if (verb.tables) {
      for (const char* table : {"samples.csv", "cycles.csv", "curves.csv", "errors.csv"})
        expect_whole_table(shop / (std::string("tables/") + table));
      EXPECT_EQ(lines_of(contents(shop / "tables/samples.csv")).size(),
                1 + json_in(shop / "r.json")["trace"]["samples"].get<std::size_t>());
    }
    if (page) {
      EXPECT_NE(contents(shop / "r.html").find("</html>"), std::string::npos);
    }
    if (verb.pictures) {
      EXPECT_FALSE(contents(shop / "pictures/figures.txt").empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Verbs, Matrix,
                         testing::Values(Verb{"", true, true}, Verb{"--protocol published", true, true},
                                         Verb{"--never-sticks --speed 4rpm", true, true},
                                         Verb{"diagnose --law exponential", true, true}, Verb{"rig"},
                                         Verb{"twin", false, true}, Verb{"study phase", false, true}),
                         [](const auto& verb) {
                           std::string name = verb.param.words;
                           std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
                           return name.empty() ? std::string("identify") : name;
                         });

TEST(NeverSticks, SlowSlidingIsFittedAndCounted) {
  const Workshop shop;
  shop.write("trace.csv", kinds()[1].text);
  const Outcome found = shop.identify("--radius 15mm --json r.json trace.csv");
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(found.out, testing::HasSubstr("the block never sticks"));
  EXPECT_THAT(found.out, testing::HasSubstr("of 4 000 samples"));
  EXPECT_EQ(json_in(shop / "r.json")["stick_slip"]["motion"], "always-slipping");
  const Outcome said = shop.identify("--radius 15mm --stick-below 3mm/s trace.csv");
  EXPECT_THAT(said.out, testing::HasSubstr("below 3.0 mm/s"));
  EXPECT_EQ(shop.identify("--radius 15mm --stick-below 3mm/s --never-sticks trace.csv").status, 2);
  EXPECT_EQ(shop.identify("--radius 15mm --stick-below 3N trace.csv").status, 3);
}

/// An answer from a law that is far off is the answer for another machine.
TEST(FarAboveTheFloor, StudyAndTwinSayItFirst) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("simulate --radius 15mm --speed 4rpm --duration 6s --rate 5kHz --noise-mu 0.002 "
                          "--noise-v 0.02mm/s --effect frictional-lag:tau=2ms --out trace.csv --quiet")
                .status,
            0);
  for (const std::string verb : {"study speed", "twin"}) {
    const Outcome outcome = shop.identify(verb + " --radius 15mm --load 50N --law exponential trace.csv");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string first = outcome.out.substr(0, outcome.out.find("trace.csv"));
    EXPECT_THAT(first, testing::HasSubstr("times the noise floor")) << verb;
    EXPECT_THAT(first, testing::HasSubstr("diagnose")) << verb;
  }
}

}  // namespace
