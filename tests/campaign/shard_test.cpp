#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "runs.hpp"

namespace {

using ::testing::HasSubstr;

class Shards : public ::testing::Test {
 protected:
  Shards() { make_runs(shop_, 7); }
  Workshop shop_;
};

TEST_F(Shards, MergedTheyAreTheBatch) {
  shop_.write("runs/a3.csv", "time_s,mu\n");  // one that fails
  std::string more = contents(shop_ / "runs/manifest.csv");
  shop_.write("runs/manifest.csv", more + "missing.csv,15mm,50N,1,L\nnone*.csv,15mm,50N,1,L\n");
  EXPECT_EQ(shop_.identify("runs --out local --quiet").status, 1);
  for (const char* shard : {"3/3", "1/3", "2/3", "1/3"}) {  // in any order; one of them twice
    const Outcome outcome = shop_.identify(std::string("runs/ --out res --shard ") + shard);
    EXPECT_FALSE(std::filesystem::exists(shop_ / "res/summary.csv"));
    EXPECT_THAT(outcome.out, HasSubstr("identify merge res/"));
  }
  const Outcome merged = shop_.identify("merge res");
  EXPECT_EQ(merged.status, 1);
  EXPECT_THAT(merged.out, HasSubstr("6 fitted, 2 failed, 0 missing"));
  EXPECT_THAT(merged.err, HasSubstr("a3.csv"));
  EXPECT_THAT(merged.err, HasSubstr("missing.csv"));
  EXPECT_THAT(merged.err, HasSubstr("no file fits 'none*.csv'"));
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "local"));
}

TEST_F(Shards, EachDoesItsOwnRunsOnly) {
  EXPECT_THAT(shop_.identify("runs --out res --shard 2/3").out, HasSubstr("2 fitted, 0 already there, 0 failed"));
  EXPECT_TRUE(std::filesystem::exists(shop_ / "res/a2.json"));
  EXPECT_TRUE(std::filesystem::exists(shop_ / "res/a5.json"));
  EXPECT_FALSE(std::filesystem::exists(shop_ / "res/a1.json"));
  EXPECT_EQ(shop_.identify("runs --out res --shard 9/9").status, 0);  // more shards than runs
}

