#include "tribofit/campaign/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "runs.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRpm = 2 * std::numbers::pi / 60;

ManifestRow row_of(const std::string& pattern, const std::string& name) {
  const auto fields = NamePattern(pattern).read(name);
  return fields ? row_from(*fields, name, "file name") : ManifestRow{};
}

TEST(NamePatternTest, ReadsFieldsWithTheirUnits) {
  const ManifestRow row = row_of("r{radius}mm_{speed}rpm_{load}kN_{lot}_{repeat}.csv", "r7.5mm_4rpm_0.05kN_A-7_03.csv");
  EXPECT_DOUBLE_EQ(row.conditions.radius.value, 0.0075);
  EXPECT_EQ(row.conditions.radius.source, "file name");
  EXPECT_DOUBLE_EQ(row.conditions.speed.value, 4 * kRpm);
  EXPECT_DOUBLE_EQ(row.conditions.load.value, 50);
  EXPECT_EQ(row.repeat, 3);
  ASSERT_EQ(row.others.size(), 1u);
  EXPECT_EQ(row.others[0].name, "lot");
  EXPECT_EQ(row.others[0].value, "A-7");
}

TEST(NamePatternTest, UnitsMayStandInTheName) {
  EXPECT_DOUBLE_EQ(row_of("{radius}_{load}_*", "15mm_50N_x.csv").conditions.radius.value, 0.015);
  EXPECT_DOUBLE_EQ(row_of("{radius}_{load}_*", "1.5cm_2kN_x.tsv").conditions.load.value, 2000);
  EXPECT_THROW(row_of("{radius}_{repeat}", "15_1.csv"), InputError);
  EXPECT_THROW(row_of("{radius}mm_{repeat}", "0mm_1.csv"), InputError);
}

TEST(NamePatternTest, TheWholeNameMustFit) {
  const NamePattern pattern("r{radius}mm_{repeat}.csv");
  EXPECT_TRUE(pattern.read("r15mm_1.csv"));
  for (const char* name : {"r15mm_1.csv.bak", "xr15mm_1.csv", "r15mm_1xcsv", "r15mm_.csv", "r15cm_1.csv"}) {
    EXPECT_FALSE(pattern.read(name)) << name;
  }
}

TEST(NamePatternTest, RefusesWhatIsNoPattern) {
  for (const char* pattern : {"r{radius", "radius}", "plain.csv", "{}", "{lot}_{lot}", "{radius}{radius}"}) {
    EXPECT_THROW(NamePattern{pattern}, InputError) << pattern;
  }
}

TEST(NaturalOrder, NumbersCountAsNumbers) {
  std::vector<std::string> names = {"r12mm_1", "r9mm_10", "r18mm_1", "r9mm_2", "a", "r9mm_02"};
  std::sort(names.begin(), names.end(), in_natural_order);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "r9mm_02", "r9mm_2", "r9mm_10", "r12mm_1", "r18mm_1"}));
  EXPECT_FALSE(in_natural_order("a1", "a1"));
}

TEST(UsualFields, RecognisesTheUsualWaysOfNaming) {
  struct Case {
    const char *name, *radius, *speed, *load, *repeat;
  };
  for (const Case& c :
       {Case{"r15mm_1.csv", "15mm", "", "", "1"}, Case{"15mm-4rpm-50N-run03.csv", "15mm", "4rpm", "50N", "3"},
        Case{"R7.5MM_n12RPM_F0.5kN rep2.csv", "7.5mm", "12rpm", "0.5kN", "2"},
        Case{"steel_20mm_s_(4).csv", "", "", "", "4"}, Case{"r15mm_r9mm.csv", "", "", "", ""},
        Case{"trace.csv", "", "", "", ""}, Case{"radius_12mm.csv", "12mm", "", "", ""},
        Case{"2026-11-21.csv", "", "", "", "21"}}) {
    const StatedFields fields = usual_fields(c.name);
    EXPECT_EQ(fields.radius, c.radius) << c.name;
    EXPECT_EQ(fields.speed, c.speed) << c.name;
    EXPECT_EQ(fields.load, c.load) << c.name;
    EXPECT_EQ(fields.repeat, c.repeat) << c.name;
  }
  const StatedFields warm = usual_fields("r15mm_T60C_1.csv");
  ASSERT_EQ(warm.others.size(), 1u);
  EXPECT_EQ(warm.others[0].value, "60degC");
}

