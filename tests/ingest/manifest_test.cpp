#include "tribofit/ingest/manifest.hpp"

#include "temp_files.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

class ManifestTest : public TempFiles {
 protected:
  void SetUp() override {
    for (const char* name : {"r15-1.csv", "r15-2.csv", "r15-3.csv", "r9-1.csv"}) write("time_s,mu\n", name);
  }
  Manifest read(std::string_view text) const {
    write(text, manifest_name);
    return read_manifest(folder_.path());
  }
  void refuses(std::string_view text, std::size_t line, std::string_view column, std::string_view problem,
               std::string_view advice) const {
    try {
      read(text);
      FAIL() << "no InputError; expected: " << problem;
    } catch (const InputError& error) {
      EXPECT_THAT(error.problem(), ::testing::HasSubstr(std::string(problem)));
      EXPECT_THAT(error.advice(), ::testing::HasSubstr(std::string(advice)));
      EXPECT_EQ(error.where().file, path(manifest_name));
      EXPECT_EQ(error.where().line, line) << error.what();
      EXPECT_EQ(error.where().column, column) << error.what();
    }
  }
};

TEST_F(ManifestTest, UnitsStandInCellsOrHeaders) {
  const Manifest cells = read("file,radius,speed,load\nr15-1.csv,15mm,4rpm,50N\nr9-1.csv,0.9 cm,0.2rad/s,0.05kN\n");
  ASSERT_EQ(cells.rows.size(), 2u);
  EXPECT_EQ(cells.rows[0].path, path("r15-1.csv"));
  EXPECT_DOUBLE_EQ(cells.rows[0].conditions.radius.value, 0.015);
  EXPECT_EQ(cells.rows[0].conditions.radius.source, "manifest");
  EXPECT_DOUBLE_EQ(cells.rows[0].conditions.speed.value, 4 * kRpm);
  EXPECT_DOUBLE_EQ(cells.rows[1].conditions.radius.value, 0.009);
  EXPECT_DOUBLE_EQ(cells.rows[1].conditions.speed.value, 0.2);
  EXPECT_DOUBLE_EQ(cells.rows[1].conditions.load.value, 50);
  EXPECT_EQ(cells.rows[1].line, 3u);

  const Manifest headers = read("file,radius [mm],speed_rpm,load\nr15-1.csv,15,4,50\nr9-1.csv,9,0.2rad/s,\n");
  EXPECT_DOUBLE_EQ(headers.rows[0].conditions.radius.value, 0.015);
  EXPECT_DOUBLE_EQ(headers.rows[0].conditions.speed.value, 4 * kRpm);
  EXPECT_DOUBLE_EQ(headers.rows[1].conditions.speed.value, 0.2);  // the cell's own unit wins
  EXPECT_DOUBLE_EQ(headers.rows[0].conditions.load.value, 50);
  EXPECT_FALSE(headers.rows[1].conditions.load.known());
  EXPECT_THAT(headers.notes, ::testing::Contains(::testing::HasSubstr("in N")));
}

TEST_F(ManifestTest, OtherColumnsAreKeptAndNamed) {
  const Manifest m = read("file,radius,repeat,humidity [%],lot\nr15-1.csv,15mm,1,40,A\nr15-2.csv,15mm,2,40,A\n");
  ASSERT_EQ(m.rows.size(), 2u);
  EXPECT_EQ(m.rows[1].repeat, 2);
  ASSERT_EQ(m.rows[0].others.size(), 2u);
  EXPECT_EQ(m.rows[0].others[0].name, "humidity [%]");
  EXPECT_EQ(m.rows[0].others[0].value, "40");
  EXPECT_THAT(m.notes, ::testing::Contains(::testing::HasSubstr("humidity [%], lot")));
  EXPECT_TRUE(same_conditions(m.rows[0], m.rows[1]));
}

TEST_F(ManifestTest, ConditionsAreTheSameWhereNothingDiffers) {
  const Manifest m = read(
      "file,radius,speed,lot\nr15-1.csv,15mm,4rpm,A\nr15-2.csv,0.015m,4rpm,A\nr15-3.csv,15mm,4rpm,B\n"
      "r9-1.csv,9mm,4rpm,A\n");
  EXPECT_TRUE(same_conditions(m.rows[0], m.rows[1]));
  EXPECT_FALSE(same_conditions(m.rows[0], m.rows[2]));
  EXPECT_FALSE(same_conditions(m.rows[0], m.rows[3]));
}

TEST_F(ManifestTest, PatternsStandForTheirFilesInOrder) {
  const Manifest m = read("file,radius\nr15-?.csv,15mm\nr9*,9mm\n");
  ASSERT_EQ(m.rows.size(), 4u);
  EXPECT_EQ(m.rows[0].path, path("r15-1.csv"));
  EXPECT_EQ(m.rows[2].path, path("r15-3.csv"));
  EXPECT_DOUBLE_EQ(m.rows[2].conditions.radius.value, 0.015);
  EXPECT_DOUBLE_EQ(m.rows[3].conditions.radius.value, 0.009);
  EXPECT_EQ(read("file\n*\n").rows.size(), 4u);  // not the manifest itself
  EXPECT_EQ(read("file\n*1*.csv\n").rows.size(), 4u);
  EXPECT_EQ(read("file\n*2.csv\n").rows.size(), 1u);
}

