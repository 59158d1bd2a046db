#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <string>

#include "command.hpp"

// Records without friction and without motion, through every output.

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// x = A sin(w t) that slows down and friction of 0.8 N: the base that goes with it, in mm.
std::string motion_table() {
  constexpr double kMass = 3, kStiffness = 1200, kFriction = 0.8, kTurn = 7, kFade = 0.05;
  std::string text = "time_s,x_b [mm],x_d [mm]\n";
  for (int i = 0; i < 8000; ++i) {
    const double t = i * 0.002, a = 2e-3 * std::exp(-kFade * t);
    const double x = a * std::sin(kTurn * t);
    const double v = a * (kTurn * std::cos(kTurn * t) - kFade * std::sin(kTurn * t));
    const double b =
        a * ((kFade * kFade - kTurn * kTurn) * std::sin(kTurn * t) - 2 * kFade * kTurn * std::cos(kTurn * t));
    const double noise = 3e-7 * std::sin(1000.3 * i);
    const double y = x + (kMass * b + std::copysign(kFriction, v)) / kStiffness;
    text += std::to_string(t) + "," + std::to_string(1e3 * (x + noise)) + "," + std::to_string(1e3 * y) + "\n";
  }
  return text;
}

TEST(KindsOfRecord, AMotionAloneGivesFrictionAgainstVelocity) {
  const Workshop shop;
  shop.write("frame.csv", motion_table());
  const Outcome outcome = shop.identify(
      "--mass 3kg --stiffness 1200N/m --law coulomb --json j.json --csv out --report r.html --figures pictures "
      "frame.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("motion-only (no friction was recorded)"), HasSubstr("level"),
                                 HasSubstr("the two levels agree"), HasSubstr("rubs on")));
  const json result = json_in(shop / "j.json");
  EXPECT_EQ(result["trace"]["kind"], "motion-only");
  EXPECT_EQ(result["conditions"]["spring"]["rubs_on"], "ground");
  ASSERT_EQ(result["friction_over_velocity"]["levels"].size(), 2);
  for (const json& level : result["friction_over_velocity"]["levels"])
    EXPECT_NEAR(level["friction"]["value"].get<double>(), 0.8, 0.02);
  for (const json& bin : result["friction_over_velocity"]["bins"])
    EXPECT_NEAR(std::abs(bin["friction"]["value"].get<double>()), 0.8, 0.05);
  EXPECT_THAT(contents(shop / "out/samples.csv"), HasSubstr("mu_std_error"));
  EXPECT_EQ(shop.identify("frame.csv").status, 3);
  EXPECT_THAT(shop.identify("frame.csv").err, HasSubstr("--mass 3.08kg --stiffness 1191N/m"));
  EXPECT_EQ(shop.identify("--mass 3kg --stiffness 1200N/m --rubs-on wall frame.csv").status, 2);
}

TEST(KindsOfRecord, FrictionAloneGivesItsSlips) {
  const Workshop shop;
  std::string text = "time_s,force [N]\n";
  for (int i = 0; i < 20000; ++i) {  // 400 samples up from 8 to 12 N, 10 down
    const int at = i % 410;
    const double force = at < 400 ? 8 + 0.01 * at : 12 - 0.4 * (at - 400);
    text += std::to_string(i * 0.001) + "," + std::to_string(force + 0.01 * std::sin(77.7 * i)) + "\n";
  }
  shop.write("cell.csv", text);
  const Outcome outcome = shop.identify("--json j.json --csv out --report r.html --figures pictures cell.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("force-only (no motion was recorded)"), HasSubstr("break-away"),
                    HasSubstr("a law needs the sliding velocity"), HasSubstr("identify columns cell.csv")));
  const json force = json_in(shop / "j.json")["force"];
  EXPECT_EQ(force["slips"], 48);
  EXPECT_NEAR(force["peak"]["mean"].get<double>(), 12, 0.02);
  EXPECT_NEAR(force["drop"]["mean"].get<double>(), 4, 0.03);
  EXPECT_NEAR(force["period_s"]["mean"].get<double>(), 0.41, 0.001);
  for (const char* verb : {"diagnose", "rig", "twin"}) {
    const Outcome other = shop.identify(std::string(verb) + " cell.csv");
    EXPECT_EQ(other.status, 1) << verb << other.err;
    EXPECT_THAT(other.out + other.err, HasSubstr("friction alone was recorded")) << verb;
  }
}