TEST_F(Shards, TheMergeSaysWhatIsMissing) {
  ASSERT_EQ(shop_.identify("runs --out local --quiet").status, 0);
  ASSERT_EQ(shop_.identify("runs --out res --shard 1/2 --quiet").status, 0);
  const Outcome merged = shop_.identify("merge res/");
  EXPECT_EQ(merged.status, 1);
  EXPECT_THAT(merged.out, HasSubstr("4 fitted, 0 failed, 3 missing"));
  EXPECT_THAT(merged.err, HasSubstr("a2.csv: there is no result of it yet"));
  const auto summary = json_in(shop_ / "res/summary.json");
  EXPECT_EQ(summary["runs"].size(), 7u);
  EXPECT_EQ(summary["runs"][1]["status"], "missing");
  EXPECT_EQ(lines_of(contents(shop_ / "res/summary.csv")).size(), 8u);
  EXPECT_THAT(shop_.shell("identify " + merged.out.substr(merged.out.rfind("identify ") + 9)).out,
              HasSubstr("3 fitted, 4 already there"));  // the command it names
  EXPECT_EQ(shop_.identify("merge res --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "local"));
}

TEST_F(Shards, OfOtherOptionsAreRefused) {
  ASSERT_EQ(shop_.identify("runs --out res --shard 1/2 --law exponential --quiet").status, 0);
  const Outcome other = shop_.identify("runs --out res --shard 2/2 --quiet");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.err, HasSubstr("campaign.json: another shard planned a1.csv with other options"));
  EXPECT_THAT(shop_.identify("merge res").out, HasSubstr("4 fitted, 0 failed, 3 missing"));
}

/// A run that comes, or goes, between two shards moves none of the others from one to the other.
TEST_F(Shards, WorkToThePlanOfTheFirst) {
  ASSERT_EQ(shop_.identify("runs --out local --quiet").status, 0);
  ASSERT_EQ(shop_.identify("runs --out res --shard 1/2 --quiet").status, 0);
  const std::string manifest = contents(shop_ / "runs/manifest.csv");
  const std::size_t first = manifest.find('\n') + 1;
  shop_.write("runs/new.csv", contents(shop_ / "runs/a1.csv"));
  shop_.write("runs/manifest.csv", manifest.substr(0, first) + "new.csv,15mm,50N,1,L\n" + manifest.substr(first));
  const Outcome second = shop_.identify("runs --out res --shard 2/2");
  EXPECT_EQ(second.status, 0);
  EXPECT_THAT(second.out, HasSubstr("1 run is left out, new.csv the first"));
  EXPECT_EQ(shop_.identify("merge res --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "local"));
  for (const char* shard : {"1/2", "2/2"})  // all that was planned is done: it is planned anew
    EXPECT_EQ(shop_.identify(std::string("runs --out res --quiet --shard ") + shard).status, 0);
  EXPECT_THAT(shop_.identify("merge res").out, HasSubstr("8 fitted, 0 failed, 0 missing"));
}

/// Who removes a folder while a batch writes into it may leave results without the list of runs.
TEST_F(Shards, ResultsThatLostTheirPlanAreTakenUp) {
  ASSERT_EQ(shop_.identify("runs --out local --quiet").status, 0);
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  std::filesystem::remove(shop_ / "res/campaign.json");
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("0 fitted, 7 already there"));
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "local"));
  std::filesystem::remove(shop_ / "res/campaign.json");
  shop_.write("res/a3.json", "{\"mine\": 1}\n");
  const Outcome other = shop_.identify("runs --out res");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.err, HasSubstr("a3.json: exists and is not a result of a campaign"));
  EXPECT_EQ(contents(shop_ / "res/a3.json"), "{\"mine\": 1}\n");
}

TEST_F(Shards, AFolderWithoutACampaignIsNamed) {
  const Outcome outcome = shop_.identify("merge runs");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("holds no results of a campaign"));
}

/// Two hundred runs, a batch that is killed twenty times at random moments: what it wrote stays, what it was writing is
/// done again, and the end is that of a batch that nobody killed.
TEST(KilledBatch, EndsAsIfNothingHadHappened) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  constexpr int kRuns = 200;
  for (int k = 0; k < kRuns; ++k) shop.write("runs/r" + std::to_string(1000 + k) + ".csv", short_trace(1 + k % 10));
  ASSERT_EQ(shop.identify("--radius 15mm runs --out whole --quiet").status, 0);
  const auto whole = files_in(shop / "whole");

  std::mt19937 random(4);
  std::uniform_real_distribution<double> delay(0.02, 0.4);
  std::size_t results = 0;
  for (int k = 0; k < 20; ++k) {
    // The program itself is the background job, not a shell around it.
    shop.shell("'" TRIBOFIT_IDENTIFY "' --radius 15mm runs --out res --quiet & sleep " + std::to_string(delay(random)) +
               "; kill -9 $! 2>/dev/null; wait");
    if (!std::filesystem::exists(shop / "res")) continue;  // killed before it began
    std::size_t now = 0;
    for (const auto& [name, bytes] : files_in(shop / "res")) {
      if (name.starts_with("r1")) ++now;
      if (name.starts_with(".") || name.find("/.") != std::string::npos) continue;  // unfinished
      EXPECT_EQ(bytes, whole.at(name)) << name;                                     // never half a file
    }
    EXPECT_GE(now, results);  // nothing lost
    results = now;
  }
  EXPECT_GT(results, 0u);
  const Outcome last = shop.identify("--radius 15mm runs --out res");
  EXPECT_EQ(last.status, 0);
  EXPECT_THAT(last.out, HasSubstr(std::to_string(results) + " already there"));  // nothing twice
  EXPECT_EQ(files_in(shop / "res"), whole);
}

}  // namespace