TEST_F(ManifestTest, DialectsOfPeople) {
  const Manifest m =
      read("\xEF\xBB\xBF# campaign of May\r\n\r\n\"file\";radius [mm];speed\r\n\"r15-1.csv\";15,5;4,1rpm\r\n;;\r\n");
  ASSERT_EQ(m.rows.size(), 1u);
  EXPECT_DOUBLE_EQ(m.rows[0].conditions.radius.value, 0.0155);
  EXPECT_DOUBLE_EQ(m.rows[0].conditions.speed.value, 4.1 * kRpm);
  EXPECT_EQ(m.rows[0].line, 4u);
  EXPECT_EQ(read("file\tradius\nr15-1.csv\t15mm").rows.size(), 1u);
}

TEST_F(ManifestTest, BadInputIsNamedWithPlaceAndAdvice) {
  refuses("radius,speed\n15mm,4rpm\n", 1, "", "no column 'file'", "file, radius, speed, load, repeat");
  refuses("flie,radius\nr15-1.csv,15mm\n", 1, "", "is it 'flie'?", "'file'");
  refuses("file,radius\nr15-4.csv,15mm\n", 2, "file", "'r15-4.csv' does not exist (did you mean r15-1.csv?)",
          "folder of the manifest");
  refuses("file,radius\n\nx*.csv,15mm\n", 3, "file", "no file fits 'x*.csv'", "folder");
  refuses("file,radius\nr15-1.csv,15mm\nr15-1.csv,15mm\n", 3, "file", "listed twice, in line 2", "remove");
  refuses("file,radius\nr15*.csv,15mm\nr15-2.csv,12mm\n", 3, "file", "other conditions here than in line 2", "keep");
  refuses("file,radius\nr15-1.csv,15mn\n", 2, "radius", "unknown unit 'mn'", "mm");
  refuses("file,radius\nr15-1.csv,15\n", 2, "radius", "has no unit", "radius [mm]");
  refuses("file,radius\nr15-1.csv,15N\n", 2, "radius", "is a force, not a length", "15mm");
  refuses("file,radius\nr15-1.csv,-15mm\n", 2, "radius", "not greater than zero", "15mm");
  refuses("file,radius [mn]\nr15-1.csv,15\n", 1, "radius [mn]", "unknown unit 'mn'", "did you mean m");
  refuses("file,speed [mm]\nr15-1.csv,15\n", 1, "speed [mm]", "a unit of a length", "rpm");
  refuses("file,radius,repeat\nr15-1.csv,15mm,first\n", 2, "repeat", "not a whole number", "1, 2, 3");
  refuses("file,radius,repeat\nr15-*.csv,15mm,1\n", 2, "repeat", "fits several files", "one by one");
  refuses("file,radius,radius\nr15-1.csv,15mm,15mm\n", 1, "radius", "second column", "keep one");
  refuses("file,radius\nr15-1.csv,15,5mm\n", 2, "", "3 cells where the header has 2", "decimal point");
  refuses("file,radius\n,15mm\n", 2, "file", "names no file", "fill in");
  refuses("file,radius\n", 0, "", "lists no runs", "add a row");
  refuses("", 0, "", "is empty", "file,radius");
  refuses("# nothing\n", 0, "", "no header", "file,radius");
}

TEST_F(ManifestTest, DefectsOfRowsAreCollectedWhereAsked) {
  write(
      "file,radius\nr15-1.csv,15mm\nmissing.csv,15mm\nr15-2.csv,15mn\nr15-1.csv,15mm\nr9-1.csv,9mm\nr9-1.csv,8mm\n"
      "x*.csv,9mm\n,9mm\nr15-3.csv,15mm\n",
      manifest_name);
  const Manifest m = read_manifest(folder_.path(), ManifestErrors::collect);
  using ::testing::HasSubstr;
  ASSERT_EQ(m.rows.size(), 5u);
  EXPECT_EQ(m.rows[0].problem, "");
  EXPECT_THAT(m.rows[1].problem, HasSubstr("manifest.csv:3: column file: 'missing.csv' does not exist"));
  EXPECT_THAT(m.rows[2].problem, HasSubstr("manifest.csv:4: column radius: unknown unit 'mn'"));
  EXPECT_THAT(m.rows[3].problem, HasSubstr("manifest.csv:7: column file: 'r9-1.csv' has other conditions"));
  EXPECT_EQ(m.rows[4].problem, "");
  ASSERT_EQ(m.problems.size(), 3u);
  EXPECT_THAT(m.problems[0], HasSubstr(":5: column file: 'r15-1.csv' is listed twice, in line 2"));
  EXPECT_THAT(m.problems[1], HasSubstr(":8: column file: no file fits 'x*.csv'"));
  EXPECT_THAT(m.problems[2], HasSubstr(":9: column file: the row names no file"));
}

}  // namespace
}  // namespace tribofit
