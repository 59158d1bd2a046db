#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "tribofit/report/pictures.hpp"
#include "tribofit/report/report.hpp"

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Identify : public ::testing::Test {
 protected:
  void SetUp() override { shop_.write("trace.csv", good_trace()); }
  Workshop shop_;
};

/// Every run ends by naming a command; whatever it is, it runs.
TEST_F(Identify, TheCommandItNamesRuns) {
  std::string command = "identify --radius 15mm trace.csv";
  for (int step = 0; step < 3; ++step) {
    const Outcome outcome = shop_.shell(command);
    ASSERT_EQ(outcome.status, 0) << command << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
    command = next_command(outcome.out);
    ASSERT_THAT(command, Not(IsEmpty())) << outcome.out;
  }
}

TEST_F(Identify, FindsTheTruthOfASimulatedTrace) {
  ASSERT_EQ(shop_.identify("--radius 15mm --quiet --json r.json trace.csv").status, 0);
  const json result = json_in(shop_ / "r.json");
  const json& best = result["fits"][result["best"].get<std::size_t>()];
  EXPECT_EQ(best["law"], "exponential");
  // 14 cycles only: published values of [D] at 15 mm within what their scatter allows.
  EXPECT_NEAR(parameter(best, "mu_s")["value"].get<double>(), 0.509, 0.01);
  EXPECT_NEAR(parameter(best, "mu_k")["value"].get<double>(), 0.318, 0.005);
  EXPECT_NEAR(parameter(best, "alpha")["value"].get<double>(), 0.05214, 0.004);
  EXPECT_NEAR(result["stick_slip"]["frequency_hz"]["value"].get<double>(), 4.88, 0.1);
  EXPECT_NEAR(result["conditions"]["speed_rpm"].get<double>(), 4, 0.04);
  EXPECT_EQ(result["trace"]["samples"], 15000);
}

TEST_F(Identify, ReportIsOnePageBesideTheOtherOutputs) {
  if (!tribofit::has_report_page()) GTEST_SKIP() << "this build leaves the page out";
  const Outcome outcome = shop_.identify("--radius 15mm --quiet --report r.html --json r.json --csv out trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out + outcome.err, IsEmpty());
  const std::string page = contents(shop_ / "r.html");
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_LT(page.size(), 4000000u);
  EXPECT_NE(page.find("\"text\":\"identify --radius 15mm trace.csv\""), std::string::npos);
  EXPECT_THAT(shop_.names(), ::testing::UnorderedElementsAre("trace.csv", "r.html", "r.json", "out"));
  EXPECT_THAT(contents(shop_ / "r.json"), ::testing::Not(HasSubstr("--report")));
}

TEST_F(Identify, FiguresAreFilesInAFolder) {
  const bool has_pdf = tribofit::can_write_pictures(tribofit::PictureFormat::pdf);
  for (const std::string format : {"svg", has_pdf ? "pdf" : "svg"}) {
    const Outcome outcome = shop_.identify("--radius 15mm --quiet --figures " + format + " --format " + format +
                                           " --json r.json trace.csv");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out + outcome.err, IsEmpty());
    const std::string captions = contents(shop_ / format / "figures.txt");
    std::size_t pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(shop_ / format)) {
      if (entry.path().extension() != "." + format) continue;
      ++pictures;
      EXPECT_THAT(captions, HasSubstr(entry.path().filename().string() + "\n"));
      EXPECT_LT(entry.file_size(), 400000u) << entry.path();
    }
    EXPECT_GE(pictures, 6u);
  }
  EXPECT_THAT(shop_.names(), ::testing::IsSupersetOf({"trace.csv", "r.json", "svg"}));
  EXPECT_THAT(contents(shop_ / "r.json"), ::testing::Not(HasSubstr("--fi")));
}

