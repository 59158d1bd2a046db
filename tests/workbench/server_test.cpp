#include "tribofit/workbench/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "lagging.hpp"
#include "running_server.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;
using workbench_test::kType;
using workbench_test::lagging;
using Server = workbench_test::RunningServer;

TEST_F(Server, shows_a_model_and_its_error) {
  const auto bare = show(R"({"law":"exponential"})"),
             lag = show(R"({"law":"exponential","effects":["frictional-lag"]})", 2);
  ASSERT_TRUE(bare && lag);
  ASSERT_EQ(bare->status, 200) << bare->body;
  ASSERT_EQ(lag->status, 200) << lag->body;
  const Json first = Json::parse(bare->body), second = Json::parse(lag->body);
  EXPECT_LT(second["rung"]["held_out_rmse"].get<double>(), 0.7 * first["rung"]["held_out_rmse"].get<double>());
  EXPECT_EQ(second["rungs"].size(), 2u);
  EXPECT_FALSE(second["report"]["sections"].empty());
}

TEST_F(Server, lets_in_only_who_has_the_token) {
  EXPECT_EQ(status_of(page(), {}), 200);
  EXPECT_EQ(status_of("/", {}), 403);
  EXPECT_EQ(status_of("/?token=", {}), 403);
  EXPECT_EQ(status_of("/?token=" + std::string(32, '0'), {}), 403);
  EXPECT_EQ(status_of(page() + "&token=x", {}), 403);
  EXPECT_EQ(status_of("/api/begin", {}), 403);
  EXPECT_EQ(status_of("/api/begin?token=" + server->token(), {}), 403);  // there in the header only
  EXPECT_EQ(status_of("/api/begin", {{"X-Workbench-Token", server->token() + "0"}}), 403);
  EXPECT_EQ(status_of("/api/begin", {{"X-Workbench-Token", server->token().substr(1)}}), 403);
  EXPECT_EQ(status_of("/api/begin", headers()), 200);
  const auto post = client().Post("/api/show", asked("{}"), kType);
  ASSERT_TRUE(post);
  EXPECT_EQ(post->status, 403);
}

TEST_F(Server, answers_its_own_pages_only) {
  const std::string own = "127.0.0.1:" + std::to_string(server->port());
  EXPECT_EQ(status_of("/api/begin", headers({{"Origin", "http://" + own}})), 200);
  EXPECT_EQ(status_of("/api/begin", headers({{"Sec-Fetch-Site", "same-origin"}})), 200);
  EXPECT_EQ(status_of("/api/begin", headers({{"Origin", "http://evil.example"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Origin", "null"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Origin", "https://" + own}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Sec-Fetch-Site", "cross-site"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Sec-Fetch-Site", "same-site"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Host", "evil.example"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Host", "127.0.0.1:1"}})), 403);
  EXPECT_EQ(status_of("/api/begin", headers({{"Host", "localhost:" + std::to_string(server->port())}})), 200);
  const std::string line = "GET /api/begin HTTP/1.1\r\nX-Workbench-Token: " + server->token() + "\r\n";
  EXPECT_THAT(raw(line + "\r\n"), HasSubstr("403"));
  EXPECT_THAT(raw(line + "Host: " + own + "\r\nHost: evil.example\r\n\r\n"), HasSubstr("403"));
}

TEST_F(Server, serves_no_files) {
  const std::string rest = " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server->port()) +
                           "\r\nX-Workbench-Token: " + server->token() + "\r\n\r\n";
  for (const char* path : {"/../etc/passwd", "/../../../../etc/passwd", "/%2e%2e/etc/passwd", "/..%2fetc%2fpasswd",
                           "//etc/passwd", "//", "/.", "/etc/passwd", "/api", "/api/", "/api/show/", "/lag.csv",
                           "/api/begin/../../etc/passwd", "/index.html", "/api/begin%00", "/\\..\\etc\\passwd"}) {
    EXPECT_THAT(raw(std::string("GET ") + path + rest), HasSubstr("404")) << path;
  }
  EXPECT_THAT(raw("DELETE /api/begin" + rest), HasSubstr("405"));
  EXPECT_THAT(raw("GET /" + std::string(20000, 'a') + rest), Not(HasSubstr("200")));
}

