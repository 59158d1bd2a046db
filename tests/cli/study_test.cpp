#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"

namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kMap = "study map --radius 15mm --x stiffness=8N/mm..20N/mm:60 --y mass=0.5kg..1.5kg:60 --quiet";

TEST(StudyCommand, SpeedSaysTheCriticalSpeedBothWaysInEveryForm) {
  const Workshop shop;
  const Outcome outcome = shop.identify("study speed --radius 15mm --json s.json --csv out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("steady sliding loses its stability below"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  identify study sensitivity --radius 15mm\n"));
  const json study = json_in(shop / "s.json")["study"];
  EXPECT_EQ(study["kind"], "speed");
  // c = N (mu_s - mu_k) alpha exp(-alpha v) at the published 15 mm test with our rig.
  EXPECT_NEAR(study["critical_speed"]["linear_mm_s"][0], std::log(50 * 0.191 * 52.14 / 4.693826) / 0.05214, 0.01);
  EXPECT_GT(study["critical_speed"]["stick_vanishes_mm_s"], study["critical_speed"]["linear_mm_s"][0]);
  EXPECT_NEAR(study["own"]["frequency_hz"], 4.883, 0.01);
  const std::string table = contents(shop / "out/speed.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + static_cast<long>(study["points"].size()));
}

TEST(StudyCommand, WhatWouldMoreDampingDo) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  ASSERT_EQ(shop.identify("study speed --radius 15mm --load 50N --json a.json trace.csv").status, 0);
  ASSERT_EQ(shop.identify("study speed --radius 15mm --load 50N --damping-ratio 0.1 --json b.json trace.csv").status,
            0);
  const json a = json_in(shop / "a.json")["study"], b = json_in(shop / "b.json")["study"];
  EXPECT_NEAR(a["machine"]["mass_kg"], 0.85, 0.01);
  EXPECT_EQ(b["machine"]["mass_kg"], a["machine"]["mass_kg"]);
  EXPECT_NEAR(b["machine"]["damping_ratio"], 0.1, 1e-12);
  const json& before = a["critical_speed"];
  EXPECT_LT(b["critical_speed"]["linear_mm_s"][0], before["linear_mm_s"][0]);
  EXPECT_LT(before["linear_ci95_mm_s"][0], before["linear_mm_s"][0]);
  EXPECT_GT(before["linear_ci95_mm_s"][1], before["linear_mm_s"][0]);
}

TEST(StudyCommand, TheDiagnosisItWarnsToRunReadsTheRecordAsItDid) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("simulate --radius 15mm --duration 8s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s "
                          "--effect frictional-lag:tau=2ms --out trace.csv")
                .status,
            0);
  // What is of the study or of the machine does not belong to it.
  const Outcome outcome = shop.identify(
      "study phase --radius 15mm --load 50N --kind stick-slip --columns v_b=v_b_mm_s:mm/s --mass 0.9kg --at 4mm/s "
      "--threads 1 trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out + outcome.err, HasSubstr("times the noise floor"));
  std::string text = outcome.out + outcome.err;
  for (const char* fold : {"\\\n", "\n"}) {
    for (std::size_t at; (at = text.find(fold)) != std::string::npos;) text.replace(at, std::string(fold).size(), " ");
  }
  for (std::size_t at; (at = text.find("  ")) != std::string::npos;) text.erase(at, 1);
  EXPECT_THAT(text,
              HasSubstr("identify diagnose --radius 15mm --load 50N --columns v_b=v_b_mm_s:mm/s --kind stick-slip "
                        "trace.csv"));
}

TEST(StudyCommand, AMassThatTheLawFindsBelowTheSensorSwingsWithTheBlock) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("simulate --radius 15mm --duration 8s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s "
                          "--mass-below 0.3kg --out trace.csv")
                .status,
            0);
  // The effect stands just before the file: it must not take that for another one.
  const Outcome outcome =
      shop.identify("study phase --radius 15mm --load 50N --json a.json --effect sensor-inertia trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json machine = json_in(shop / "a.json")["study"]["machine"];
  EXPECT_NEAR(machine["mass_kg"], 0.85, 0.02);
  EXPECT_THAT(machine["notes"].dump(), HasSubstr("below the force sensor"));
}

TEST(StudyCommand, EveryKindWritesItsTables) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("study phase --radius 15mm --at 6mm/s,500mm/s --csv p --json p.json").status, 0);
  EXPECT_THAT(contents(shop / "p/phase_1.csv"), HasSubstr("time_s,displacement_mm,block_velocity_mm_s"));
  EXPECT_THAT(contents(shop / "p/cycle_1.csv"), HasSubstr(",slip\n"));
  EXPECT_FALSE(std::filesystem::exists(shop / "p/cycle_2.csv"));  // dies out: no cycle
  EXPECT_EQ(json_in(shop / "p.json")["study"]["portraits"][1]["settled"]["regime"], "sliding");
  ASSERT_EQ(shop.identify("study response --radius 15mm --csv r").status, 0);
  EXPECT_THAT(contents(shop / "r/harmonics.csv"), HasSubstr("harmonic,frequency_hz,force_N"));
  ASSERT_EQ(shop.identify("study sensitivity --radius 15mm --vary stiffness --vary ratio --csv s").status, 0);
  EXPECT_THAT(contents(shop / "s/elasticities.csv"), HasSubstr("stiffness,N/mm,16.2,"));
}

