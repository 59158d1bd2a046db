#include "tribofit/report/terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "made_up.hpp"
#include "report/commands.hpp"

namespace tribofit {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

TerminalOptions with_radius() {
  TerminalOptions options;
  options.arguments = {"--radius", "15mm"};
  return options;
}

std::string rendered(const Identification& result) {
  return render_terminal(report_of(result, with_radius()));
}

TEST(Commands, AnOptionStaysWithItsValueWhereACommandIsFolded) {
  const std::string folded =
      folded_command("identify diagnose --radius 15mm --effect viscous --effect drift a.csv", 50);
  EXPECT_EQ(folded, "  identify diagnose --radius 15mm \\\n      --effect viscous --effect drift a.csv");
}

TEST(Commands, ADiagnosisTakesTheOptionsThatItHas) {
  EXPECT_EQ(diagnose_command({"--radius", "15mm", "--protocol", "both", "--profile", "--load", "50N"}, "my runs/"),
            "identify diagnose --radius 15mm --load 50N 'my runs/'");
}

TEST(Terminal, ShowsConditionsWithTheirSource) {
  EXPECT_THAT(
      rendered(made_up_result()),
      AllOf(HasSubstr("runs/r15.csv"), HasSubstr("2 400 000 samples, 120.0 s at 20 kHz"),
            HasSubstr("15 mm (command line)"), HasSubstr("4 rpm (plateau)"), HasSubstr("load              not known")));
}

TEST(Terminal, HealthNamesWhatIsWrongOrThatNothingIs) {
  Identification result = made_up_result();
  EXPECT_THAT(rendered(result), AllOf(HasSubstr("1.3 revolutions recorded"), Not(HasSubstr("no problems found"))));
  result.motion.health.pop_back();
  EXPECT_THAT(rendered(result), HasSubstr("no problems found (1 checks)"));
}

TEST(Terminal, StickSlipMeasuresHaveUncertaintiesAndUnits) {
  EXPECT_THAT(rendered(made_up_result()),
              AllOf(HasSubstr("4.883 +/- 0.012 Hz"), HasSubstr("plain FFT would say 4.883 Hz"),
                    HasSubstr("83.90 +/- 0.20 mm/s"), HasSubstr("175.40 +/- 0.30 ms"), HasSubstr("19.10 mm/s")));
}

TEST(Terminal, ParametersStandWithErrorIntervalUnitAndStart) {
  const std::string text = rendered(made_up_result());
  // 52.14 s/m with a standard error of 0.43 s/m, both to the same place in s/mm.
  EXPECT_THAT(text,
              ContainsRegex("alpha +0\\.05214 +0\\.00043 +\\(0\\.82 %\\) +\\[0\\.05128, 0\\.05300\\] +s/mm +0\\.0469"));
  EXPECT_THAT(text, ContainsRegex("mu_s +0\\.5090 +0\\.0012"));
  EXPECT_THAT(text, HasSubstr("no instrument uncertainties declared"));
}

TEST(Terminal, TheSystematicPartStandsApart) {
  Identification result = made_up_result();
  result.fits[0].parameters[0].systematic = 0.0051;
  TerminalOptions options = with_radius();
  options.instruments_declared = true;
  EXPECT_THAT(render_terminal(report_of(result, options), options),
              AllOf(HasSubstr("systematic"), HasSubstr("0.0051"), Not(HasSubstr("no instrument uncertainties"))));
}

TEST(Terminal, ParametersFitANarrowTerminal) {
  Identification result = made_up_result();
  result.fits[0].parameters[2].at_bound = true;
  for (const std::size_t width : {60u, 80u}) {
    TerminalOptions options = with_radius();
    options.width = width;
    const std::string text = render_terminal(report_of(result, options), options);
    const std::string_view begin = "\n  parameter ";
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
      for (std::size_t row = at + 1; text[row] == ' '; row = text.find('\n', row) + 1) {
        EXPECT_LE(text.find('\n', row) - row, width) << text.substr(row, 120);
      }
    }
    EXPECT_THAT(text, ContainsRegex("mu_s +0\\.5090 .*\\[0\\.5066, 0\\.5114\\]"));
  }
}

