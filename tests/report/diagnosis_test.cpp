#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../folder.hpp"
#include "made_up.hpp"
#include "report/terminal_text.hpp"
#include "tribofit/report/csv.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

std::string page(const DiagnosedTraces& result, std::size_t width = 100, bool unicode = false) {
  TerminalOptions options;
  options.arguments = {"--radius", "15mm"};
  options.width = width;
  options.unicode = unicode;
  return render_terminal(report_of(result, options), options);
}

/// The page with every line break and indentation a single blank, for sentences that are broken somewhere.
std::string prose(const DiagnosedTraces& result) {
  std::string text;
  for (const char c : page(result)) {
    if (c != '\n' && c != ' ') text += c;
    if ((c == '\n' || c == ' ') && !text.empty() && text.back() != ' ') text += ' ';
  }
  return text;
}

DiagnosedTraces two_traces() {
  DiagnosedTraces result = made_up_diagnosis();
  result.traces.push_back(result.traces[0]);
  result.traces[1].path = "more/r15.csv";
  result.traces[1].motion.conditions.speed.value *= 2;
  result.traces[1].warnings = {"a gap"};
  for (Fit& fit : result.fits) fit.cycles = 4;
  return result;
}

DiagnosedTraces unexplained() {
  DiagnosedTraces result = made_up_diagnosis();
  result.diagnosis.verdict = Verdict::unexplained;
  result.diagnosis.ladder[1].held_out_rmse = 0.0062;
  result.diagnosis.remaining = {{ResidualVariable::velocity, 0.6, 1e-5}};
  result.diagnosis.formula = "rest = a*exp(-v/w); a=0.02, w=6mm/s";
  return result;
}

DiagnosedTraces sufficient() {
  DiagnosedTraces result = made_up_diagnosis();
  result.diagnosis.verdict = Verdict::sufficient;
  result.diagnosis.ladder = {{"", 0.0032, 0.0001, 0.0031, {}}};
  result.diagnosis.effects.erase(result.diagnosis.effects.begin());
  result.fits.pop_back();
  result.best = 0;
  return result;
}

DiagnosedTraces too_short() {
  DiagnosedTraces result = sufficient();
  result.diagnosis = {};
  result.diagnosis.verdict = Verdict::not_enough_data;
  result.diagnosis.messages = {"7 cycles are too few, 20 would be enough"};
  return result;
}

DiagnosedTraces in_the_motion() {
  DiagnosedTraces result = sufficient();
  result.diagnosis.verdict = Verdict::effect_found;
  result.diagnosis.effects.push_back({"radius-offset", EffectStatus::found, 0.0032, 0, 1e-9, {}, "the plateau"});
  result.diagnosis.effects.push_back({"velocity-gain", EffectStatus::equivalent, 0.0032, 0, 1e-9, {}, "the plateau"});
  result.diagnosis.next_experiment = "Tilt the laser by 10 degrees.";
  return result;
}

