#include "tribofit/output/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../folder.hpp"

namespace tribofit {
namespace {

/// Files may not grow beyond this while it lives: a disc that fills up (write() fails in the middle).
class SmallDisc {
 public:
  explicit SmallDisc(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    previous_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisc() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, previous_);
  }
  SmallDisc(const SmallDisc&) = delete;
  SmallDisc& operator=(const SmallDisc&) = delete;

 private:
  rlimit before_{};
  void (*previous_)(int) = SIG_DFL;
};

TEST(WholeFile, AppearsOnlyWhenCommitted) {
  const Folder folder;
  const std::string path = folder.path("a.json");
  {
    WholeFile file(path);
    file.write("half");
    file.finish();
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(contents(path), "half");
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("a.json"));
}

TEST(WholeFile, LeavesNothingBehindWhenAbandoned) {
  const Folder folder;
  { WholeFile(folder.path("a.json")).write("half"); }
  EXPECT_TRUE(folder.names().empty());
}

TEST(WholeFile, ADiscThatFillsUpKeepsTheOldFile) {
  const Folder folder;
  const std::string path = folder.path("a.json");
  write_whole(path, "old");
  {
    const SmallDisc disc(64 * 1024);
    EXPECT_THROW(write_whole(path, std::string(1 << 20, 'x')), WriteError);
  }
  EXPECT_EQ(contents(path), "old");
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("a.json"));
}

TEST(WholeFile, AFullDeviceIsNamedWithWhatToDo) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  try {
    write_whole("/dev/full", "x");
    FAIL() << "nothing was thrown";
  } catch (const WriteError& error) {
    EXPECT_THAT(error.what(), ::testing::MatchesRegex("/dev/full: .*No space left.*; .+"));
  }
}

TEST(WholeFile, SaysWhatIsWrongWithThePlace) {
  const Folder folder;
  EXPECT_THROW(write_whole(folder.path("missing/a.json"), "x"), WriteError);
  EXPECT_THROW(write_whole(folder.path(""), "x"), WriteError);  // a folder
  EXPECT_THROW(write_whole("", "x"), WriteError);
}

TEST(WholeFile, KeepsLinksAndRights) {
  const Folder folder;
  const std::string real = folder.path("real.json"), link = folder.path("link.json");
  write_whole(real, "old");
  std::filesystem::permissions(real, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink(real, link);
  write_whole(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(contents(real), "new");
  struct stat status {};
  ASSERT_EQ(::stat(real.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(WholeFile, OnlyAbandonedFilesAreSwept) {
  const Folder folder;
  std::ofstream(folder.path(".b.json.1-2.part")) << "half";  // its writer was killed
  std::ofstream(folder.path(".mine")) << "x";
  std::ofstream(folder.path("c.part")) << "x";
  WholeFile file(folder.path("a.json"));
  file.write("whole");
  file.finish();
  remove_abandoned_files(folder.path(""));
  EXPECT_EQ(folder.names().size(), 3u);  // .mine, c.part and what is being written
  file.commit();
  EXPECT_EQ(contents(folder.path("a.json")), "whole");
  EXPECT_THAT(folder.names(), ::testing::UnorderedElementsAre(".mine", "a.json", "c.part"));
}

TEST(WholeFile, FilesOfAnotherHostAreLeftToIt) {
  const Folder folder;
  std::ofstream(folder.path(".b.json.node-17.lab-1-2.part")) << "half";  // its lock is not seen here
  std::string own;
  {
    WholeFile file(folder.path("a.json"));
    for (const std::string& name : folder.names()) {
      if (name.starts_with(".a.json.")) own = name;
    }
  }
  ASSERT_FALSE(own.empty());
  std::ofstream(folder.path(own)) << "half";  // as if this process had been killed
  remove_abandoned_files(folder.path(""));
  EXPECT_THAT(folder.names(), ::testing::ElementsAre(".b.json.node-17.lab-1-2.part"));
}

TEST(WholeFile, AnInterruptionRemovesWhatIsUnfinishedAndNothingElse) {
  const Folder folder;
  std::vector<std::unique_ptr<WholeFile>> files;
  for (int k = 0; k < 40; ++k) files.push_back(std::make_unique<WholeFile>(folder.path(std::to_string(k))));
  for (int k = 0; k < 20; ++k) files[static_cast<std::size_t>(k)]->commit();
  remove_unfinished_files();
  EXPECT_EQ(folder.names().size(), 20u);
  files.clear();
  WholeFile again(folder.path("again"));
  remove_unfinished_files();
  EXPECT_EQ(folder.names().size(), 20u);
}

/// Threads that do nothing but begin and end files, until a signal comes.
[[noreturn]] void write_until_a_signal(const std::string& folder) {
  std::signal(SIGTERM, [](int number) {
    end_writing();
    std::signal(number, SIG_DFL);
    std::raise(number);
  });
  std::vector<std::thread> writers;
  for (int w = 0; w < 3; ++w) {
    writers.emplace_back([&folder, w] {
      for (int k = 0;; ++k) write_whole(folder + std::to_string(w) + "-" + std::to_string(k % 5), "whole");
    });
  }
  for (;;) ::pause();
}

TEST(WholeFile, ASignalLeavesNothingWhateverThreadsWrite) {
  const Folder folder;
  for (int k = 0; k < 60; ++k) {
    const pid_t child = ::fork();
    if (child == 0) write_until_a_signal(folder.path(""));
    std::this_thread::sleep_for(std::chrono::microseconds(3000 + 217 * k));
    ::kill(child, SIGTERM);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
  }
  for (const std::string& name : folder.names()) EXPECT_FALSE(name.ends_with(".part")) << name;
}

TEST(WholeFile, TwoWritersOfOneNameDoNotMix) {
  const Folder folder;
  WholeFile first(folder.path("a.json")), second(folder.path("a.json"));
  first.write("first");
  second.write("second");
  first.commit();
  EXPECT_EQ(contents(folder.path("a.json")), "first");
  second.commit();
  EXPECT_EQ(contents(folder.path("a.json")), "second");
  EXPECT_EQ(folder.names().size(), 1u);
}

}  // namespace
}  // namespace tribofit