TEST(Terminal, WhatIsNotDeclaredIsNoZero) {
  TerminalOptions options = with_radius();
  options.instruments_declared = true;
  EXPECT_THAT(render_terminal(report_of(made_up_result(), options), options), ContainsRegex("mu_s .*\\]  1 +-  "));
}

TEST(Terminal, FlagsStandInTheRowTheyAreAbout) {
  Identification result = made_up_result();
  result.fits[0].parameters[2].at_bound = true;
  result.fits[0].parameters[1].start = result.fits[0].parameters[1].value;
  result.fits[0].correlations = {{0, 2, 0.97}};
  EXPECT_THAT(rendered(result), AllOf(ContainsRegex("alpha .*at bound, correlated"), ContainsRegex("mu_k .*unmoved"),
                                      ContainsRegex("mu_s .* correlated")));
}

TEST(Terminal, TheBiasOfThePublishedProtocolStandsBesideTheJointFit) {
  Identification result = made_up_result();
  EXPECT_THAT(rendered(result), ContainsRegex("alpha +0\\.06010 +0\\.05214 +\\+15\\.3 % +s/mm"));
  result.fits[2].parameters[2].value = 52.2;
  EXPECT_THAT(rendered(result), HasSubstr("agree within the 95 % intervals"));
}

TEST(Terminal, ErrorsStandBesideTheFloor) {
  EXPECT_THAT(rendered(made_up_result()), AllOf(HasSubstr("RMSE 0.00310, held-out error 0.00320; noise floor 0.00310"),
                                                HasSubstr("mean 0.60 %, largest 5.0 %"), HasSubstr("explains 99.8 %")));
}

TEST(Terminal, TheVerdictFollowsTheErrorAboveTheFloor) {
  Identification result = made_up_result();
  EXPECT_THAT(rendered(result), HasSubstr("as well as its noise allows"));
  result.fits[0].error.held_out_rmse = 0.0075;
  EXPECT_THAT(rendered(result), HasSubstr("does not carry over"));
  result.fits[0].error.rmse = 0.0074;
  EXPECT_THAT(rendered(result), HasSubstr("a small effect may remain"));
  result.fits[0].error.held_out_rmse = result.fits[0].error.rmse = 0.0020;
  EXPECT_THAT(rendered(result), HasSubstr("is overestimated here"));
  result.fits[0].error.held_out_rmse = result.fits[0].error.rmse = 0.0075;
  result.fits[0].parameters[1].upper95 = 3;
  EXPECT_THAT(rendered(result), HasSubstr("data: mu_k."));
  result.fits[0].error.mean_relative = 0.2;
  EXPECT_THAT(rendered(result), HasSubstr("Do not rely on its values"));
  result.fits[0].converged = false;
  EXPECT_THAT(rendered(result), AllOf(HasSubstr("did not converge"), HasSubstr("No fit can be trusted")));
}

TEST(Terminal, EndsWithTheNextCommandInTheUsersOwnWords) {
  Identification result = made_up_result();
  EXPECT_THAT(rendered(result), HasSubstr("\n  identify --radius 15mm --csv r15-csv runs/r15.csv\n"));
  EXPECT_THAT(rendered(result), EndsWith("\n  identify --radius 15mm --report r15.html runs/r15.csv\n"
                                         "To switch effects on and off in a browser:\n"
                                         "  identify explore --radius 15mm runs/r15.csv\n"));
  result.fits[0].error.held_out_rmse = 0.0075;
  EXPECT_THAT(rendered(result), HasSubstr("\n  identify diagnose --radius 15mm runs/r15.csv\n"));
  TerminalOptions options = with_radius();
  options.arguments = {"--profile", "--radius", "15mm", "--protocol", "joint"};
  EXPECT_THAT(
      render_terminal(report_of(result, options), options),
      AllOf(HasSubstr("\n  identify diagnose --radius 15mm runs/r15.csv\n"),
            HasSubstr("\n  identify --profile --radius 15mm --protocol joint --report r15.html runs/r15.csv\n")));
  result.path = "my runs/r 15.csv";
  EXPECT_THAT(rendered(result), EndsWith(" 'my runs/r 15.csv'\n"));
}

