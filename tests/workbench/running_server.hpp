#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "lagging.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/workbench/server.hpp"

namespace workbench_test {

inline constexpr const char* kType = "application/json";

/// A server with its session and a thread that runs it.
class RunningServer : public testing::Test {
 protected:
  void SetUp() override {
    if (!tribofit::has_report_page()) GTEST_SKIP() << "this build has no page";
    session.emplace(lagging().options());
    server.emplace(*session, 0);
    thread = std::thread([this] { server->run(); });
    for (int k = 0; k < 100 && !client().Get(page()); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  void TearDown() override {
    if (!server) return;
    server->stop();
    thread.join();
  }

  httplib::Client client() const {
    httplib::Client made("127.0.0.1", server->port());
    made.set_read_timeout(60);
    return made;
  }
  std::string page() const { return "/?token=" + server->token(); }
  httplib::Headers headers(httplib::Headers more = {}) const {
    more.emplace("X-Workbench-Token", server->token());
    return more;
  }
  int status_of(const std::string& path, const httplib::Headers& sent) const {
    const auto answer = client().Get(path, sent);
    return answer ? answer->status : 0;
  }
  static std::string asked(const std::string& choice, int turn = 1, const std::string& name = "p") {
    return R"({"page":")" + name + R"(","turn":)" + std::to_string(turn) + R"(,"choice":)" + choice + "}";
  }
  httplib::Result show(const std::string& choice, int turn = 1, const std::string& name = "p") const {
    return client().Post("/api/show", headers(), asked(choice, turn, name), kType);
  }
  /// Sends bytes as they are, for what no client would send; the first line of the answer.
  std::string raw(const std::string& request) const {
    const int socket = connected();
    std::string answer;
    if (send(socket, request)) {
      char buffer[4096];
      for (ssize_t n = 0; (n = ::recv(socket, buffer, sizeof buffer, 0)) > 0;) {
        answer.append(buffer, static_cast<std::size_t>(n));
      }
    }
    ::close(socket);
    return answer.substr(0, answer.find("\r\n"));
  }
  /// A socket that is connected and sends nothing yet.
  int connected() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server->port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return socket;
  }
  static bool send(int socket, const std::string& bytes) {
    return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// Whether the server has closed the connection; gives it so long.
  static bool is_dropped(int socket, std::chrono::steady_clock::time_point until) {
    char buffer[4096];
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      pollfd waiting = {socket, POLLIN, 0};
      if (::poll(&waiting, 1, std::max(0, static_cast<int>(left.count()))) <= 0) return false;
      if (::recv(socket, buffer, sizeof buffer, 0) <= 0) return true;
    }
  }

  std::optional<tribofit::WorkbenchSession> session;
  std::optional<tribofit::WorkbenchServer> server;
  std::thread thread;
};

}  // namespace workbench_test