TEST(DiagnosisJson, HasTheAgreedNamesAndWords) {
  const json j = json::parse(to_json(made_up_diagnosis(), {{"--radius", "15mm"}}));
  for (const char* key : {"tool", "trace", "conditions", "health", "stick_slip", "fits", "best", "warnings"}) {
    EXPECT_TRUE(j.contains(key)) << key;
  }
  EXPECT_FALSE(j["fits"][0]["parameters"][0].contains("trace"));
  const json& d = j["diagnosis"];
  EXPECT_EQ(d["verdict"], "effect-found");
  EXPECT_EQ(d["where"][0]["variable"], "angle");
  EXPECT_EQ(d["where"][0]["share"], 0.82);
  EXPECT_EQ(d["remaining"][0]["variable"], "velocity");
  ASSERT_EQ(d["ladder"].size(), 2u);
  EXPECT_TRUE(d["ladder"][0]["added"].is_null());
  EXPECT_EQ(d["ladder"][0]["held_out_rmse"], 0.0088);
  EXPECT_EQ(d["ladder"][0]["rmse"], 0.0086);
  EXPECT_EQ(d["ladder"][1]["added"], "runout");
  EXPECT_EQ(d["ladder"][1]["equivalent"], json::array());
  EXPECT_EQ(d["floor_rmse"], 0.0031);
  EXPECT_EQ(d["next_experiment"], "");
  std::vector<std::string> words;
  for (const json& effect : d["effects"]) words.push_back(effect["status"]);
  EXPECT_EQ(words, (std::vector<std::string>{"missing", "unsupported", "superseded", "untestable", "untestable"}));
  const json& runout = d["effects"][0];
  EXPECT_EQ(runout["key"], "runout");
  EXPECT_EQ(runout["error_reduction"], 0.99);
  EXPECT_EQ(runout["parameters"][0]["name"], "A");
  EXPECT_NEAR(runout["parameters"][0]["value"].get<double>(), 0.048, 1e-12);
  EXPECT_NEAR(runout["parameters"][0]["ci95"][1].get<double>(), 0.050, 1e-12);
  EXPECT_EQ(runout["parameters"][0]["effect"], "runout");
  EXPECT_TRUE(d["effects"][3]["held_out_rmse"].is_null());
  EXPECT_TRUE(d["effects"][3]["p_value"].is_null());
  EXPECT_EQ(d["effects"][3]["reason"], "there is no load channel");
}

TEST(DiagnosisJson, EveryVerdictHasItsWord) {
  const auto word = [](const DiagnosedTraces& r) { return json::parse(to_json(r))["diagnosis"]["verdict"]; };
  EXPECT_EQ(word(made_up_diagnosis()), "effect-found");
  EXPECT_EQ(word(unexplained()), "unexplained");
  EXPECT_EQ(word(sufficient()), "sufficient");
  EXPECT_EQ(word(too_short()), "not-enough-data");
}

TEST(DiagnosisJson, SeveralTracesAreListsAndParametersAreShared) {
  const json j = json::parse(to_json(two_traces()));
  EXPECT_FALSE(j.contains("trace"));
  for (const char* key : {"traces", "conditions", "stick_slip"}) ASSERT_EQ(j[key].size(), 2u) << key;
  EXPECT_EQ(j["traces"][1]["path"], "more/r15.csv");
  EXPECT_NEAR(j["conditions"][1]["speed_rpm"].get<double>(), 8, 1e-12);
  EXPECT_EQ(j["health"][3]["trace"], 1);
  EXPECT_EQ(j["warnings"][0], "more/r15.csv: a gap");
  const json& fitted = j["fits"][1]["parameters"][3];
  ASSERT_TRUE(fitted.contains("trace"));
  EXPECT_TRUE(fitted["trace"].is_null());
  EXPECT_TRUE(j["diagnosis"]["effects"][0]["parameters"][0].contains("trace"));
}

TEST(DiagnosisPage, TellsTheWholeStoryInOrder) {
  const std::string text = prose(made_up_diagnosis());
  std::size_t at = 0;
  for (const char* part : {"runs/r15.csv: stick-slip; 15 mm; 4 rpm; 50 N; 2 cycles",
                           "0 exponential law",
                           "0.00880 +/- 0.00020",
                           "1 + runout",
                           "99 %",
                           "floor",
                           "0.00310",
                           "Where the exponential law fails",
                           "Most of the error above the noise floor varies with the disc angle",
                           "angle",
                           "82 %",
                           "Verdict: effect-found",
                           "The effect found is runout (A = 0.0480 +/- 0.0010)",
                           "falls from 0.00880 to 0.00320",
                           "load-dependence, crosstalk: there is no load channel",
                           "The whole law: exponential + runout",
                           "mu_s 0.5090",
                           "alpha 0.05214",
                           "runout.A",
                           "[0.0460, 0.0500]",
                           "identify --radius 15mm --effect runout runs/r15.csv",
                           "identify diagnose --radius 15mm --report r15.html runs/r15.csv"}) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << "\n" << text;
    at = found;
  }
  EXPECT_THAT(text, Not(HasSubstr("Not distinguishable")));
  EXPECT_THAT(page(made_up_diagnosis()), EndsWith("\n  identify explore --radius 15mm runs/r15.csv\n"));
}

