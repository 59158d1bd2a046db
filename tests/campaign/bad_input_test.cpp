#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "runs.hpp"

namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Status and message of a run in a summary.
struct Row {
  std::string status, message;
};

class BadCampaign : public ::testing::Test {
 protected:
  BadCampaign() { make_runs(shop_, 4); }
  Row row(const std::string& name) const {
    const auto summary = json_in(shop_ / "runs-results/summary.json");
    for (const auto& run : summary["runs"]) {
      if (run["name"] == name) return {run["status"], run["message"].is_null() ? "" : run["message"]};
    }
    return {};
  }
  void add_rows(const std::string& rows) const {
    shop_.write("runs/manifest.csv", contents(shop_ / "runs/manifest.csv") + rows);
  }
  Workshop shop_;
};

TEST_F(BadCampaign, ABrokenTraceIsNamedAndTheOthersGoOn) {
  shop_.write("runs/a2.csv", "time_s,mu,v_b [mm/s]\n0,0.3,0.1\n0.001,oops,0.1\n");
  shop_.write("runs/a3.csv", short_trace(3).substr(0, 300));
  const Outcome outcome = shop_.identify("runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("2 fitted, 0 already there, 2 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("a2.csv:3"));
  EXPECT_THAT(outcome.err, HasSubstr("a3.csv"));
  EXPECT_EQ(row("a2").status, "unreadable");
  EXPECT_THAT(row("a2").message, HasSubstr("a2.csv:3"));
  EXPECT_EQ(row("a3").status, "failed");
  EXPECT_EQ(row("a4").status, "ok");
  const Outcome second = shop_.identify("runs");
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.out, HasSubstr("0 fitted, 2 already there, 2 failed"));
  EXPECT_THAT(second.err, HasSubstr("a3.csv"));
  shop_.write("runs/a2.csv", short_trace(2));
  shop_.write("runs/a3.csv", short_trace(3));
  EXPECT_EQ(shop_.identify("runs --quiet").status, 0);
  ASSERT_EQ(shop_.identify("runs --out fresh --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "runs-results"), files_in(shop_ / "fresh"));
}

TEST_F(BadCampaign, FilesThatDoNotExistAreNamedAndTheRestDone) {
  add_rows("a9.csv,15mm,50N,1,L\nb*.csv,15mm,50N,1,L\n");
  std::filesystem::remove(shop_ / "runs/a1.csv");
  const Outcome outcome = shop_.identify("runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("3 fitted, 0 already there, 2 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("manifest.csv:6: column file: 'a9.csv' does not exist"));
  EXPECT_THAT(outcome.err, HasSubstr("manifest.csv:2: column file: 'a1.csv' does not exist"));
  EXPECT_THAT(outcome.err, HasSubstr("no file fits 'b*.csv'"));
  EXPECT_EQ(row("a9").status, "unreadable");
  EXPECT_EQ(json_in(shop_ / "runs-results/summary.json")["problems"].size(), 1u);
}

TEST_F(BadCampaign, DuplicateRowsAreNamedAndDoneOnce) {
  add_rows("a1.csv,15.1mm,50N,1,L\n");
  const Outcome outcome = shop_.identify("runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("4 fitted, 0 already there, 0 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("manifest.csv:6: column file: 'a1.csv' is listed twice, in line 2 and here"));
}

TEST_F(BadCampaign, ConflictingConditionsAreNamedAndNotFitted) {
  add_rows("a1.csv,9mm,50N,1,L\n");
  const Outcome outcome = shop_.identify("runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("3 fitted, 0 already there, 1 failed"));
  EXPECT_EQ(row("a1").status, "unreadable");
  EXPECT_THAT(row("a1").message, HasSubstr("manifest.csv:6: column file: 'a1.csv' has other conditions here than in"));
}

TEST_F(BadCampaign, ACellThatCannotBeUsedCostsItsRowOnly) {
  add_rows("a5.csv,15mn,50N,1,L\n,15mm,50N,1,L\n");
  shop_.write("runs/a5.csv", short_trace(5));
  const Outcome outcome = shop_.identify("runs");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("4 fitted, 0 already there, 1 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("unknown unit 'mn'"));
  EXPECT_THAT(outcome.err, HasSubstr("names no file"));
}

TEST_F(BadCampaign, NothingReadableIsStatusThree) {
  for (const char* name : {"a1", "a2", "a3", "a4"}) shop_.write(std::string("runs/") + name + ".csv", "a,b\n1,2\n");
  EXPECT_EQ(shop_.identify("runs").status, 3);
}

TEST_F(BadCampaign, AFolderThatCannotBeWrittenIsNamed) {
  shop_.write("file", "x");
  Outcome outcome = shop_.identify("runs --out file/res");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("file/res"));
  if (::geteuid() == 0) return;  // root may write everywhere
  std::filesystem::create_directory(shop_ / "locked");
  std::filesystem::permissions(shop_ / "locked", std::filesystem::perms::owner_read);
  outcome = shop_.identify("runs --out locked/res");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("locked"));
}

TEST_F(BadCampaign, TracesThatMayOnlyBeReadAreEnough) {
  const auto before = files_in(shop_ / "runs");
  std::filesystem::permissions(shop_ / "runs", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_EQ(shop_.identify("runs --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "runs"), before);
  std::filesystem::permissions(shop_ / "runs", std::filesystem::perms::owner_all);
}

TEST_F(BadCampaign, AResultThatCannotBeWrittenIsNamedAndTheRestDone) {
  std::filesystem::create_directories(shop_ / "runs-results");
  ASSERT_EQ(shop_.identify("runs --quiet").status, 0);
  std::filesystem::remove(shop_ / "runs-results/a2.json");
  std::filesystem::create_directory(shop_ / "runs-results/a2.json");
  const Outcome outcome = shop_.identify("runs --again");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("3 fitted, 0 already there, 1 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("a2.json"));
  EXPECT_EQ(row("a2").status, "missing");
}

/// Files may grow to a few kilobytes only: what a disc that fills up does in the middle of a result.
TEST_F(BadCampaign, AFullDiscLosesNothingThatWasThere) {
  ASSERT_EQ(shop_.identify("runs --quiet").status, 0);
  const auto whole = files_in(shop_ / "runs-results");
  std::filesystem::remove(shop_ / "runs-results/a1.json");
  const Outcome outcome = shop_.shell("ulimit -f 8; identify runs --again");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("a1."));
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written"));
  auto left = files_in(shop_ / "runs-results");
  for (const char* name : {"a2.json", "a3.json", "a4.json"}) EXPECT_EQ(left[name], whole.at(name)) << name;
  EXPECT_EQ(shop_.identify("runs --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "runs-results"), whole);
}

TEST_F(BadCampaign, ATraceThatIsDeletedOnTheWayIsNamedAndTheRestDone) {
  std::filesystem::remove(shop_ / "runs/manifest.csv");
  // campaign.json is there before the first run is read, and the last one in order is read last.
  const Outcome outcome = shop_.shell(
      "for k in 5 6 7 8 9; do cp runs/a1.csv runs/b$k.csv; done\n"
      "( while [ ! -e runs-results/campaign.json ]; do :; done; rm -f runs/b9.csv ) &\n"
      "identify --radius 15mm --threads 1 --starts 200 runs; status=$?; wait; exit $status");
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("b9.csv: cannot be opened"));
  EXPECT_THAT(outcome.out, HasSubstr("8 fitted, 0 already there, 1 failed"));
}

}  // namespace