TEST_F(Server, takes_small_plain_bodies_only) {
  const auto large = client().Post("/api/show", headers(), std::string(300 * 1024, ' '), kType);
  ASSERT_TRUE(large);
  EXPECT_EQ(large->status, 413);
  const auto form = client().Post("/api/show", headers(), "a=b", "application/x-www-form-urlencoded");
  ASSERT_TRUE(form);
  EXPECT_EQ(form->status, 415);
  const auto zipped = client().Post("/api/show", headers({{"Content-Encoding", "gzip"}}), "{}", kType);
  ASSERT_TRUE(zipped);
  EXPECT_EQ(zipped->status, 415);
  for (const std::string& broken : {std::string("{"), std::string("[]"), std::string("{}"), std::string(5000, '['),
                                    asked("7"), asked(R"({"law":"no"})")}) {
    const auto answer = client().Post("/api/show", headers(), broken, kType);
    ASSERT_TRUE(answer) << broken;
    EXPECT_EQ(answer->status, 422) << broken;
    EXPECT_TRUE(Json::parse(answer->body).contains("problem")) << broken;
  }
  EXPECT_EQ(show(R"({"law":"exponential"})")->status, 200);
}

TEST_F(Server, plans_nothing_where_nothing_was_diagnosed) {
  const auto answer = client().Post("/api/plan", headers(), "{}", kType);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_FALSE(Json::parse(answer->body)["begun"].get<bool>());
}

TEST_F(Server, says_what_is_wrong_and_lives_on) {
  const auto bad = show(R"({"law":"exponential","formulas":["hump = a*exp(-v"]})");
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->status, 422);
  const Json said = Json::parse(bad->body);
  EXPECT_THAT(said["why"].get<std::string>(), HasSubstr("hump"));
  EXPECT_FALSE(said["suggestion"].get<std::string>().empty());
  EXPECT_EQ(show(R"({"law":"exponential"})", 2)->status, 200);
}

TEST_F(Server, forbids_its_page_what_it_does_not_need) {
  const auto answer = client().Get(page());
  ASSERT_TRUE(answer);
  const std::string policy = answer->get_header_value("Content-Security-Policy");
  EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy, HasSubstr("connect-src 'self'"));
  EXPECT_THAT(policy, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(policy, Not(HasSubstr("unsafe-eval")));
  const std::size_t scripts = policy.find("script-src ");
  ASSERT_NE(scripts, std::string::npos) << policy;
  const std::string directive = policy.substr(scripts, policy.find(';', scripts) - scripts);
  EXPECT_THAT(directive, HasSubstr("'sha256-"));
  EXPECT_THAT(directive, Not(HasSubstr("unsafe")));
  EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(answer->get_header_value("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Origin"), "");
}

TEST_F(Server, serves_two_pages_at_once) {
  const auto ask_often = [&](const std::string& name, const std::string& choice) {
    int good = 0;
    for (int turn = 1; turn <= 5; ++turn) {
      const auto answer = show(choice, turn, name);
      if (answer && answer->status == 200 && Json::parse(answer->body).value("turn", 0) == turn) ++good;
    }
    return good;
  };
  int first = 0, second = 0;
  std::thread other([&] { first = ask_often("a", R"({"law":"fractional"})"); });
  second = ask_often("b", R"({"law":"exponential","effects":["viscous"]})");
  other.join();
  EXPECT_EQ(first, 5);
  EXPECT_EQ(second, 5);
  EXPECT_EQ(session->rungs().size(), 2u);
}