TEST_F(Identify, NothingIsLeftWherePicturesCannotBeWritten) {
  shop_.write("out", "a file, where the pictures want a folder");
  const Outcome outcome = shop_.identify("--radius 15mm --quiet --figures out --json r.json --csv tables trace.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("not a folder"));
  EXPECT_THAT(shop_.names(), ::testing::UnorderedElementsAre("trace.csv", "out"));
}

TEST_F(Identify, ResultsAreTheSameForAnyNumberOfThreads) {
  for (const char* threads : {"1", "2"}) {
    const std::string t(threads);
    ASSERT_EQ(shop_.identify("--radius 15mm --quiet --threads " + t + " --json " + t + ".json trace.csv").status, 0);
  }
  json one = json_in(shop_ / "1.json"), two = json_in(shop_ / "2.json");
  one.erase("tool");
  two.erase("tool");
  EXPECT_EQ(one.dump(), two.dump());
}

TEST_F(Identify, NeverOverwritesItsInputs) {
  std::filesystem::create_directory(shop_ / "own");
  std::filesystem::copy_file(shop_ / "trace.csv", shop_ / "own/samples.csv");
  const std::string before = contents(shop_ / "own/samples.csv");
  EXPECT_EQ(shop_.identify("--radius 15mm --csv own own/samples.csv").status, 2);
  EXPECT_EQ(contents(shop_ / "own/samples.csv"), before);
  std::ofstream(shop_ / "lab.json") << R"({"rig": {"radius": "15 mm"}})";
  EXPECT_EQ(shop_.identify("--instruments lab.json --json lab.json trace.csv").status, 2);
  EXPECT_EQ(contents(shop_ / "lab.json"), R"({"rig": {"radius": "15 mm"}})");
}

TEST_F(Identify, WritesTheFolderOfTables) {
  ASSERT_EQ(shop_.identify("--radius 15mm --quiet --csv out trace.csv").status, 0);
  EXPECT_EQ(contents(shop_ / "out/samples.csv")
                .substr(0, 80)
                .find("time_s,relative_velocity_mm_s,mu,mu_model,phase,cycle,held_out_fold\n"),
            0u);
  for (const char* name : {"cycles.csv", "curves.csv", "errors.csv"}) {
    EXPECT_GT(lines_of(contents(shop_ / (std::string("out/") + name))).size(), 10u) << name;
  }
  EXPECT_EQ(lines_of(contents(shop_ / "out/samples.csv")).size(), 15001u);
}

TEST_F(Identify, JsonToStandardOutputStandsAlone) {
  const Outcome outcome = shop_.identify("--radius 15mm --json - trace.csv");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(json::accept(outcome.out));
}

TEST_F(Identify, QuietPrintsNothing) {
  const Outcome outcome = shop_.identify("--radius 15mm --quiet trace.csv");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out + outcome.err, IsEmpty());
}

TEST_F(Identify, AReaderThatLeavesIsNoError) {
  const Outcome outcome = shop_.shell("{ identify --radius 15mm trace.csv trace.csv; echo status $? >&2; } | head -1");
  EXPECT_THAT(outcome.err, HasSubstr("status 0"));
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("error")));
}