TEST(DiagnosisPage, EveryVerdictSaysNoMoreThanIsKnown) {
  EXPECT_THAT(prose(sufficient()),
              AllOf(HasSubstr("The exponential law is enough"), HasSubstr("These data show no further effect"),
                    Not(HasSubstr("Where the")), HasSubstr("identify --radius 15mm --csv r15-csv runs/r15.csv")));
  EXPECT_THAT(prose(unexplained()),
              AllOf(HasSubstr("More remains: "), HasSubstr("2.0 times the noise floor"),
                    HasSubstr("No effect explains the rest"), HasSubstr("varies with the sliding speed"),
                    HasSubstr("--effect runout --formula 'rest = a*exp(-v/w); a=0.02, w=6mm/s'")));
  DiagnosedTraces nothing = unexplained();
  nothing.diagnosis.ladder.pop_back();
  nothing.diagnosis.effects.erase(nothing.diagnosis.effects.begin());
  EXPECT_THAT(prose(nothing), HasSubstr("No effect of the catalogue explains what remains"));
  EXPECT_THAT(prose(too_short()), AllOf(HasSubstr("7 cycles are too few, 20 would be enough"), Not(HasSubstr("RMSE")),
                                        HasSubstr("identify --radius 15mm runs/r15.csv")));
}

TEST(DiagnosisPage, NamesAGroupAndTheTestThatWouldSplitIt) {
  DiagnosedTraces result = made_up_diagnosis();
  result.diagnosis.ladder[1].equivalent = {"drift", "heating"};
  result.diagnosis.next_experiment = "Record three revolutions.";
  EXPECT_THAT(prose(result),
              AllOf(HasSubstr("The effect found is runout or drift or heating, which these data cannot distinguish"),
                    HasSubstr("runout, drift and heating fit these data equally well"),
                    HasSubstr("Discriminating experiment: Record three revolutions.")));
}

TEST(DiagnosisPage, WhatShowsInTheMotionIsNoRungButNamed) {
  const std::string text = prose(in_the_motion());
  EXPECT_THAT(text, AllOf(HasSubstr("The effect found is radius-offset or velocity-gain"),
                          HasSubstr("Discriminating experiment: Tilt the laser"), Not(HasSubstr("falls from"))));
}

TEST(DiagnosisPage, AConfirmationSaysWhetherItHeld) {
  DiagnosedTraces result = made_up_diagnosis();
  result.diagnosis.confirmations = {{"r4.csv", 0.0090, 0.0033, 1e-6}, {"r5.csv", 0.0090, 0.0089, 0.4}};
  EXPECT_THAT(
      prose(result),
      AllOf(HasSubstr("r4.csv: with every parameter frozen the error goes from 0.00900 to 0.00330 (p < 0.0001): "
                      "confirmed"),
            HasSubstr("(p = 0.40): not confirmed")));
}

TEST(DiagnosisPage, ARunThatContradictsTheLawIsNamedWithItsErrorOverItsFloor) {
  DiagnosedTraces result = sufficient();
  result.diagnosis.verdict = Verdict::unconfirmed;
  result.diagnosis.confirmations = {{"r4.csv", 0.036, 0.036, 0.5, 0.003}};
  EXPECT_THAT(prose(result),
              AllOf(HasSubstr("A run not used in the fit contradicts it"), Not(HasSubstr("is incomplete")),
                    HasSubstr("the error of the law is 0.0360, 12 times the noise floor of that run (0.00300): "
                              "not confirmed")));
}

TEST(DiagnosisPage, WhatRemovesNoErrorDoesNotMakeItFall) {
  DiagnosedTraces result = made_up_diagnosis();
  result.diagnosis.ladder.back().held_out_rmse = result.diagnosis.ladder.front().held_out_rmse;
  EffectFinding& finding = result.diagnosis.effects.front();
  finding.held_out_rmse = std::nan("");
  finding.reason = "the plateau of stick shows it";
  EXPECT_THAT(prose(result), AllOf(HasSubstr("the held-out error stays at"), HasSubstr("the plateau of stick shows it"),
                                   Not(HasSubstr("falls from"))));
}