TEST(HeaderFields, ReadsTheLinesAboveTheTable) {
  const Workshop shop;
  shop.write("a.csv",
             "# Operator: 15 mm\n# Radius: 15 mm\n\"Normal load [N]\";50\nSpeed = 4 rpm\nComment: load test\n"
             "time_s,mu,v_b [mm/s]\n0,0.3,1\n0.1,0.3,1\n0.2,0.3,1\n");
  const StatedFields fields = header_fields((shop / "a.csv").string());
  EXPECT_EQ(fields.radius, "15 mm");
  EXPECT_EQ(fields.load, "50N");
  EXPECT_EQ(fields.speed, "4 rpm");
  EXPECT_EQ(header_fields((shop / "missing.csv").string()).radius, "");
}

class DraftTest : public ::testing::Test {
 protected:
  DraftTest() {
    std::filesystem::create_directory(shop_ / "runs");
    shop_.write("runs/r15mm_50N_1.csv", short_trace(1));
    shop_.write("runs/r15mm_50N_2.csv", short_trace(2));
    shop_.write("runs/odd, one.csv", "# radius: 9 mm\n" + short_trace(3));
  }
  Workshop shop_;
};

TEST_F(DraftTest, IsAManifestThatItsReaderUnderstands) {
  const Outcome outcome = shop_.identify("manifest runs");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "file,radius,speed,load,repeat\n\"odd, one.csv\",9 mm,,,\nr15mm_50N_1.csv,15mm,,50N,1\n"
            "r15mm_50N_2.csv,15mm,,50N,2\n");
  shop_.write("runs/manifest.csv", outcome.out);
  const Manifest manifest = read_manifest((shop_ / "runs").string());
  ASSERT_EQ(manifest.rows.size(), 3u);
  EXPECT_DOUBLE_EQ(manifest.rows[0].conditions.radius.value, 0.009);
  EXPECT_EQ(manifest.rows[2].repeat, 2);
}

/// What a line, a spreadsheet or a screen would not keep is written so that the file is found all the same.
TEST_F(DraftTest, KeepsAnyNameThatAFileCanHave) {
  const std::vector<std::string> names = {
      "=1+2.csv",      "@SUM(1).csv",        "-1.csv",        "+a.csv",     "'=b.csv",           "#c.csv",
      " d.csv",        "e\nf.csv",           "g\th.csv",      "i\"j\".csv", "k,l;m.csv",         "n*[o].csv",
      "p[q]\n\\r.csv", "s\xe2\x80\xaet.csv", "\xc3\xa4u.csv", "v\xe4w.csv", "x\xe2\x80\x8b.csv", "'y'.csv"};
  std::filesystem::create_directory(shop_ / "any");
  for (const std::string& name : names) shop_.write("any/" + name, short_trace(1));
  ASSERT_EQ(shop_.identify("manifest any --out any/manifest.csv").status, 0);
  EXPECT_THAT(contents(shop_ / "any/manifest.csv"),
              ::testing::AllOf(HasSubstr("\n'=1+2.csv,"), HasSubstr("\n'-1.csv,")));
  const Manifest manifest = read_manifest((shop_ / "any").string());
  std::set<std::string> found;
  for (const ManifestRow& row : manifest.rows) found.insert(std::filesystem::path(row.path).filename().string());
  EXPECT_EQ(found, std::set<std::string>(names.begin(), names.end()));
  const Outcome printed =
      shop_.shell("identify manifest any > printed; rm any/manifest.csv; mv printed any/manifest.csv");
  EXPECT_EQ(read_manifest((shop_ / "any").string()).rows.size(), names.size()) << printed.err;
}