TEST_F(Server, stops_a_fit_that_a_page_no_longer_wants) {
  std::string powers = "k*(v/w)^.1";
  for (int k = 11; k < 99; ++k) powers += "+k*(v/w)^." + std::to_string(k);
  const std::string slow =
      R"({"law":"exponential","effects":["rate-state"],"formulas":["a = )" + powers + R"(; k=0.001, w=6"]})";
  std::string given_up;
  std::thread asker([&] {
    if (const auto answer = show(slow, 1)) given_up = answer->body;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto next = show(R"({"law":"fractional"})", 2);
  asker.join();  // without waiting for a fit that takes minutes
  ASSERT_TRUE(next);
  EXPECT_EQ(next->status, 200) << next->body;
  EXPECT_THAT(given_up, HasSubstr("superseded"));
  EXPECT_EQ(session->rungs().size(), 1u) << "what was given up is no rung";
}

TEST_F(Server, gives_up_what_a_page_no_longer_wants) {
  // Another fit holds the lane until all have asked.
  std::promise<void> held, all_asked;
  std::thread holder([&] {
    const auto hold = [&] {
      held.set_value();
      all_asked.get_future().wait();
      return false;
    };
    EXPECT_THROW(session->show({}, FitDetail::quick, hold), Stopped);
  });
  held.get_future().wait();
  std::vector<std::thread> askers;
  std::atomic<int> shown{0}, superseded{0};
  for (int turn = 1; turn <= 8; ++turn) {
    askers.emplace_back([&, turn] {
      const auto answer =
          show(R"({"law":"exponential","start":{"mu_s":0.4)" + std::to_string(turn) + "}}", turn, "dragging");
      if (!answer || answer->status != 200) return;
      ++(Json::parse(answer->body).contains("superseded") ? superseded : shown);
    });
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  all_asked.set_value();
  holder.join();
  for (std::thread& asker : askers) asker.join();
  EXPECT_EQ(shown + superseded, 8);
  EXPECT_GE(shown, 1);
  EXPECT_GE(superseded, 1);
  EXPECT_LE(session->rungs().size(), static_cast<std::size_t>(shown));
}

TEST_F(Server, listens_on_this_machine_only) {
  httplib::Client outside("127.0.0.2", server->port());
  outside.set_connection_timeout(1);
  EXPECT_FALSE(outside.Get(page()));
  EXPECT_THROW(WorkbenchServer(*session, server->port()), InputError);
}

TEST_F(Server, that_was_stopped_before_it_ran_ends_at_once) {
  WorkbenchServer early(*session, 0);
  early.stop();
  std::promise<void> over;
  auto ended = over.get_future();
  std::thread running([&] {
    early.run();
    over.set_value();
  });
  ASSERT_EQ(ended.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  running.join();
}

TEST_F(Server, has_a_token_that_is_long_and_its_own) {
  EXPECT_EQ(server->token().size(), 32u);
  EXPECT_NE(WorkbenchServer(*session, 0).token(), server->token());
}

/// The real command: it prints its address, answers there, and ends within two seconds of a signal, in the middle of a
/// fit.
TEST(Explore, ends_in_the_middle_of_a_fit) {
  if (!has_report_page()) GTEST_SKIP() << "this build has no page";
  const Workshop& workshop = lagging().workshop;
  const auto files = workshop.names();
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::dup2(pipe_ends[1], STDOUT_FILENO);
    ::close(pipe_ends[0]);
    ::execl(TRIBOFIT_IDENTIFY, "identify", "explore", "--radius", "15mm", lagging().path.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(pipe_ends[1]);
  std::string said;
  char byte = 0;
  while (said.find("Ctrl-C") == std::string::npos && ::read(pipe_ends[0], &byte, 1) == 1) said += byte;
  const std::size_t at = said.find("http://127.0.0.1:");
  ASSERT_NE(at, std::string::npos) << said;
  const int port = std::stoi(said.substr(at + 17));
  const std::string token = said.substr(said.find("token=") + 6, 32);
  std::atomic<bool> answered{false};
  std::thread asker([&] {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    const auto answer =
        client.Post("/api/show", {{"X-Workbench-Token", token}},
                    R"({"page":"p","turn":1,"full":true,"choice":{"law":"exponential","effects":["rate-state",)"
                    R"("contact-spin","runout"],"formulas":["a = k*exp(-v/w)*sin(t*f); k=0.01, w=6, f=3"]}})",
                    kType);
    answered = answer && answer->body.find("superseded") == std::string::npos;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(answered);  // it fits
  const auto begin = std::chrono::steady_clock::now();
  ::kill(child, SIGTERM);
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  asker.join();
  EXPECT_FALSE(answered);  // and did so to its end
  ::close(pipe_ends[0]);
  EXPECT_EQ(workshop.names(), files);  // and left nothing half-written behind
}

}  // namespace
}  // namespace tribofit
