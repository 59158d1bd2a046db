// Callers that send nothing, or a byte now and then, or do not end.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "running_server.hpp"

namespace tribofit {
namespace {

using workbench_test::kType;

using AttackedServer = workbench_test::RunningServer;

/// Megabytes of this process in memory.
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0, here = 0;
  file >> all >> here;
  return here * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// A thousand callers that never finish what they say, in three ways, hold up nobody; each is dropped, and what it took
/// given back.
TEST_F(AttackedServer, answers_its_page_among_a_thousand_that_dawdle) {
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = std::max<rlim_t>(files.rlim_cur, std::min<rlim_t>(files.rlim_max, 4096));
  if (::setrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur < 2500) GTEST_SKIP() << "too few open files allowed";
  using Clock = std::chrono::steady_clock;
  const std::string head = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n";
  const std::string long_head = head + "X: " + std::string(4000, 'x');
  const double before = resident();
  for (int round = 0; round < 3; ++round) {
    std::vector<int> sockets;
    for (int k = 0; k < 1000; ++k) {
      sockets.push_back(connected());
      if (k % 3 != 0) send(sockets.back(), k % 3 == 1 ? head : long_head);
    }
    std::atomic<bool> over{false};
    std::thread dripping([&] {
      while (!over) {
        for (std::size_t k = 1; k < sockets.size(); k += 3) send(sockets[k], "x");
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
    const auto asked_at = Clock::now();
    EXPECT_EQ(status_of(page(), {}), 200);
    EXPECT_LT(Clock::now() - asked_at, std::chrono::seconds(3));  // in turns of a second it would be a minute
    std::size_t dropped = 0;
    for (const int socket : sockets) dropped += is_dropped(socket, asked_at + std::chrono::seconds(5));
    EXPECT_EQ(dropped, sockets.size());
    over = true;
    dripping.join();
    for (const int socket : sockets) ::close(socket);
  }
  EXPECT_LT(resident() - before, 100);
}

TEST_F(AttackedServer, drops_what_does_not_end) {
  const std::string own =
      "Host: 127.0.0.1:" + std::to_string(server->port()) + "\r\nX-Workbench-Token: " + server->token() + "\r\n";
  const auto endless = [&](const std::string& begin, const std::string& more) {
    const int socket = connected();
    send(socket, begin);
    bool taken = true;
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (taken && std::chrono::steady_clock::now() < until) taken = send(socket, more);
    ::close(socket);
    return taken;
  };
  EXPECT_FALSE(endless("GET / HTTP/1.1\r\n" + own, "X: y\r\n"));
  EXPECT_FALSE(endless(
      "POST /api/show HTTP/1.1\r\n" + own + "Content-Type: application/json\r\nContent-Length: 1000000000000\r\n\r\n",
      std::string(4096, ' ')));
  EXPECT_FALSE(endless("POST /api/show HTTP/1.1\r\nContent-Length: 1000000000000\r\n\r\n", std::string(4096, ' ')));
  for (const std::string& formula : {std::string(200 * 1024, '('), "a = " + std::string(200 * 1024, '-') + "v",
                                     "a = v" + std::string(200 * 1024, '^'), std::string(10 << 20, 'v')}) {
    const auto answer = show(R"({"law":"exponential","formulas":[")" + formula + R"("]})");
    EXPECT_TRUE(!answer || answer->status == 422 || answer->status == 413) << formula.substr(0, 10);
  }
  const auto deep = client().Post("/api/show", headers(), std::string(250 * 1024, '['), kType);
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->status, 422);
  EXPECT_EQ(show(R"({"law":"exponential"})", 2)->status, 200);
}

}  // namespace
}  // namespace tribofit