/// 255 bytes are the most of every usual file system; what is written beside them has no longer name.
TEST_F(DraftTest, NamesMayBeAsLongAsAFileSystemHasThem) {
  std::filesystem::create_directory(shop_ / "long");
  const std::string much(246, 'n');
  for (const char* end : {"1.csv", "2.csv"}) shop_.write("long/" + much + end, short_trace(1));
  for (const char* found : {"2 fitted", "2 already there"}) {
    const Outcome outcome = shop_.identify("--radius 15mm --out res long");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(found));
  }
  const Outcome one = shop_.identify("--radius 15mm --json " + much + "9.json long/" + much + "1.csv");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(std::filesystem::exists(shop_ / (much + "9.json")));
}

TEST_F(DraftTest, SpreadsheetsReadNamesAsText) {
  std::filesystem::create_directory(shop_ / "cells");
  for (const char* name : {"=cmd.csv", "-2.csv", "7.csv"}) shop_.write(std::string("cells/") + name, short_trace(1));
  ASSERT_EQ(shop_.identify("--radius 15mm --quiet --out res cells").status, 0);
  const std::string summary = contents(shop_ / "res/summary.csv");
  EXPECT_THAT(summary, ::testing::AllOf(HasSubstr("\n'=cmd,'=cmd.csv,ok,"), HasSubstr("\n-2,'-2.csv,ok,"),
                                        HasSubstr("\n7,7.csv,ok,")));
}

TEST_F(DraftTest, NeverOverwritesWithoutForce) {
  shop_.write("runs/manifest.csv", "mine");
  EXPECT_EQ(shop_.identify("manifest runs --out runs/manifest.csv").status, 2);
  EXPECT_EQ(contents(shop_ / "runs/manifest.csv"), "mine");
  EXPECT_EQ(shop_.identify("manifest runs --out runs/manifest.csv --force").status, 0);
  EXPECT_THAT(contents(shop_ / "runs/manifest.csv"), HasSubstr("r15mm_50N_2.csv,15mm"));
}

TEST_F(DraftTest, NamesWhatDoesNotFitThePattern) {
  const Outcome outcome = shop_.identify("manifest runs --pattern '{radius}mm_{load}N_{repeat}.csv'");
  EXPECT_THAT(outcome.out, HasSubstr("# r15mm_50N_1.csv does not fit the pattern"));
  const Outcome fits = shop_.identify("manifest runs --pattern 'r{radius}mm_{load}N_{lot}'");
  EXPECT_THAT(fits.out, HasSubstr("file,radius,speed,load,repeat,lot\n"));
  EXPECT_THAT(fits.out, HasSubstr("r15mm_50N_2.csv,15mm,,50N,,2\n"));
  EXPECT_EQ(shop_.identify("manifest runs --pattern 'r{radius'").status, 3);
}

/// A batch by the pattern fits what one by the manifest drafted with it fits.
TEST_F(DraftTest, ABatchReadsNamesByTheSamePattern) {
  std::filesystem::remove(shop_ / "runs/odd, one.csv");
  const std::string pattern = " --pattern 'r{radius}mm_{load}N_{repeat}.csv' ";
  ASSERT_EQ(shop_.identify("runs" + pattern + "--quiet --out named").status, 0);
  EXPECT_EQ(shop_.identify("manifest runs" + pattern + "--out runs/manifest.csv").status, 0);
  EXPECT_EQ(shop_.identify("runs" + pattern + "--out both").status, 3);
  ASSERT_EQ(shop_.identify("runs --quiet --out listed").status, 0);
  const auto named = json_in(shop_ / "named/summary.json"), listed = json_in(shop_ / "listed/summary.json");
  ASSERT_EQ(named["runs"].size(), 2u);
  EXPECT_EQ(named["runs"][0]["fits"], listed["runs"][0]["fits"]);
  EXPECT_EQ(named["runs"][1]["repeat"], 2);
  EXPECT_EQ(named["runs"][0]["conditions"]["radius_source"], "file name");
}

TEST_F(DraftTest, AFileThatDoesNotFitIsNamedAndTheRestDone) {
  const Outcome outcome = shop_.identify("runs --pattern 'r{radius}mm_{load}N_{repeat}.csv' --out res");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("odd, one.csv: does not fit the pattern"));
  EXPECT_THAT(outcome.out, HasSubstr("2 fitted, 0 already there, 1 failed"));
}

}  // namespace
}  // namespace tribofit
