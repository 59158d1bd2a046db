#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "runs.hpp"

namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Cells of a line of CSV without quotes.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line + ",");
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

class Batch : public ::testing::Test {
 protected:
  Batch() { make_runs(shop_, 5); }
  Workshop shop_;
};

TEST_F(Batch, WritesAFileARunAndASummaryInTheOrderOfTheManifest) {
  const Outcome outcome = shop_.identify("runs/");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("5 fitted, 0 already there, 0 failed; results in runs-results/"));
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto files = files_in(shop_ / "runs-results");
  EXPECT_EQ(files.size(), 28u);  // five runs with what they keep of their samples twice, campaign.json, the summary
                                 // twice, three of repeats, seven figures
  const auto lines = lines_of(files.at("summary.csv"));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0].find("run,file,status,message,radius_mm,speed_rpm,load_N,repeat,lot,"), 0u);
  EXPECT_EQ(lines[1].find("a1,a1.csv,ok,,15.1,"), 0u);
  EXPECT_EQ(lines[5].find("a5,a5.csv,ok,,15.1,"), 0u);
  const auto summary = json_in(shop_ / "runs-results/summary.json");
  EXPECT_EQ(summary["runs"].size(), 5u);
  EXPECT_EQ(summary["runs"][1]["conditions"]["radius_mm"], 15.0);
  EXPECT_EQ(json_in(shop_ / "runs-results/a1.json")["trace"]["path"], "a1.csv");
}

TEST_F(Batch, AColumnOfTheManifestCalledLikeOneOfOursHidesNone) {
  shop_.write("runs/manifest.csv", "file,radius,load,repeat,status,cycles\na1.csv,15mm,50N,0,mine,many\n");
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const auto lines = lines_of(contents(shop_ / "res/summary.csv"));
  ASSERT_GE(lines.size(), 2u);
  const auto header = cells_of(lines[0]), cells = cells_of(lines[1]);
  const auto cell = [&](const char* name) {
    const auto found = std::find(header.begin(), header.end(), name);
    return found == header.end() ? "none" : cells.at(static_cast<std::size_t>(found - header.begin()));
  };
  EXPECT_EQ(cell("status"), "ok");
  EXPECT_EQ(cell("condition status"), "mine");
  EXPECT_EQ(cell("condition cycles"), "many");
  EXPECT_GT(std::atoi(cell("cycles").c_str()), 3);
}

/// Two files of one size and one time of modification take turns under one name: the key of a result is that of the
/// bytes it comes from.
TEST_F(Batch, AFileThatChangesWhileItIsReadIsDoneAgainOrNamed) {
  namespace fs = std::filesystem;
  std::array<std::string, 2> texts = {short_trace(1), short_trace(2)};
  const std::size_t size = std::max(texts[0].size(), texts[1].size());
  fs::create_directory(shop_ / "one");
  const fs::path path = shop_ / "one/a.csv", beside = shop_ / "beside";
  const auto put = [&](std::size_t k) {
    std::ofstream(beside, std::ios::binary) << texts[k];
    fs::last_write_time(beside, fs::file_time_type{});
    fs::rename(beside, path);
  };
  const auto key_and_values = [&](const std::string& folder) {
    // By its name: a folder in which files are renamed may be listed without them.
    const Outcome outcome = shop_.identify("one/a.csv --radius 15mm --quiet --out " + folder);
    const fs::path kept = shop_ / (folder + "/a.json");
    if (!fs::exists(kept)) {
      ADD_FAILURE() << outcome.err;
      return std::pair<std::string, std::string>{};
    }
    const auto result = json_in(kept);
    const auto checksum =
        result.value(nlohmann::json::json_pointer("/trace/checksum"), nlohmann::json());  // null: it changed each time
    return std::pair{result["run"]["key"].get<std::string>(), checksum.is_string() ? checksum.get<std::string>() : ""};
  };
  std::map<std::string, std::string> values;
  for (const std::size_t k : {0u, 1u}) {
    texts[k].resize(size, '\n');
    put(k);
    values.insert(key_and_values("still" + std::to_string(k)));
  }
  ASSERT_EQ(values.size(), 2u);
  std::atomic<bool> stops = false;
  std::thread changes([&] {
    for (std::size_t k = 0; !stops; ++k) {
      put(k % 2);
      std::this_thread::sleep_for(std::chrono::microseconds(700));
    }
  });
  for (int k = 0; k < 12; ++k) {
    const auto [key, read] = key_and_values("moving" + std::to_string(k));
    if (!read.empty()) {
      EXPECT_EQ(read, values[key]);
    }
  }
  stops = true;
  changes.join();
  EXPECT_EQ(values.count(key_and_values("moving0").first), 1u);
}