/// An option with a value, and the kinds that read it by their letters: (S)tick-slip, s(l)iding, (p)oints, (s)pring
/// slider, (m)otion alone, (f)orce alone, velocity steps (v), (h)olds.
struct ReadBy {
  const char *value, *kinds;
};

const std::map<std::string, ReadBy>& options_of_records() {
  constexpr const char *kAll = "Slpsmfvh", *kLaws = "Slpsm", *kDriven = "vh";
  static const std::map<std::string, ReadBy> all = {{"--law", {"gaussian", kLaws}},
                                                    {"--effect", {"viscous", kLaws}},
                                                    {"--formula", {"'q = a*v; a=1'", kLaws}},
                                                    {"--loss", {"huber", kLaws}},
                                                    {"--starts", {"9", kLaws}},
                                                    {"--folds", {"3", kLaws}},
                                                    {"--seed", {"7", kLaws}},
                                                    {"--protocol", {"joint", kLaws}},
                                                    {"--profile", {"", kLaws}},
                                                    {"--cycles", {"1..9", kLaws}},
                                                    {"--start", {"mu_s=0.4", kLaws}},
                                                    {"--bounds", {"mu_s=0.4..0.5", kLaws}},
                                                    {"--exclude", {"1s..2s", "Slpsmvh"}},
                                                    {"--stick-below", {"1mm/s", "S"}},
                                                    {"--no-trim", {"", "Slsm"}},
                                                    {"--never-sticks", {"", "l"}},
                                                    {"--evolution", {"slip", kDriven}},
                                                    {"--states", {"1", kDriven}},
                                                    {"--detrend", {"none", kDriven}},
                                                    {"--reference-speed", {"1um/s", kDriven}},
                                                    {"--from", {"1s", kDriven}},
                                                    {"--to", {"2s", kDriven}},
                                                    {"--stiffness", {"1N/mm", "sm"}},
                                                    {"--mass", {"1kg --stiffness 1N/mm", "sm"}},
                                                    {"--damping", {"1Ns/m", "m"}},
                                                    {"--rubs-on", {"base", "m"}},
                                                    {"--radius", {"15mm", kAll}},
                                                    {"--load", {"50N", kAll}},
                                                    {"--speed", {nullptr, ""}},
                                                    {"--kind", {nullptr, ""}},  // of each kind in its own way
                                                    {"--columns", {"mu=COF", kAll}},
                                                    {"--units", {"mu=N", kAll}},
                                                    {"--rate", {"1kHz", kAll}},
                                                    {"--with", {"other.csv", kAll}},
                                                    {"--with-columns", {"v_b=v --with other.csv", kAll}},
                                                    {"--with-units", {"v_b=mm/s --with other.csv", kAll}},
                                                    {"--continue", {"other.csv", kAll}},
                                                    {"--instruments", {nullptr, ""}}};
  return all;
}

/// The sections of the help that say how a record is read and fitted.
std::vector<std::string> options_in_help(const Workshop& shop) {
  std::vector<std::string> options;
  std::string section;
  std::smatch match;
  for (const std::string& line : lines_of(shop.identify("--help").out)) {
    if (!line.empty() && line[0] != ' ') section = line;
    const bool is_of_records = section == "Conditions:" || section == "Reading:" || section == "Law and fit:" ||
                               section == "Mass on a spring:" || section == "Velocity steps and holds:";
    static const std::regex option("^  (--[a-z-]+).*");
    if (is_of_records && std::regex_match(line, match, option)) options.push_back(match[1]);
  }
  return options;
}

