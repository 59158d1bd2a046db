#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A simulated trace of about 58 cycles, with an effect or without.
std::string trace(const std::string& more, int seed) {
  const Workshop shop;
  shop.identify(
      "simulate --radius 15mm --duration 12s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s --scatter 0.004 " + more +
      " --seed " + std::to_string(seed) + " --out trace.csv --quiet");
  return contents(shop / "trace.csv");
}
const std::string& empty_trace() {
  static const std::string text = trace("--speed 4rpm", 3);
  return text;
}
const std::string& viscous_trace() {
  static const std::string text = trace("--speed 4rpm --effect viscous:sigma=0.0015s/mm", 4);
  return text;
}

json result_of(const Workshop& shop, const std::string& arguments, int status = 0) {
  const Outcome outcome = shop.identify("diagnose --quiet --json d.json " + arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return json_in(shop / "d.json");
}

TEST(Diagnose, NothingIsNamedWhereNothingIsHidden) {
  const Workshop shop;
  shop.write("trace.csv", empty_trace());
  const json j = result_of(shop, "--radius 15mm --speed 4rpm --load 50N trace.csv");
  EXPECT_EQ(j["diagnosis"]["verdict"], "sufficient");
  EXPECT_EQ(j["diagnosis"]["ladder"].size(), 1u);
  EXPECT_EQ(j["trace"]["path"], "trace.csv");
}

TEST(Diagnose, ATimeLimitLeavesWhatIsKnown) {
  const Workshop shop;
  shop.write("trace.csv", viscous_trace());
  const Outcome cut = shop.identify("diagnose --radius 15mm --time-limit 1us --json d.json trace.csv");
  EXPECT_EQ(cut.status, 0) << cut.err;
  EXPECT_THAT(cut.out, HasSubstr("The time was over before every effect was"));
  EXPECT_THAT(cut.out, HasSubstr("identify diagnose --radius 15mm trace.csv\n")) << "the next command has no limit";
  const json j = json_in(shop / "d.json");
  EXPECT_EQ(j["diagnosis"]["verdict"], "unfinished");
  bool untried = false;
  for (const json& effect : j["diagnosis"]["effects"]) untried = untried || effect["status"] == "untried";
  EXPECT_TRUE(untried);
  for (const char* limit : {"0s", "-1s", "soon", "1e300s"}) {
    const Outcome bad = shop.identify(std::string("diagnose --radius 15mm --time-limit ") + limit + " trace.csv");
    EXPECT_EQ(bad.status, 3) << limit;
    EXPECT_THAT(bad.err, HasSubstr("--time-limit")) << limit;
  }
}

TEST(Diagnose, AHiddenEffectIsNamedAndTheNextCommandRuns) {
  const Workshop shop;
  shop.write("trace.csv", viscous_trace());
  Outcome outcome = shop.identify("diagnose --radius 15mm --speed 4rpm --load 50N --json d.json --csv out trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());  // no progress where nobody watches
  const json j = json_in(shop / "d.json");
  const json& ladder = j["diagnosis"]["ladder"];
  ASSERT_EQ(ladder.size(), 2u);
  EXPECT_TRUE(ladder[0]["added"].is_null());
  const auto equivalent = ladder[1]["equivalent"].get<std::vector<std::string>>();
  EXPECT_TRUE(ladder[1]["added"] == "viscous" ||
              std::find(equivalent.begin(), equivalent.end(), "viscous") != equivalent.end());
  EXPECT_EQ(lines_of(contents(shop / "out/samples.csv")).size(), 60001u);
  ASSERT_THAT(next_command(outcome.out), Not(IsEmpty())) << outcome.out;
  outcome = shop.shell(next_command(outcome.out));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

/// An effect that the user names is part of the law from the first rung on.
TEST(Diagnose, StartsFromTheLawWithTheEffectsThatAreNamed) {
  const Workshop shop;
  shop.write("trace.csv", viscous_trace());
  const json bare = result_of(shop, "--radius 15mm --speed 4rpm --load 50N trace.csv");
  const Outcome outcome =
      shop.identify("diagnose --radius 15mm --speed 4rpm --load 50N --effect viscous --json d.json trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("law with viscous "), HasSubstr("--effect viscous")));
  const json j = json_in(shop / "d.json");
  const json& diagnosis = j["diagnosis"];
  EXPECT_EQ(diagnosis["verdict"], "sufficient");
  EXPECT_EQ(diagnosis["from_the_start"], json({"viscous"}));
  ASSERT_EQ(diagnosis["ladder"].size(), 1u);
  EXPECT_TRUE(diagnosis["ladder"][0]["added"].is_null());
  EXPECT_LT(diagnosis["ladder"][0]["held_out_rmse"],
            0.8 * bare["diagnosis"]["ladder"][0]["held_out_rmse"].get<double>());
  EXPECT_EQ(j["fits"][0]["effects"], json({"viscous"}));
  for (const json& effect : diagnosis["effects"]) {
    if (effect["key"] != "viscous") continue;
    EXPECT_EQ(effect["reason"], "it is part of the model from the start");
    EXPECT_NEAR(parameter(effect, "sigma")["value"], 0.0015, 0.0002);
  }
}

/// Both forms of an effect are tried under one key; the plain one stays unless the data tell the other from it.
TEST(Diagnose, TheFormOfAnEffectIsToldWhereTheDataTellIt) {
  const Workshop shop;
  for (const char* name : {"rate-state", "rate-state:healing"}) {
    const std::string effect = std::string(name) + (std::string(name) == "rate-state" ? ":" : ",") + "D_c=80um";
    shop.write("trace.csv", trace("--speed 4rpm --effect " + effect, 6));
    const json j = result_of(shop, "--radius 15mm --speed 4rpm trace.csv");
    ASSERT_EQ(j["diagnosis"]["ladder"].size(), 2u) << name;
    EXPECT_EQ(j["diagnosis"]["ladder"][1]["added"], "rate-state") << name;
    EXPECT_EQ(j["fits"].back()["effect_names"], json({name}));
    int findings = 0;
    for (const json& effect_found : j["diagnosis"]["effects"]) {
      if (effect_found["key"] != "rate-state") continue;
      ++findings;
      EXPECT_EQ(effect_found["status"], "missing");
      EXPECT_NEAR(parameter(effect_found, "D_c")["value"], 80, 8) << name;
    }
    EXPECT_EQ(findings, 1) << name;
  }
}

TEST(Diagnose, ResultsAreTheSameForAnyNumberOfThreads) {
  const Workshop shop;
  shop.write("trace.csv", viscous_trace());
  json one = result_of(shop, "--radius 15mm --threads 1 trace.csv");
  json two = result_of(shop, "--radius 15mm --threads 2 trace.csv");
  one.erase("tool");
  two.erase("tool");
  EXPECT_EQ(one.dump(), two.dump());
}

TEST(Diagnose, AFolderWithAManifestIsDiagnosedTogetherAndRepeatsConfirm) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  shop.write("runs/a1.csv", viscous_trace());
  shop.write("runs/a2.csv", trace("--speed 4rpm --effect viscous:sigma=0.0015s/mm", 7));
  shop.write("runs/b1.csv", trace("--speed 8rpm --effect viscous:sigma=0.0015s/mm", 5));
  shop.write("runs/manifest.csv", "file,radius [mm],speed_rpm,load,repeat\na*.csv,15,4,50N,\nb1.csv,15,8,50N,1\n");
  const json j = result_of(shop, "runs");
  ASSERT_EQ(j["traces"].size(), 2u);
  EXPECT_EQ(j["traces"][0]["path"], "runs/a1.csv");
  EXPECT_EQ(j["conditions"][1]["speed_source"], "manifest");
  ASSERT_EQ(j["diagnosis"]["confirmations"].size(), 1u);
  EXPECT_EQ(j["diagnosis"]["confirmations"][0]["path"], "runs/a2.csv");
  EXPECT_THAT(j["traces"][0]["notes"].dump(), HasSubstr("not used in the diagnosis"));
  EXPECT_TRUE(parameter(j["fits"][0], "mu_s")["trace"].is_null());

  const json named = result_of(shop, "--load 40N --confirm runs/b1.csv runs");
  ASSERT_EQ(named["traces"].size(), 2u);  // what is named is kept, and nothing else
  EXPECT_EQ(named["traces"][1]["path"], "runs/a2.csv");
  EXPECT_EQ(named["conditions"][0]["load_N"], 40.0);  // the command line beats the manifest, and says so
  EXPECT_THAT(named["warnings"].dump(), HasSubstr("--load 40 N is used, not the 50 N of runs/manifest.csv:2"));
}

/// A copy of a run is no repeat of it, and confirms nothing.
TEST(Diagnose, IdenticalFilesAreOneRun) {
  const Workshop shop;
  for (const char* name : {"a.csv", "b.csv", "c.csv"}) shop.write(name, viscous_trace());
  const json one = result_of(shop, "--radius 15mm --speed 4rpm a.csv");
  const json three = result_of(shop, "--radius 15mm --speed 4rpm --confirm c.csv a.csv b.csv");
  EXPECT_EQ(three["fits"], one["fits"]);
  EXPECT_TRUE(three["diagnosis"]["confirmations"].empty());
  for (const char* copy : {"b.csv", "c.csv"}) {
    EXPECT_THAT(three["warnings"].dump(), HasSubstr(std::string(copy) + " holds the same values as a.csv"));
  }
}

TEST(Diagnose, IdentifyTakesConditionsFromTheManifestToo) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  shop.write("runs/a.csv", good_trace());
  shop.write("runs/manifest.csv", "file,radius\na.csv,15mm\n");
  const Outcome outcome = shop.identify("runs");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("15 mm (manifest)"), HasSubstr("--radius 15mm")));
  shop.write("runs/manifest.csv", "file,radius\na.csv,15mn\n");
  for (const char* verb : {"", "diagnose "}) {
    const Outcome bad = shop.identify(std::string(verb) + "runs");
    EXPECT_EQ(bad.status, 3);
    EXPECT_THAT(bad.err, HasSubstr("runs/manifest.csv:2: column radius: unknown unit 'mn'"));
  }
}