TEST(Terminal, ATraceThatCouldNotBeAnalysedStillSaysWhatIsKnown) {
  Identification result = made_up_result();
  result.fits.clear();
  result.analysed = false;
  result.segmentation.kind = MotionKind::always_sticking;
  result.warnings = {"the block never slips"};
  EXPECT_THAT(rendered(result), AllOf(HasSubstr("15 mm"), HasSubstr("the block never slips"),
                                      HasSubstr("No law was fitted"), HasSubstr("identify --radius 15mm --csv")));
}

TEST(Terminal, ForcesAreInNewtons) {
  Identification result = made_up_result();
  result.motion.friction_kind = FrictionKind::force;
  EXPECT_THAT(rendered(result), AllOf(HasSubstr("RMSE 0.00310 N"), ContainsRegex("mu_s .*\\]  N ")));
}

TEST(Terminal, ColourChangesNothingButColour) {
  TerminalOptions options = with_radius();
  options.colour = true;
  std::string coloured = render_terminal(report_of(made_up_result(), options), options);
  EXPECT_THAT(coloured, HasSubstr("\033["));
  for (std::size_t at; (at = coloured.find("\033[")) != std::string::npos;) {
    coloured.erase(at, coloured.find('m', at) - at + 1);
  }
  EXPECT_EQ(coloured, rendered(made_up_result()));
}

TEST(Terminal, ShowsWhatIsSaidForATerminal) {
  ReportSection section{"one", "One", {}}, page{"two", "Two", {}, Medium::page};
  section.plain("for all");
  section.plain("for a page", Medium::page);
  section.plain("for a terminal", Medium::terminal);
  page.plain("elsewhere");
  Report report;
  report.add({section, page});
  EXPECT_EQ(render_terminal(report), "\nOne\n  for all\n  for a terminal\n");
  report.keep_for(Medium::page);
  EXPECT_EQ(report.sections.size(), 2u);
  EXPECT_EQ(render_terminal(report), "\nOne\n  for all\n");
}

TEST(Terminal, ALongTableSaysHowManyRowsAreLeftOut) {
  ReportTable table("Many", "many.csv");
  table.numbers({"k"}).text({"", ""});
  for (int k = 0; k < 100; ++k) table.rows.push_back({std::to_string(k), "", ""});
  table.add({"empty"}, std::vector<std::string>(100));
  Report report;
  report.add({{"many", "", {table}}});
  const std::string text = render_terminal(report);
  const auto rows = std::count(text.begin(), text.end(), '\n') - 4;  // blank, caption, names, what is left out
  EXPECT_GT(rows, 10);
  EXPECT_THAT(text, AllOf(HasSubstr("... and " + std::to_string(100 - rows) + " more in many.csv"),
                          HasSubstr("\n  " + std::to_string(rows - 1) + "\n"), Not(HasSubstr("empty"))));
}

TEST(Terminal, ShellQuotingSurvivesAnything) {
  EXPECT_EQ(shell_quoted("--radius=15mm"), "--radius=15mm");
  EXPECT_EQ(shell_quoted("a b"), "'a b'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("$x;`y`"), "'$x;`y`'");
}

TEST(Catalogue, EveryEffectIsListedAndExplained) {
  std::vector<EffectInfo> effects;
  for (const Effect& effect : effect_catalogue()) effects.push_back(describe(effect));
  const std::string list = render_terminal(effects_report(effects));
  for (const EffectInfo& effect : effects) {
    EXPECT_THAT(list, HasSubstr("  " + effect.key));
    const std::string page = render_terminal(effect_report(effect));
    for (const Parameter& p : effect.parameters) EXPECT_THAT(page, AllOf(HasSubstr(p.name), HasSubstr(p.unit)));
  }
}

}  // namespace
}  // namespace tribofit
