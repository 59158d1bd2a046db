#include "tribofit/workbench/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <new>
#include <random>
#include <utility>

#include "connections.hpp"
#include "session_json.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

using namespace workbench;

namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr const char* kJson = "application/json";
constexpr std::size_t kLargestBody = 256 * 1024, kMostPages = 256, kLongestName = 64;
enum Status {
  kForbidden = 403,
  kUnknown,
  kWrongMethod,
  kTooLarge = 413,
  kWrongType = 415,
  kUnfit = 422,
  kBroken = 500
};

void answer(httplib::Response& response, const Json& json, int status = 200) {
  response.status = status;
  // With a charset the library does not compress it: on loopback that takes a second and saves nothing.
  response.set_content(line_of(json), "application/json; charset=utf-8");
}

/// Says why not.
void deny(httplib::Response& response, int status, const std::string& why, const std::string& suggestion) {
  const bool refused = status != kUnfit && status != kBroken;
  if (refused) response.set_header("Connection", "close");
  const char* problem = refused ? "the request is refused" : "this cannot be done";
  answer(response, {{"problem", problem}, {"why", why}, {"suggestion", suggestion}}, status);
}

std::string only(const httplib::Request& request, const char* header) {
  // Two of a kind are a trick: no browser sends them.
  return request.get_header_value_count(header) > 1 ? "(several)" : request.get_header_value(header);
}

/// 128 bits from the system's generator, as 32 hexadecimal digits.
std::string fresh_token() {
  std::random_device device;  // getrandom() or its like
  std::string token;
  for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", device());
  return token;
}

/// Whether two texts are the same, in a time that does not tell where they differ.
bool same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0u : 1u;
  for (std::size_t k = 0; k < b.size(); ++k) {
    const char other = k < a.size() ? a[k] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(other) ^ static_cast<unsigned char>(b[k]));
  }
  return difference == 0;
}

/// Why a request must not be answered, by what it says of where it comes from; empty: it may.
std::string refusal(const httplib::Request& request, int port) {
  const std::array<std::string, 2> own = {fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)};
  const std::string host = only(request, "Host"), origin = only(request, "Origin"),
                    site = only(request, "Sec-Fetch-Site");  // empty: it does not say
  if (host != own[0] && host != own[1]) return "it is addressed to another host";
  if (!origin.empty() && origin != "http://" + own[0] && origin != "http://" + own[1]) {
    return "it comes from another page";
  }
  return site.empty() || site == "same-origin" || site == "none" ? "" : "it comes from another site";
}

/// The page, which asks its own server, as a report asks nobody. policy: becomes what its answer carries.
std::string served_page(const std::string& trace, std::string& policy) {
  constexpr std::string_view kNothing = "default-src 'none'", kFrom = "Content-Security-Policy\" content=\"";
  Report empty;
  empty.kind = "workbench";
  empty.title = std::filesystem::path(trace).filename().string();
  std::string html = report_page(empty);
  html.insert(html.find(kNothing) + kNothing.size(), "; connect-src 'self'");
  const std::size_t begin = html.find(kFrom) + kFrom.size();
  policy = html.substr(begin, html.find('"', begin) - begin) + "; frame-ancestors 'none'";
  return html;
}

}  // namespace

struct WorkbenchServer::State {
  State(WorkbenchSession& given, Reread how) : current(std::shared_ptr<void>(), &given), reread(std::move(how)) {}

  std::shared_ptr<WorkbenchSession> current;  ///< the one it was given is not its own
  Reread reread;
  std::mutex rereading;
  LoopbackServer http;
  std::string token = fresh_token();
  int port = 0;
  std::string page;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::map<std::string, double> newest;  ///< turn of each page