TEST_F(Batch, EveryNumberOfThreadsGivesTheSameBytes) {
  ASSERT_EQ(shop_.identify("runs --out one --threads 1 --quiet").status, 0);
  ASSERT_EQ(shop_.identify("runs --out four --threads 4 --quiet").status, 0);
  ASSERT_EQ(shop_.identify((shop_ / "runs").string() + " --out absolute --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "one"), files_in(shop_ / "four"));
  EXPECT_EQ(files_in(shop_ / "one"), files_in(shop_ / "absolute"));
}

TEST_F(Batch, ASecondRunDoesWhatIsNewOrChanged) {
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const auto first = files_in(shop_ / "res");
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("0 fitted, 5 already there, 0 failed"));
  EXPECT_EQ(files_in(shop_ / "res"), first);
  EXPECT_THAT(shop_.identify("runs --out res --again").out, HasSubstr("5 fitted, 0 already there"));
  EXPECT_EQ(files_in(shop_ / "res"), first);

  shop_.write("runs/a2.csv", short_trace(12));
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("1 fitted, 4 already there"));
  shop_.write("runs/a2.csv", short_trace(2));
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("1 fitted, 4 already there"));
  EXPECT_EQ(files_in(shop_ / "res"), first);

  std::string manifest = contents(shop_ / "runs/manifest.csv");
  shop_.write("runs/manifest.csv", manifest.replace(manifest.find("50N"), 3, "60N"));
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("1 fitted, 4 already there"));
  EXPECT_THAT(shop_.identify("runs --out res --law exponential").out, HasSubstr("5 fitted, 0 already there"));
  shop_.write("lab.json", R"({"vibrometer": {"gain": [1.0, 0.01]}})");
  EXPECT_THAT(shop_.identify("runs --out res --instruments lab.json").out, HasSubstr("5 fitted"));
  EXPECT_THAT(shop_.identify("runs --out res --instruments lab.json").out, HasSubstr("0 fitted, 5 already"));
  shop_.write("lab.json", R"({"vibrometer": {"gain": [1.0, 0.02]}})");
  EXPECT_THAT(shop_.identify("runs --out res --instruments lab.json").out, HasSubstr("5 fitted"));
}

TEST_F(Batch, ARunThatIsAddedOrGoneChangesNoOther) {
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const std::string manifest = contents(shop_ / "runs/manifest.csv");
  shop_.write("runs/a0.csv", short_trace(10));
  std::string more = manifest;
  shop_.write("runs/manifest.csv", more.insert(manifest.find('\n') + 1, "a0.csv,15mm,50N,9,L\n"));
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("1 fitted, 5 already there"));
  EXPECT_EQ(json_in(shop_ / "res/summary.json")["runs"][0]["name"], "a0");
  ASSERT_EQ(shop_.identify("runs --out fresh --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "fresh"));
  shop_.write("runs/manifest.csv", manifest);
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("0 fitted, 5 already there"));
  EXPECT_EQ(json_in(shop_ / "res/summary.json")["runs"].size(), 5u);
}