/// What the parser has is either read of a kind or refused; what is new says which kinds read it. The file is not
/// there: what is not refused gets as far as that.
TEST(OptionsOfKinds, WhatMeansNothingIsRefusedOnceTheKindIsStated) {
  const Workshop shop;
  const std::vector<std::pair<char, std::string>> kinds = {
      {'S', "stick-slip"},  {'l', "sliding"},    {'p', "points"},         {'s', "spring-slider"},
      {'m', "motion-only"}, {'f', "force-only"}, {'v', "velocity-steps"}, {'h', "slide-hold-slide"}};
  const std::vector<std::string> parsed = options_in_help(shop);
  EXPECT_GE(parsed.size(), 30u);
  for (std::string option : parsed) {
    if (option == "--trim") option = "--no-trim";
    ASSERT_TRUE(options_of_records().contains(option)) << option << ": which kinds read it?";
    const ReadBy& known = options_of_records().at(option);
    for (const auto& [letter, kind] : known.value != nullptr ? kinds : decltype(kinds)()) {
      std::string line = "--kind " + kind + " " + option + " " + known.value;
      const Outcome outcome = shop.identify(line + " missing.csv");
      const bool is_read = std::string(known.kinds).find(letter) != std::string::npos;
      EXPECT_EQ(outcome.status, is_read ? 3 : 2) << line << outcome.err;
      if (is_read) continue;
      EXPECT_THAT(outcome.err, HasSubstr("identify: error: --")) << line;
    }
  }
}

TEST(OptionsOfKinds, WhatMeansNothingIsRefusedOnceTheFileShowsItsKind) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  for (const char* name : {"a.csv", "runs/a.csv", "runs/b.csv"}) shop.write(name, good_trace());
  ASSERT_EQ(shop.identify("simulate --kind velocity-steps --rate 20Hz --duration 140s --speed-steps "
                          "0s:2um/s,60s:20um/s,80s:2um/s --quiet --out steps.csv")
                .status,
            0);
  for (const char* given :
       {"--evolution slip", "--states 2", "--detrend time", "--reference-speed 2um/s", "--from 1s", "--to 2s"}) {
    const Outcome outcome = shop.identify(std::string("--radius 15mm ") + given + " a.csv");
    EXPECT_EQ(outcome.status, 2) << given;
    EXPECT_THAT(outcome.err, HasSubstr("means nothing for a record of the kind stick-slip; it is for velocity-steps"));
    EXPECT_THAT(outcome.out, ::testing::IsEmpty());
  }
  for (const char* line : {"--law coulomb steps.csv", "--seed 3 steps.csv", "--cycles 1..3 steps.csv"})
    EXPECT_EQ(shop.identify(line).status, 2) << line;
  EXPECT_EQ(shop.identify("--radius 15mm --detrend time --out r runs").status, 3) << "each run says it";
  EXPECT_THAT(contents(shop / "r/summary.csv"), HasSubstr("--detrend means nothing"));
  const Outcome given = shop.identify("--start mu_s=0.4 steps.csv");
  EXPECT_EQ(given.status, 3);
  EXPECT_THAT(given.err, HasSubstr("mu_s is a parameter of laws of sliding speed"));
  EXPECT_THAT(shop.identify("--kind velocity-steps --start mu_s=0.4 steps.csv").err,
              HasSubstr("have no parameter 'mu_s', but a, b, D_c"));
}

TEST(OptionsOfKinds, SimulatedRecordsToo) {
  const Workshop shop;
  const std::string steps = "--kind velocity-steps --rate 1Hz --duration 9s --speed-steps 0s:2um/s,5s:4um/s ";
  for (const std::string& given :
       {std::string("--rate-state a=0.02"), std::string("--evolution slip"), std::string("--reference-speed 2um/s"),
        std::string("--drift 1e-5/s"), steps + "--radius 9mm", steps + "--law coulomb", steps + "--mu-s 0.4",
        steps + "--effect viscous:sigma=0.001s/mm", steps + "--pause 1s,2s", steps + "--temperature 20degC..30degC",
        steps + "--scatter 0.1", steps + "--noise-v 1mm/s", steps + "--high-pass 1Hz", steps + "--speed 4rpm"}) {
    const Outcome outcome = shop.identify("simulate --out t.csv " + given);
    EXPECT_EQ(outcome.status, 2) << given;
    EXPECT_THAT(outcome.err, HasSubstr("means nothing for a record of the kind")) << given;
  }
  EXPECT_EQ(shop.identify("simulate --out t.csv --rate-state GARBAGE").status, 2);
  EXPECT_EQ(shop.identify("simulate --out t.csv --noise-mu 0.001 --noise-colour 0.5 --seed 4 " + steps).status, 0);
}

}  // namespace