  bool admits(const httplib::Request& request, httplib::Response& response) const;
  void add_handlers();
  void show(const Json& asked, httplib::Response& response);
  void change_conditions(const Json& asked, httplib::Response& response);
  /// Lives for as long as what was asked of it takes, also where another one takes its place meanwhile.
  std::shared_ptr<WorkbenchSession> session() {
    const std::lock_guard lock(mutex);
    return current;
  }
  bool is_newest(const std::string& page_name, double turn) {
    const std::lock_guard lock(mutex);
    const auto found = newest.find(page_name);
    return found != newest.end() && found->second == turn;
  }
  void take_turn(const std::string& page_name, double turn) {
    const std::lock_guard lock(mutex);
    if (newest.size() >= kMostPages && newest.count(page_name) == 0) newest.clear();
    double& last = newest[page_name];
    last = std::max(last, turn);
  }
  template <class Do>
  void post(const char* path, Do&& what);
};

/// Whether a request comes from a page of this server and can be read.
bool WorkbenchServer::State::admits(const httplib::Request& request, httplib::Response& response) const {
  if (const std::string why = refusal(request, port); !why.empty()) {
    deny(response, kForbidden, why, "open the address that `identify explore` prints");
    return false;
  }
  const bool in_address = request.path == "/" && request.get_param_value_count("token") == 1;
  const std::string given = in_address ? request.get_param_value("token") : only(request, "X-Workbench-Token");
  if (!same_secret(given, token)) {
    deny(response, kForbidden, "the token is missing or wrong", "open the address that `identify explore` prints");
    return false;
  }
  if (request.method != "GET" && request.method != "POST") {
    deny(response, kWrongMethod, "there is only GET and POST", "use the page");
    return false;
  }
  if (request.method == "GET") return true;
  const bool plain = !request.has_header("Transfer-Encoding") && !request.has_header("Content-Encoding") &&
                     only(request, "Content-Type").rfind(kJson, 0) == 0;
  if (!plain) {
    deny(response, kWrongType, "the body is not plain JSON", "use the page");
    return false;
  }
  return true;
}

/// An answer to a body of JSON; what cannot be done is said with its reason.
template <class Do>
void WorkbenchServer::State::post(const char* path, Do&& what) {
  http.Post(path, [this, what = std::forward<Do>(what)](const httplib::Request& request, httplib::Response& response) {
    try {
      what(parsed(request.body, "the request"), response);
    } catch (const InputError& error) {
      deny(response, kUnfit, error.problem(), error.advice());
    } catch (const Stopped&) {
      answer(response, {{"superseded", true}});
    } catch (const Json::exception&) {
      deny(response, kUnfit, "the request is incomplete", "use the page");
    } catch (const std::bad_alloc&) {
      deny(response, kBroken, "there is not enough memory", "choose a part of the record");
    }
  });
}

void WorkbenchServer::State::show(const Json& asked, httplib::Response& response) {
  const std::string name = asked.at("page").get<std::string>();
  const auto turn = asked.at("turn").get<double>();
  if (name.size() > kLongestName) throw InputError("the name of the page is too long", "use the page");
  take_turn(name, turn);
  const auto detail = asked.value("full", false) ? FitDetail::full : FitDetail::quick;
  const WorkbenchChoice choice = choice_from(asked.at("choice"));
  const std::shared_ptr<WorkbenchSession> now = session();
  const WorkbenchPicture picture = now->show(
      choice, detail, [&] { return !stopping && is_newest(name, turn); }, !asked.value("passing", false));
  answer(response, picture_json(picture, turn, *now));
}

/// The trace is read and moved anew: every rung was of other friction and speeds, so none is kept.
void WorkbenchServer::State::change_conditions(const Json& asked, httplib::Response& response) {
  if (!reread) throw InputError("the conditions cannot be changed here", "begin identify explore with others");
  StatedConditions conditions;
  for (const char* name : {"radius", "speed", "load"}) {
    const std::string value = asked.value(name, "");
    if (value.size() > kLongestName) throw InputError(fmt::format("the {} is too long", name), "give it as in 15mm");
    conditions.emplace_back(name, value);
  }
  const std::lock_guard one_at_a_time(rereading);
  std::shared_ptr<WorkbenchSession> next = reread(conditions);
  session()->cancel_diagnosis();
  {
    const std::lock_guard lock(mutex);
    current.swap(next);
  }
  answer(response, {{"reread", true}});
}