TEST_F(Batch, ADamagedResultIsDoneAgain) {
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const auto first = files_in(shop_ / "res");
  const std::string& whole = first.at("a3.json");
  std::string changed = whole;
  const std::size_t digit = changed.find("\"value\": ") + 11;
  changed[digit] = changed[digit] == '1' ? '2' : '1';
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), changed, std::string(), std::string("{}")}) {
    shop_.write("res/a3.json", damaged);
    EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("1 fitted, 4 already there"));
    EXPECT_EQ(files_in(shop_ / "res"), first);
  }
  shop_.write("res/campaign.json", "{");
  EXPECT_THAT(shop_.identify("runs --out res").out, HasSubstr("0 fitted, 5 already there"));
  EXPECT_EQ(files_in(shop_ / "res"), first);
}

TEST_F(Batch, FilesNamedOneByOneAreABatchWithOut) {
  std::filesystem::create_directory(shop_ / "other");
  shop_.write("other/a1.csv", short_trace(7));
  ASSERT_EQ(shop_.identify("--radius 15mm runs/a1.csv other/a1.csv runs/a2.csv --out res --quiet").status, 0);
  EXPECT_TRUE(std::filesystem::exists(shop_ / "res/runs-a1.csv.json"));
  EXPECT_TRUE(std::filesystem::exists(shop_ / "res/other-a1.csv.json"));
  EXPECT_TRUE(std::filesystem::exists(shop_ / "res/a2.json"));
  EXPECT_THAT(shop_.identify("--radius 15mm runs/a1.csv runs/a2.csv").out, HasSubstr("Stick-slip"));  // shown
}

TEST_F(Batch, NamesOfFilesMayHoldAnything) {
  std::filesystem::create_directory(shop_ / "odd");
  for (const char* name : {"Versuch \xe4.csv", "Versuch \xf6.csv", "\xc3\xa4.csv", "summary.csv", "campaign.csv",
                           "a,\"b\".csv", "two\nlines.csv", "x.y.csv", "x.y.tsv"}) {
    shop_.write(std::string("odd/") + name, short_trace(1));
  }
  const Outcome outcome = shop_.identify("--radius 15mm odd --out res");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("9 fitted"));
  EXPECT_THAT(shop_.identify("--radius 15mm odd --out res").out, HasSubstr("0 fitted, 9 already there"));
  const auto summary = json_in(shop_ / "res/summary.json");
  for (const auto& run : summary["runs"]) EXPECT_EQ(run["status"], "ok") << run["name"];
  EXPECT_EQ(lines_of(contents(shop_ / "res/summary.csv")).size(), 10u);
}

TEST_F(Batch, TwoBatchesAtOnceDoNotHarmEachOther) {
  ASSERT_EQ(shop_.identify("runs --out alone --quiet").status, 0);
  const Outcome outcome = shop_.shell(
      "identify runs --out res --quiet & first=$!; identify runs --out res --quiet & second=$!\n"
      "wait $first && wait $second");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(files_in(shop_ / "res"), files_in(shop_ / "alone"));
}

TEST_F(Batch, LeftoversOfAKilledBatchAreSwept) {
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const auto first = files_in(shop_ / "res");
  shop_.write("res/.a1.json.99999-1.part", "half");
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  EXPECT_EQ(files_in(shop_ / "res"), first);
}

TEST_F(Batch, ResultsOfOtherTracesAndForeignFilesAreNotOverwritten) {
  std::filesystem::create_directory(shop_ / "others");
  for (const char* name : {"others/a1.csv", "others/a2.csv"}) shop_.write(name, short_trace(8));
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  const auto first = files_in(shop_ / "res");
  const Outcome outcome = shop_.identify("--radius 15mm others --out res");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("holds the results of " + (shop_ / "runs").string()));
  EXPECT_EQ(files_in(shop_ / "res"), first);
  std::filesystem::create_directory(shop_ / "mine");
  shop_.write("mine/a1.json", "precious");
  EXPECT_EQ(shop_.identify("--radius 15mm others --out mine").status, 1);
  EXPECT_EQ(contents(shop_ / "mine/a1.json"), "precious");
  EXPECT_EQ(shop_.identify("--radius 15mm others --out others").status, 2);
  shop_.write("mine/summary.csv", short_trace(1));
  EXPECT_EQ(shop_.identify("--radius 15mm mine/summary.csv --out mine").status, 2);
}