TEST(Diagnose, FormulasComeFromAFile) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.write("mine.txt", "# mine\n\nhump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s\n  rise = b*v; b=0.001\n");
  const Outcome good = shop.identify("--radius 15mm --law exponential --formula @mine.txt --json r.json trace.csv");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_EQ(json_in(shop / "r.json")["fits"][0]["effects"], json({"hump", "rise"}));
  shop.write("mine.txt", "rise = b*v; b=0.001\nfall = b*vv; b=0.001\n");
  for (const char* verb : {"", "diagnose "}) {
    const Outcome bad = shop.identify(std::string(verb) + "--radius 15mm --formula @mine.txt trace.csv");
    EXPECT_EQ(bad.status, 3);
    EXPECT_THAT(bad.err, AllOf(HasSubstr("mine.txt:2"), HasSubstr("'vv'")));
  }
  EXPECT_EQ(shop.identify("--radius 15mm --formula @none.txt trace.csv").status, 3);
}

TEST(Diagnose, TooFewCyclesAreSaidToBeTooFew) {
  const Workshop shop;
  std::vector<std::string> lines = lines_of(good_trace());
  lines.resize(4000);
  shop.write("trace.csv", joined(lines));
  const json j = result_of(shop, "--radius 15mm trace.csv", 1);
  EXPECT_EQ(j["diagnosis"]["verdict"], "not-enough-data");
}