void WorkbenchServer::State::add_handlers() {
  const auto get = [this](const char* path, Json (*what)(const WorkbenchSession&)) {
    http.Get(path, [this, what](const httplib::Request&, httplib::Response& response) {
      answer(response, what(*session()));
    });
  };
  http.Get("/", [this](const httplib::Request&, httplib::Response& response) {
    // Given piece by piece it is not compressed either.
    response.set_content_provider(page.size(), "text/html; charset=utf-8",
                                  [this](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                    return sink.write(page.data() + offset, length);
                                  });
  });
  get("/api/begin", begin_json);
  get("/api/session", [](const WorkbenchSession& now) { return Json::parse(now.save()); });
  get("/api/diagnosis", [](const WorkbenchSession& now) { return diagnosis_json(now.diagnosis()); });
  post("/api/show", [this](const Json& asked, httplib::Response& response) { show(asked, response); });
  post("/api/curve", [this](const Json& asked, httplib::Response& response) {
    answer(response, curve_json(session()->curve(choice_from(asked.at("choice")), values_from(asked.at("values")))));
  });
  post("/api/diagnose", [this](const Json& asked, httplib::Response& response) {
    const bool begun = session()->begin_diagnosis(choice_from(asked.at("choice")));
    answer(response, {{"begun", begun}});
  });
  post("/api/plan", [this](const Json&, httplib::Response& response) {
    answer(response, {{"begun", session()->begin_plan()}});
  });
  post("/api/cancel", [this](const Json&, httplib::Response& response) {
    session()->cancel_diagnosis();
    answer(response, {{"cancelled", true}});
  });
  post("/api/conditions",
       [this](const Json& asked, httplib::Response& response) { change_conditions(asked, response); });
}

WorkbenchServer::WorkbenchServer(WorkbenchSession& session, int port, Reread reread)
    : state_(std::make_unique<State>(session, std::move(reread))) {
  State& s = *state_;
  std::string policy;
  s.page = served_page(session.record().path, policy);
  s.http.set_payload_max_length(kLargestBody);
  s.http.set_socket_options([](socket_t) {});  // by default it would share its port
  s.http.set_default_headers({{"Content-Security-Policy", policy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-store"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cross-Origin-Opener-Policy", "same-origin"}});
  s.http.set_pre_routing_handler([&s](const httplib::Request& request, httplib::Response& response) {
    return s.admits(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                       : httplib::Server::HandlerResponse::Handled;
  });
  s.http.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (!response.body.empty()) return;
    const int status = response.status;
    const char* why = status == kUnknown    ? "there is nothing with that name"
                      : status == kTooLarge ? "the body is too large"
                                            : "the request cannot be read";
    deny(response, status, why, "use the page");
  });
  s.http.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
    deny(response, kBroken, "something failed", "choose another model");
  });
  s.add_handlers();
  if (port == 0) {
    s.port = s.http.bind_to_any_port(kLoopback);
  } else if (s.http.bind_to_port(kLoopback, port)) {
    s.port = port;
  }
  if (s.port <= 0) {
    throw InputError(port == 0 ? "no port of 127.0.0.1 can be listened on"
                               : fmt::format("--port: {} cannot be listened on: it is taken, or not allowed", port),
                     "leave --port out to take a free one");
  }
}

WorkbenchServer::~WorkbenchServer() {
  stop();
}

int WorkbenchServer::port() const {
  return state_->port;
}

std::string WorkbenchServer::address() const {
  return fmt::format("http://{}:{}/?token={}", kLoopback, state_->port, state_->token);
}

const std::string& WorkbenchServer::token() const {
  return state_->token;
}

void WorkbenchServer::run() {
  state_->http.serve();
}

void WorkbenchServer::stop() {
  State& s = *state_;
  if (s.stopping.exchange(true)) return;
  s.session()->cancel_diagnosis();
  s.http.end();
}

}  // namespace tribofit