/// Whatever the batch calls its own files: runs that are called so have other files.
TEST_F(Batch, RunsMayBeCalledLikeItsOwnFiles) {
  ASSERT_EQ(shop_.identify("runs --out res --share alpha --quiet").status, 0);
  std::filesystem::create_directory(shop_ / "own");
  std::size_t runs = 0;
  for (const auto& [name, text] : files_in(shop_ / "res")) {
    if (name.find('/') != std::string::npos || name[0] == 'a') continue;
    const std::string run = "own/" + name.substr(0, name.rfind('.')) + ".csv";
    if (!std::filesystem::exists(shop_ / run)) shop_.write(run, short_trace(static_cast<int>(++runs)));
  }
  ASSERT_GE(runs, 5u);  // campaign, summary, pooled, trends, shared
  for (const char* found : {"0 already there", "0 fitted"}) {
    const Outcome outcome = shop_.identify("--radius 15mm own --out own-res --share alpha");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(found));
  }
}

TEST_F(Batch, GoesOnWhereItWasMovedTo) {
  ASSERT_EQ(shop_.identify("runs --out res --quiet").status, 0);
  EXPECT_EQ(contents(shop_ / "res/campaign.json").find(shop_.path()), std::string::npos);
  EXPECT_THAT(shop_.shell("mkdir moved; mv runs res moved; cd moved; identify runs --out res").out,
              HasSubstr("0 fitted, 5 already there"));
  EXPECT_THAT(shop_.shell("mkdir -p there; mv moved/runs there/traces; identify there/traces --out moved/res").out,
              HasSubstr("0 fitted, 5 already there"));
  EXPECT_THAT(shop_.shell("rm moved/res/a3.json; identify merge moved/res").out,
              HasSubstr("identify there/traces/ --out moved/res/"));
}

TEST_F(Batch, WhatIsAskedBeyondTheSummaryDoesNotTakeItAway) {
  shop_.write("earlier.csv", "radius_mm,mu_s\n15,1e400\n");
  const Outcome share = shop_.identify("runs --out a --share alhpa --quiet");
  EXPECT_EQ(share.status, 2);
  EXPECT_THAT(share.err, HasSubstr("did you mean alpha?"));
  const Outcome compare = shop_.identify("runs --out b --compare earlier.csv --quiet");
  EXPECT_EQ(compare.status, 3);
  EXPECT_THAT(compare.err, HasSubstr("earlier.csv:2: column mu_s: '1e400' is too large for a number"));
  for (const char* folder : {"a", "b"}) {
    EXPECT_EQ(json_in(shop_ / folder / "summary.json")["runs"].size(), 5u);
    EXPECT_FALSE(contents(shop_ / folder / "pooled.csv").empty());
  }
  EXPECT_EQ(shop_.identify("runs --share alpha --vary alpha:radius").status, 2);
  EXPECT_EQ(shop_.identify("runs --shard 1/2 --share alpha").status, 2);
}

TEST_F(Batch, WhatGoesWithOneTraceOnlyIsWrongUsage) {
  for (const char* option : {"--json r.json", "--csv out", "--with b.csv", "--continue b.csv", "--shard 0/2",
                             "--shard 3/2", "--shard 1", "--shard 1/2x", "--out ''"}) {
    EXPECT_EQ(shop_.identify(std::string("runs ") + option).status, 2) << option;
  }
  EXPECT_EQ(shop_.identify("--radius 15mm --again runs/a1.csv").status, 2);
}

}  // namespace
