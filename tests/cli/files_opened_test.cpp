#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <map>
#include <string>

#include "command.hpp"

namespace {

/// How often files are opened while it lives. Two openings of one file are told apart by the close between them.
class Openings {
 public:
  explicit Openings(const std::filesystem::path& file) : events_(::inotify_init1(IN_NONBLOCK)) {
    ::inotify_add_watch(events_, file.c_str(), IN_OPEN | IN_CLOSE);
  }
  ~Openings() { ::close(events_); }
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  int count() const {
    int found = 0;
    alignas(inotify_event) std::array<char, 65536> buffer{};
    for (ssize_t length; (length = ::read(events_, buffer.data(), buffer.size())) > 0;) {
      for (ssize_t at = 0; at < length;) {
        inotify_event event{};
        std::memcpy(&event, buffer.data() + at, sizeof event);
        found += (event.mask & IN_OPEN) != 0 ? 1 : 0;
        at += static_cast<ssize_t>(sizeof event) + event.len;
      }
    }
    return found;
  }

 private:
  int events_;
};

/// Openings of `file` by a command that must end well.
int openings(const Workshop& shop, const std::string& file, const std::string& arguments) {
  const Openings openings(shop / file);
  const Outcome run = shop.identify(arguments + " --quiet");
  EXPECT_EQ(run.status, 0) << arguments << run.err;
  return openings.count();
}

TEST(FilesOpened, ACommandReadsItsTraceOnce) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.write("lab.json", R"({"force_sensor": {"bandwidth": {"value": "200Hz", "uncertainty": "10Hz"}}})");
  const std::string record = "--radius 15mm --speed 4rpm --load 50N trace.csv";
  for (const char* command : {"", "--effect runout", "--protocol published", "--instruments lab.json", "diagnose",
                              "diagnose --instruments lab.json", "plan --speeds 2rpm..4rpm", "rig", "twin",
                              "study response", "study phase"}) {
    EXPECT_EQ(openings(shop, "trace.csv", command + std::string(" ") + record), 1) << command;
  }
}

TEST(FilesOpened, EveryRecordOfADiagnosisIsReadOnce) {
  const Workshop shop;
  std::map<std::string, std::string> traces = {{"one.csv", good_trace()}, {"two.csv", good_trace()}};
  traces["two.csv"].resize(traces["two.csv"].rfind('\n', traces["two.csv"].size() - 2000) + 1);
  for (const auto& [name, text] : traces) shop.write(name, text);
  const std::string record = "--radius 15mm --speed 4rpm --load 50N ";
  for (const auto& [name, text] : traces) {
    EXPECT_EQ(openings(shop, name, "diagnose " + record + "one.csv two.csv"), 1) << name;
    EXPECT_EQ(openings(shop, name, "diagnose " + record + "--confirm two.csv one.csv"), 1) << name << " confirms";
  }
}

TEST(FilesOpened, ABatchHashesAFileAndReadsIt) {
  const Workshop shop;
  shop.shell("mkdir runs");
  shop.write("runs/one.csv", good_trace());
  shop.write("runs/two.csv", good_trace() + "\n");
  shop.write("runs/manifest.csv", "file,radius_mm,speed_rpm\none.csv,15,4\ntwo.csv,15,4\n");
  EXPECT_EQ(openings(shop, "runs/one.csv", "runs"), 2);
  EXPECT_EQ(openings(shop, "runs/one.csv", "runs"), 1) << "its result is there";
  EXPECT_EQ(openings(shop, "runs/manifest.csv", "runs"), 1);
}

TEST(FilesOpened, VerbsThatOnlyListReadOnce) {
  const Workshop shop;
  shop.shell("mkdir runs");
  shop.write("runs/one.csv", good_trace());
  const Openings listed(shop / "runs/one.csv");
  EXPECT_EQ(shop.identify("columns runs/one.csv").status, 0);
  EXPECT_EQ(listed.count(), 1);
  EXPECT_EQ(shop.identify("manifest runs").status, 0);
  EXPECT_EQ(listed.count(), 1);
}

}  // namespace