TEST_F(Identify, OneOfSeveralFailing) {
  shop_.write("bad.csv", "a,b\n1,2\n");
  const Outcome outcome = shop_.identify("--radius 15mm trace.csv bad.csv trace.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("bad.csv"));
  const std::size_t first = outcome.out.find("tribofit ");
  EXPECT_NE(outcome.out.find("tribofit ", first + 1), std::string::npos);  // the others were analysed
}

TEST_F(Identify, AFolderIsEveryTraceInIt) {
  std::filesystem::create_directory(shop_ / "runs");
  for (const char* name : {"runs/b.csv", "runs/a.csv"}) shop_.write(name, good_trace());
  shop_.write("runs/notes.txt", "x\n");
  const Outcome outcome = shop_.identify("--radius 15mm runs");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(outcome.out.find("\n  a "), outcome.out.find("\n  b "));
  EXPECT_THAT(shop_.names(), Contains("runs-results"));
}

TEST_F(Identify, RadiiBySteps) {
  const Outcome one = shop_.identify("--radius 15mm,15mm trace.csv");
  EXPECT_NE(one.status, 2);  // understood; whether the steps match the file is the reader's to say
  EXPECT_NE(one.status, 0);
}

TEST_F(Identify, AddsEffectsAndFormulas) {
  ASSERT_EQ(shop_.identify("--radius 15mm --quiet --law exponential --effect viscous --json r.json trace.csv").status,
            0);
  const json result = json_in(shop_ / "r.json");
  EXPECT_EQ(result["fits"][0]["effects"], json({"viscous"}));
  EXPECT_EQ(parameter(result["fits"][0], "sigma")["unit"], "s/mm");
  const Outcome formula = shop_.identify(
      "--radius 15mm --law exponential --formula 'hump = a*exp(-((v-v0)/w)^2); a=0.02, "
      "v0=25mm/s, w=6mm/s' trace.csv");
  EXPECT_EQ(formula.status, 0) << formula.err;
  EXPECT_THAT(formula.out, HasSubstr("hump.v0"));
}

TEST_F(Identify, FormulasThatCannotBeFittedAreAFailureAlsoWhenQuiet) {
  for (const char* quiet : {"", "--quiet "}) {
    const Outcome not_finite =
        shop_.identify(std::string(quiet) + "--radius 15mm --formula 'x = a*log(v-500); a=0.1' trace.csv");
    EXPECT_EQ(not_finite.status, 1);
    EXPECT_THAT(not_finite.err, HasSubstr("'x' is not finite on these data"));
    const Outcome nothing = shop_.identify(std::string(quiet) + "--radius 15mm --formula 'x = a*0; a=0.1' trace.csv");
    EXPECT_EQ(nothing.status, 1);
    EXPECT_THAT(nothing.err, HasSubstr("'x' is zero on these data"));
  }
}

TEST_F(Identify, TablesThatCsvWroteAreNoRuns) {
  std::filesystem::create_directory(shop_ / "runs");
  shop_.write("runs/a.csv", good_trace());
  ASSERT_EQ(shop_.identify("--radius 15mm --quiet --csv runs runs").status, 0);
  EXPECT_TRUE(std::filesystem::exists(shop_ / "runs/samples.csv"));
  Outcome again = shop_.identify("--radius 15mm --json r.json runs");
  EXPECT_EQ(again.status, 0) << again.err;
  const json j = json_in(shop_ / "r.json");
  EXPECT_EQ(j["trace"]["path"], "runs/a.csv");
  EXPECT_THAT(again.out, HasSubstr("because --csv wrote them: "));
  shop_.write("runs/manifest.csv", "file,radius\n*.csv,15mm\n");
  again = shop_.identify("--quiet runs");
  EXPECT_EQ(again.status, 0) << again.err;
  // A run of that name is a run.
  std::filesystem::create_directory(shop_ / "mine");
  shop_.write("mine/samples.csv", good_trace());
  EXPECT_EQ(shop_.identify("--radius 15mm --quiet mine").status, 0);
  std::filesystem::remove(shop_ / "runs/manifest.csv");
  std::filesystem::remove(shop_ / "runs/a.csv");
  const Outcome only = shop_.identify("--radius 15mm runs");
  EXPECT_EQ(only.status, 3);
  EXPECT_THAT(only.err, HasSubstr("only tables that --csv wrote"));
}

TEST_F(Identify, HealingIsSimulatedFittedAndExplained) {
  ASSERT_EQ(shop_
                .identify("simulate --radius 15mm --speed 4rpm --duration 6s --effect rate-state:healing,D_c=80um "
                          "--noise-mu 0.001 --out h.csv")
                .status,
            0);
  EXPECT_EQ(json_in(shop_ / "h.json")["effect_names"], json({"rate-state:healing"}));
  const Outcome fit =
      shop_.identify("--radius 15mm --speed 4rpm --law exponential --effect rate-state:healing --json r.json h.csv");
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("exponential + rate-state:healing"));
  const json f = json_in(shop_ / "r.json")["fits"][0];
  EXPECT_EQ(f["effects"], json({"rate-state"}));
  EXPECT_EQ(f["effect_names"], json({"rate-state:healing"}));
  EXPECT_NEAR(parameter(f, "D_c")["value"], 80, 4);
  const Outcome page = shop_.identify("effects rate-state:healing");
  EXPECT_EQ(page.status, 0);
  EXPECT_THAT(page.out, AllOf(HasSubstr("d theta/dt = 1 - v theta/D_c"), HasSubstr("--effect rate-state:healing")));
  EXPECT_THAT(shop_.identify("effects rate-state").out, HasSubstr("rate-state:healing"));
}

}  // namespace