TEST(Diagnose, TooShortTracesSayWhatWouldBeEnough) {
  const Workshop shop;
  std::vector<std::string> lines = lines_of(empty_trace());
  lines.resize(8000);  // 1.6 s, some seven cycles
  shop.write("trace.csv", joined(lines));
  const Outcome outcome = shop.identify("diagnose --radius 15mm --json d.json trace.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("12 are needed to hold some of them out"));
  const json j = json_in(shop / "d.json");
  EXPECT_EQ(j["diagnosis"]["verdict"], "not-enough-data");
  EXPECT_THAT(j["diagnosis"]["next_experiment"].get<std::string>(), HasSubstr("Record for at least"));
}

/// What is wrong with the effects a user asks for is said, whatever the data hold.
TEST(Diagnose, BadEffectsAreRefusedWithAReason) {
  const Workshop shop;
  shop.write("trace.csv", empty_trace());
  struct Case {
    const char* arguments;
    int status;
    const char* says;
  };
  for (const Case& c :
       std::vector<Case>{{"--effect temperature-dependence", 1, "needs the channel 'temperature'"},
                         {"--formula 'x = a*temperature; a=0.001'", 1, "needs the channel 'temperature'"},
                         {"--effect load-dependence", 1, "needs the channel 'load'"},
                         {"--formula 'hump = a*exp(-((v-v0)/w^2; a=0.02, v0=25, w=6'", 3, "parenthesis"},
                         {"--formula 'x = a*vv; a=1'", 3, "'vv'"},
                         {"--formula 'x = a*log(v-500); a=0.1'", 1, "'x' is not finite on these data"},
                         {"--formula 'x = a/(v-v); a=0.1'", 1, "'x' is not finite on these data"},
                         {"--formula 'x = a*(v-v); a=0.1'", 1, "'x' is zero on these data"},
                         {"--effect viscuos", 2, "did you mean 'viscous'?"},
                         {"--effect viscous --effect viscous", 2, "the effect 'viscous' is given twice"},
                         {"--formula 'x = a*v; a=0.1' --formula 'x = a*t; a=0.1'", 2, "the effect 'x' is given twice"},
                         {"--formula 'viscous = a*v; a=0.1'", 2, "give it another name"},
                         {"--law exponental", 2, "exponential"},
                         {"--columns mu=COF", 3, "COF"}}) {
    const Outcome outcome =
        shop.identify(std::string("diagnose --quiet --radius 15mm --speed 4rpm ") + c.arguments + " trace.csv");
    EXPECT_EQ(outcome.status, c.status) << c.arguments << '\n' << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(c.says)) << c.arguments;
  }
}