TEST(DiagnosisPage, SeveralTracesAreNamedTogether) {
  DiagnosedTraces result = two_traces();
  const std::string text = prose(result);
  EXPECT_THAT(text, AllOf(HasSubstr("2 traces: stick-slip; 15 mm; 4, 8 rpm; 50 N; 4 cycles"),
                          HasSubstr("warning: more/r15.csv: a gap"),
                          HasSubstr("identify diagnose --radius 15mm --csv diagnosis-csv runs/r15.csv more/r15.csv")));
}

TEST(DiagnosisPage, NoLineIsWiderThanThePage) {
  DiagnosedTraces grouped = two_traces();
  grouped.diagnosis.ladder[1].equivalent = {"temperature-dependence", "stribeck-exponent"};
  grouped.diagnosis.next_experiment = "Record at least three revolutions, which take 45 s at 4 rpm, and compare them.";
  for (const DiagnosedTraces& result :
       {made_up_diagnosis(), grouped, unexplained(), sufficient(), too_short(), in_the_motion()}) {
    for (const std::size_t width : {40u, 50u, 64u, 80u, 120u}) {
      for (const bool unicode : {false, true}) {
        std::istringstream text(page(result, width, unicode));
        for (std::string line; std::getline(text, line);) {
          if (line.find('\'') != std::string::npos) continue;  // a quoted formula stays one word
          EXPECT_LE(displayed(line), width) << line;
        }
      }
    }
  }
}

TEST(DiagnosisPage, AsciiIsAsciiAndUnicodeHasBars) {
  const std::string plain = page(made_up_diagnosis(), 80, false);
  EXPECT_TRUE(std::all_of(plain.begin(), plain.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80U; }));
  EXPECT_THAT(page(made_up_diagnosis(), 80, true),
              AllOf(HasSubstr("\u2588"), HasSubstr("\u2591"), HasSubstr("\u00b1"), Not(HasSubstr("+/-"))));
}

TEST(DiagnosisPage, BarsAreAsLongAsTheirValues) {
  EXPECT_EQ(bar(1, 1, 10, false), "##########");
  EXPECT_EQ(bar(0.5, 1, 10, false), "#####");
  EXPECT_EQ(bar(1, 1, 10, false, 0.3), "---#######");
  EXPECT_EQ(bar(0.2, 1, 10, false, 0.3), "--");
  EXPECT_EQ(bar(0.25, 1, 2, true), "\u258c");
  EXPECT_EQ(bar(std::nan(""), 1, 10, false), "");
}

TEST(DiagnosisPage, OwnOptionsOfTheDiagnosisDoNotReachIdentify) {
  TerminalOptions options;
  options.arguments = {"--confirm", "r4.csv", "--radius", "15mm", "--effect", "drift", "--formula", "h = a*v; a=1"};
  EXPECT_THAT(render_terminal(report_of(made_up_diagnosis(), options), options),
              HasSubstr("\n  identify --radius 15mm --effect runout runs/r15.csv\n"));
}

TEST(DiagnosisCsv, OneTraceIsAFolderAndSeveralHaveOneEach) {
  const Folder folder;
  write_csv_folder(folder.path("one"), made_up_diagnosis());
  EXPECT_THAT(contents(folder.path("one/samples.csv")), HasSubstr("time_s,relative_velocity_mm_s,mu,mu_model"));
  EXPECT_THAT(contents(folder.path("one/curves.csv")), HasSubstr("exponential,runout,joint"));
  write_csv_folder(folder.path("two"), two_traces());
  for (const char* name : {"two/r15/samples.csv", "two/r15-2/samples.csv", "two/r15-2/errors.csv"}) {
    EXPECT_FALSE(contents(folder.path(name)).empty()) << name;
  }
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("one", "two"));
}

}  // namespace
}  // namespace tribofit
