#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "command.hpp"
#include "tribofit/report/pictures.hpp"
#include "tribofit/report/report.hpp"

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

struct Wrong {
  std::string name, arguments;
  std::string says;
};

/// What is said of --report: that this build cannot, where it leaves the page out and it would come to that.
std::string report_says(const std::string& text) {
  return tribofit::has_report_page() || text == "one trace" ? text : "leaves the page out";
}

class WrongUsage : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongUsage, IsStatusTwo) {
  const Workshop shop;
  shop.write("a.csv", good_trace());
  shop.write("b.csv", good_trace());
  const Outcome outcome = shop.identify(GetParam().arguments);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("identify: error: "), HasSubstr(GetParam().says), HasSubstr("--help")));
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(contents(shop / "a.csv"), good_trace());
}

INSTANTIATE_TEST_SUITE_P(
    Usages, WrongUsage,
    ::testing::Values(
        Wrong{"Nothing", "", "no trace given"}, Wrong{"UnknownOption", "--bogus a.csv", "--bogus"},
        Wrong{"Misspelt", "--radus 15mm a.csv", "did you mean --radius?"},
        Wrong{"ValueMissing", "a.csv --radius", "--radius"},
        Wrong{"UnknownLaw", "--law quadratic a.csv", "exponential"},
        Wrong{"UnknownLoss", "--loss cubic a.csv", "huber"}, Wrong{"OneFold", "--folds 1 a.csv", "--folds"},
        Wrong{"NoStart", "--starts 0 a.csv", "--starts"}, Wrong{"Threads", "--threads -1 a.csv", "--threads"},
        Wrong{"JsonOfTwo", "--json r.json a.csv b.csv", "one trace"},
        Wrong{"CsvOfTwo", "--csv out a.csv b.csv", "one trace"},
        Wrong{"ReportOfTwo", "--report r.html a.csv b.csv", report_says("one trace")},
        Wrong{"ReportOfAShard", "--shard 1/2 --report r.html --out results a.csv b.csv", "identify merge"},
        Wrong{"ReportOntoTheTrace", "--report a.csv a.csv", report_says("overwrite")},
        Wrong{"ReportOntoTheJson", "--report x --json x a.csv", report_says("one file")},
        Wrong{"DiagnoseReportOverwrites", "diagnose --report a.csv a.csv", report_says("overwrite")},
        Wrong{"JsonOntoTheTrace", "--json a.csv a.csv", "overwrite"},
        Wrong{"EmptyRadius", "--radius '' a.csv", "--radius is given an empty"},
        Wrong{"EmptyJson", "--json '' a.csv", "--json is given an empty"},
        Wrong{"EmptyTrace", "--radius 15mm ''", "a trace is given an empty"},
        Wrong{"FormatOfNothing", "--format pdf a.csv", "--format needs --figures"},
        Wrong{"UnknownFormat", "--figures out --format eps a.csv", "svg"},
        Wrong{"FiguresOfTwo", "--figures out a.csv b.csv", "one trace"},
        Wrong{"FiguresOntoTheJson", "--figures x --json x a.csv", "folder"},
        Wrong{"FiguresOfAShard", "--figures x --shard 1/2 --out y a.csv b.csv", "identify merge"},
        Wrong{"NegativeSeed", "--seed -1 a.csv", "--seed"},
        Wrong{"SeedTooLarge", "--seed 18446744073709551616 a.csv", "--seed"},
        Wrong{"SessionBesideOptions", "explore --session s.json --radius 15mm --port 8080", "leave out --radius (only"},
        Wrong{"DiagnoseNothing", "diagnose", "no trace given"},
        Wrong{"DiagnoseEmptyLoad", "diagnose --load '' a.csv", "--load"},
        Wrong{"DiagnoseSeed", "diagnose --seed 1.5 a.csv", "--seed"},
        Wrong{"DiagnoseMisspelt", "diagnose --confrim a.csv b.csv", "--confirm"},
        Wrong{"AllKept", "diagnose --confirm a.csv a.csv", "leave one"},
        Wrong{"GivenTwice", "diagnose a.csv ./a.csv", "given twice"},
        Wrong{"WithOfTwo", "diagnose --with c.csv a.csv b.csv", "one trace"},
        Wrong{"DiagnoseOverwrites", "diagnose --json a.csv a.csv", "overwrite"},
        Wrong{"MisspeltVerb", "diagnos --radius 15mm", "did you mean `identify diagnose`?"},
        Wrong{"NoSuchEffect", "--radius 15mm --effect vicous a.csv", "did you mean 'viscous'"},
        Wrong{"NoSuchForm", "--effect rate-state:heling a.csv", "did you mean 'rate-state:healing'"},
        Wrong{"ValuesInAFit", "--effect viscous:sigma=0.001 a.csv", "write it as viscous"},
        Wrong{"EffectTwice", "--effect viscous --effect viscous a.csv", "'viscous' is given twice"},
        Wrong{"BothFormsOfRateState", "--effect rate-state --effect rate-state:healing a.csv",
              "'rate-state' is given twice"},
        Wrong{"HealingBesideABristle", "--effect bristle --effect rate-state:healing a.csv", "counts the time at rest"},
        Wrong{"FormulaTwice", "--formula 'x = a*v; a=0.1' --formula 'y =  a * v; a=0.2' a.csv",
              "the same effect twice"},
        Wrong{"FormulaOfTheCatalogue", "--formula 'viscous = a*v; a=0.1' a.csv", "give it another name"},
        Wrong{"DiagnoseNoSuchEffect", "diagnose --effect vicous a.csv", "did you mean 'viscous'"},
        Wrong{"DiagnoseFormulaTwice", "diagnose --formula 'x = a*v; a=1' --formula 'y=a*v;a=2' a.csv",
              "the same effect twice"},
        Wrong{"ExplainNoSuchEffect", "effects vicous", "did you mean 'viscous'"},
        Wrong{"SimulateNoSuchEffect", "simulate --effect vicous --out b.csv", "did you mean 'viscous'"},
        Wrong{"SimulateNoSuchParameter", "simulate --effect viscous:sgma=1 --out b.csv", "'sigma'"},
        Wrong{"SimulateNoValue", "simulate --effect viscous:x --out b.csv", "viscous:sigma=VALUE"},
        Wrong{"SimulateEffectTwice", "simulate --effect viscous --effect viscous --out b.csv", "twice"},
        Wrong{"OptionsBeforeTheVerb", "--radius 15mm effects", "effects"}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(Usage, SomeFormatsOfFiguresNeedLibrsvg) {
  if (tribofit::can_write_pictures(tribofit::PictureFormat::pdf)) GTEST_SKIP() << "rsvg-convert is installed";
  const Workshop shop;
  shop.write("a.csv", good_trace());
  const Outcome outcome = shop.identify("--radius 15mm --figures out --format pdf a.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("librsvg"), HasSubstr("--format svg")));
}

/// It would be millimetres in one verb and metres in another: none takes it, and the unit that was meant is named.
TEST(Usage, ABareNumberIsRefusedByEveryVerb) {
  const Workshop shop;
  shop.write("a.csv", good_trace());
  for (const auto& [arguments, says] : std::vector<std::pair<std::string, std::string>>{
           {"--radius 15 a.csv", "--radius: '15' has no unit; write 15mm or 15m"},
           {"--radius 6mm,9 a.csv", "--radius: '9' has no unit; write 9mm"},
           {"--radius 15mm --speed 4 a.csv", "--speed: '4' has no unit; write 4rpm or 4rad/s"},
           {"diagnose --radius 15mm --load 50 a.csv", "--load: '50' has no unit; write 50N"},
           {"rig --radius 15mm --rate 5000 a.csv", "--rate: '5000' has no unit; write 5000kHz or 5000Hz"},
           {"--kind spring-slider --stiffness 168N/m --mass 30.7 a.csv", "--mass: '30.7' has no unit; write 30.7kg"},
           {"diagnose --time-limit 10 a.csv", "--time-limit: '10' has no unit; write 10s or 10ms"},
           {"plan --radius 15mm --speeds 8 a.csv", "--speeds: '8' has no unit; write 8rpm"},
           {"plan --radius 15mm --springs 5 a.csv", "--springs: '5' has no unit; write 5N/mm"},
           {"explore --radius 15 a.csv", "--radius: '15' has no unit; write 15mm"},
           {"twin --radius 15 a.csv", "--radius: '15' has no unit; write 15mm"},
           {"simulate --radius 15 --out b.csv", "--radius: '15' has no unit; write 15mm"},
           {"simulate --speed 4 --out b.csv", "--speed: '4' has no unit; write 4rpm"},
           {"simulate --mass 1 --out b.csv", "--mass: '1' has no unit; write 1kg"},
           {"simulate --stiffness 16 --out b.csv", "--stiffness: '16' has no unit; write 16N/mm"},
           {"simulate --alpha 0.05 --out b.csv", "--alpha: '0.05' has no unit; write 0.05s/mm"},
           {"simulate --noise-v 0.02 --out b.csv", "--noise-v: '0.02' has no unit; write 0.02mm/s"},
           {"simulate --drift 1e-5 --out b.csv", "--drift: '1e-5' has no unit; write 1e-5 1/s"},
           {"simulate --temperature 20..0 --out b.csv", "--temperature: '20' has no unit; write 20degC"},
           {"simulate --effect runout:A=0.05,phase=1 --out b.csv", "runout:phase: '1' has no unit; write 1deg or 1rad"},
           {"study phase --radius 15", "--radius: '15' has no unit; write 15mm"},
           {"study speed --range 1..20", "--range: '1' has no unit"},
           {"study phase --at 6", "--at: '6' has no unit"},
           {"study map --x stiffness=8..20:3 --y mass", "--x: '8' has no unit; write 8N/mm"},
           {"--start alpha=0.05 a.csv", "alpha: '0.05' has no unit; write 0.05s/mm"},
           {"--exclude 1..2 a.csv", "--exclude: '1' has no unit; write 1s"}}) {
    const Outcome outcome = shop.identify(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(says)) << arguments;
  }
  EXPECT_EQ(shop.identify("simulate --duration 1s --rate 1kHz --delay 0 --force-bandwidth 0 --out b.csv").status, 0)
      << "nothing is nothing in any unit";
}

TEST(Usage, HelpAndVersionAreNoErrors) {
  const Workshop shop;
  for (const char* words : {"--help", "diagnose --help", "--version"}) {
    const Outcome outcome = shop.identify(words);
    EXPECT_EQ(outcome.status, 0) << words;
    EXPECT_THAT(outcome.out, Not(IsEmpty())) << words;
    EXPECT_THAT(outcome.err, IsEmpty()) << words;
  }
}

TEST(Usage, EffectsListsAndExplains) {
  const Workshop shop;
  const Outcome list = shop.identify("effects");
  EXPECT_EQ(list.status, 0);
  EXPECT_THAT(list.out, AllOf(HasSubstr("viscous"), HasSubstr("rate-state"), HasSubstr("bristle")));
  const Outcome page = shop.identify("effects bristle");
  EXPECT_EQ(page.status, 0);
  EXPECT_THAT(page.out, AllOf(HasSubstr("sigma0"), HasSubstr("1/mm"), HasSubstr("doi:"), HasSubstr("2000")));
  const Outcome unknown = shop.identify("effects brisle");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'bristle'"));
}

/// The paragraph for a paper has the numbers of the result, and the sources are those of the law and the effect used.
TEST(Cite, TellsARunAndItsSources) {
  const Workshop shop;
  const std::string result = shop / "result.json";
  ASSERT_EQ(shop.identify("--radius 15mm --law exponential --effect viscous --quiet --json '" + result +
                          "' " TRIBOFIT_SOURCE_DIR "/data/example.csv")
                .status,
            0);
  const Outcome cited = shop.identify("cite '" + result + "'");
  EXPECT_EQ(cited.status, 0);
  const std::string text = std::regex_replace(cited.out, std::regex("\\s+"), " ");  // lines break anywhere
  const nlohmann::json run = json_in(result);
  const nlohmann::json fit = run.at("fits").at(run.at("best").get<std::size_t>());
  for (const auto& parameter : fit.at("parameters")) {
    // Two digits of the standard error are printed: the value is off by a twentieth of it at most.
    const std::string label = parameter.at("name").get<std::string>() + " = (";
    const std::size_t at = text.find(label);
    ASSERT_NE(at, std::string::npos) << label << "\n" << text;
    EXPECT_NEAR(std::stod(text.substr(at + label.size())), parameter.at("value").get<double>(),
                0.051 * parameter.at("std_error").get<double>());
  }
  EXPECT_THAT(cited.out, AllOf(HasSubstr("100000 samples"), HasSubstr("15 mm"), HasSubstr("Wear 24 (1973) 381"),
                               HasSubstr(run.at("trace").at("checksum").get<std::string>())));
  std::string deep;
  for (int k = 0; k < 60000; ++k) deep += "{\"a\": [";
  for (int k = 0; k < 60000; ++k) deep += "], \"b\": 1}";
  const Outcome refused = shop.identify("cite '" + shop.write("deep.json", deep) + "'");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("nested too deeply"));
  EXPECT_EQ(shop.identify("cite runot").status, 2);
  EXPECT_THAT(shop.identify("cite runot").err, HasSubstr("did you mean runout?"));
  EXPECT_EQ(shop.identify("cite '" TRIBOFIT_SOURCE_DIR "/data/example.json'").status, 3);
}

TEST(Help, ListsAndPrintsEveryText) {
  const Workshop shop;
  const Outcome list = shop.identify("help");
  EXPECT_EQ(list.status, 0);
  std::size_t texts = 0;
  for (const auto& file : std::filesystem::directory_iterator(TRIBOFIT_SOURCE_DIR "/tools/help")) {
    const std::string topic = file.path().stem().string(), text = contents(file.path());
    EXPECT_THAT(list.out, HasSubstr("  " + topic + " ")) << "not in tools/CMakeLists.txt";
    EXPECT_THAT(list.out, HasSubstr(text.substr(0, text.find('\n'))));
    EXPECT_EQ(shop.identify("help " + topic).out, text);
    ++texts;
  }
  EXPECT_GE(texts, 5u);
}

}  // namespace