TEST(StudyCommand, AMapThatWasKilledEndsTheSame) {
  const Workshop shop;
  const std::string map = "study map --radius 15mm --x stiffness=8N/mm..20N/mm:80 --y mass=0.5kg..1.5kg:80 --quiet";
  ASSERT_EQ(shop.identify(map + " --csv whole --threads 1").status, 0);
  const std::string whole = contents(shop / "whole/map.csv");
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 6401);
  bool was_cut = false;
  for (const char* after : {"0", "0.1"}) {  // of the first rows
    shop.shell("'" TRIBOFIT_IDENTIFY "' " + map + " --csv cut & id=$!; for i in $(seq 1000); do\n" +
               "  [ ! -s cut/map.rows ] || break; sleep 0.02; done; sleep " + after + "; kill -KILL $id; wait $id");
    was_cut =
        was_cut || (std::filesystem::exists(shop / "cut/map.rows") && !std::filesystem::exists(shop / "cut/map.csv"));
  }
  EXPECT_TRUE(was_cut);
  // A row that was cut off in the middle does not count.
  shop.shell("truncate -s -7 cut/map.rows 2>/dev/null");
  ASSERT_EQ(shop.identify(map + " --csv cut --threads 2").status, 0);
  EXPECT_EQ(contents(shop / "cut/map.csv"), whole);
  EXPECT_FALSE(std::filesystem::exists(shop / "cut/map.rows"));
  // Nothing is written over without a word.
  const Outcome again = shop.identify(map + " --csv cut");
  EXPECT_EQ(again.status, 3);
  EXPECT_THAT(again.err, HasSubstr("a map exists here already"));
}

TEST(StudyCommand, RowsOfAnotherMapAreNotUsed) {
  const Workshop shop;
  shop.shell(std::string("timeout -s KILL 0.2 '" TRIBOFIT_IDENTIFY "' ") + kMap +
             " --load 40N --csv m; rm -f m/map.csv");
  ASSERT_EQ(shop.identify(std::string(kMap) + " --csv m").status, 0);
  ASSERT_EQ(shop.identify(std::string(kMap) + " --csv n").status, 0);
  EXPECT_EQ(contents(shop / "m/map.csv"), contents(shop / "n/map.csv"));
}

TEST(StudyCommand, RowsOfAnotherFormulaAreNotUsed) {
  const Workshop shop;
  const std::string map = "study map --x stiffness=8N/mm..20N/mm:20 --y mass=0.5kg..1.5kg:20 --quiet --threads 1";
  // Name and numbers are the same.
  const std::string other = map + " --formula 'h = a*v/b; a=0.001, b=1mm/s'";
  const std::string formula = map + " --formula 'h = a*v*v/b/b; a=0.001, b=1mm/s'";
  shop.shell("timeout -s KILL 0.5 '" TRIBOFIT_IDENTIFY "' " + other + " --csv m; rm -f m/map.csv");
  ASSERT_EQ(shop.identify(formula + " --csv m").status, 0);
  ASSERT_EQ(shop.identify(formula + " --csv n").status, 0);
  EXPECT_EQ(contents(shop / "m/map.csv"), contents(shop / "n/map.csv"));
}

TEST(StudyCommand, MachinesAndAxesThatCannotBeAreNamed) {
  const Workshop shop;
  const auto refused = [&](const std::string& arguments, int status, const std::string& text) {
    const Outcome outcome = shop.identify(arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(text)) << arguments;
    EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
  };
  refused("study", 2, "name what to study");
  refused("study speed --mass -1kg", 3, "the mass of the block is not positive");
  refused("study speed --stiffness 0N/mm", 3, "the stiffness is not positive");
  refused("study speed --speed -4rpm", 3, "the disc does not turn forwards");
  refused("study speed --damping 1Ns/m --damping-ratio 0.1", 2, "exclude each other");
  refused("study speed --range 5mm/s..1mm/s", 3, "does not rise");
  refused("study map --x stifness --y mass", 3, "did you mean 'stiffness'");
  refused("study map --x mass --y mass", 3, "both axes");
  refused("study map --x velocity --y speed", 3, "set the same number");
  refused("study map --x mass=-1kg..1kg:5 --y load", 3, "mass = -1 kg");
  refused("study map --x mass --y load --measure loudness", 3, "there is no measure 'loudness'");
  refused("study sensitivity --vary colour", 3, "there is no parameter 'colour'");
  refused("study speed --sharpness 500s/mm --law fractional", 3, "smoothed law");
  refused("study speed --effect viscous", 2, "has no size");
  EXPECT_THAT(shop.names(), IsEmpty());
}

TEST(StudyCommand, WhatDescribesTheRecordIsNoWish) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify("study speed --radius 15mm --speed 40rpm --load 50N trace.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("--range and --at study other speeds"));
}

TEST(StudyCommand, MotionThatNeverSettlesSaysWhatWasSeen) {
  const Workshop shop;
  const Outcome outcome = shop.identify("study phase --radius 15mm --effect runout:A=0.05,phase=0");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("did not settle: stick-slip that does not repeat itself"));
}

}  // namespace