TEST(Diagnose, ForeignFilesAreNotGuessedAt) {
  const Workshop shop;
  shop.write("rig.csv", "time_s,qm_m,Force1_N,dq_f_m_per_s\n0,0,1,0.1\n0.001,0,1,0.1\n0.002,0,1,0.1\n");
  const Outcome unnamed = shop.identify("diagnose rig.csv");
  EXPECT_EQ(unnamed.status, 3);
  EXPECT_THAT(unnamed.err, AllOf(HasSubstr("no friction column"), HasSubstr("Force1_N"), HasSubstr("--columns")));
  shop.write("words.csv", "hello world\n");
  EXPECT_EQ(shop.identify("diagnose --radius 15mm words.csv").status, 3);
  EXPECT_EQ(shop.identify("diagnose --radius 15mm absent.csv").status, 3);
  EXPECT_EQ(shop.identify("diagnose --radius 15mm").status, 2);
}

TEST(Diagnose, NothingIsLeftBehindByAnInterruption) {
  const Workshop shop;
  const Outcome outcome =
      shop.shell("'" TRIBOFIT_IDENTIFY
                 "' simulate --radius 15mm --duration 600s --out big.csv & P=$!\n"
                 "for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30; do\n"
                 "  ls -a | grep -q part && break; sleep 0.1; done\n"
                 "ls -a | grep part; kill -TERM $P; wait $P");
  EXPECT_THAT(outcome.out, HasSubstr(".part"));
  EXPECT_THAT(shop.names(), IsEmpty());
}

TEST(Diagnose, BoundsHoldAParameter) {
  const Workshop shop;
  shop.write("trace.csv", empty_trace());
  const json j =
      result_of(shop, "--radius 15mm --speed 4rpm --law exponential --bounds alpha=0.06..0.07s/mm trace.csv");
  for (const json& fit : j["fits"]) {
    const double alpha = parameter(fit, "alpha")["value"];
    EXPECT_TRUE(0.06 <= alpha && alpha <= 0.07) << alpha;
  }
  EXPECT_EQ(shop.identify("diagnose --radius 15mm --bounds aplha=1..2 trace.csv").status, 2);
}

/// One record that cannot be used is named and left out; the others are diagnosed as they are without it.
TEST(Diagnose, OneUnusableRecordDoesNotStopTheOthers) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  shop.write("runs/a.csv", viscous_trace());
  shop.write("runs/b.csv", trace("--speed 4rpm --effect viscous:sigma=0.0015s/mm", 5));
  const json alone = result_of(shop, "--radius 15mm --speed 4rpm runs");
  shop.write("runs/broken.csv", "time_s,mu,v_b_mm_s\n0,abc,1\n");
  std::string still = "time_s,mu,v_b_mm_s\n";
  for (int i = 0; i < 2000; ++i) still += std::to_string(i * 2e-4) + ",0.4,3.0\n";
  shop.write("runs/still.csv", still);
  const Outcome outcome = shop.identify("diagnose --quiet --json d.json --radius 15mm --speed 4rpm runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("left out: runs/broken.csv"), HasSubstr("left out: runs/still.csv")));
  const json j = json_in(shop / "d.json");
  EXPECT_EQ(j["trace"]["path"], "runs/a.csv") << "the other one confirms";
  EXPECT_EQ(j["diagnosis"], alone["diagnosis"]);
  std::filesystem::remove(shop / "runs/a.csv");
  std::filesystem::remove(shop / "runs/b.csv");
  EXPECT_NE(shop.identify("diagnose --radius 15mm --speed 4rpm runs").status, 0);
}

/// The delay of a slow force sensor alone would leave what it does to jumps, and that passes for a memory.
TEST(Diagnose, ADeclaredFilterStandsInEveryModel) {
  const Workshop shop;
  shop.write("lab.json", R"({"force_sensor": {"bandwidth": "200 Hz"}})");
  const std::string options = "--radius 15mm --speed 4rpm --load 50N --instruments lab.json trace.csv";
  shop.write("trace.csv", trace("--speed 4rpm --force-bandwidth 200Hz", 5));
  EXPECT_EQ(result_of(shop, options)["diagnosis"]["verdict"], "sufficient");
  ASSERT_EQ(shop.identify("--quiet --law exponential --json i.json " + options).status, 0);
  const json fit = json_in(shop / "i.json")["fits"][0];
  EXPECT_NEAR(parameter(fit, "alpha")["value"].get<double>() / 0.05214, 1, 0.01);
  shop.write("trace.csv", trace("--speed 4rpm --force-bandwidth 200Hz --effect frictional-lag:tau=1ms", 6));
  const json found = result_of(shop, options)["diagnosis"];
  EXPECT_EQ(found["verdict"], "effect-found");
  EXPECT_EQ(found["ladder"].back()["added"], "frictional-lag");
}

}  // namespace
