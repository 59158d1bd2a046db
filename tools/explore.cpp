#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <stdexcept>
#include <system_error>

#include "memory.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/workbench/server.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

struct ExploreSettings : Settings {
  int port = 0;
  std::string session;
};

void add_options(const Command& app, ExploreSettings& s) {
  add_input_options(app, s);
  add_model_options(app, s);
  add_parameter_options(app, s);
  const Command server = app.in(section::kServer);
  server.add_option("--session", s.session, "Go on with a session that the page saved (the trace is named in it)");
  server.add_option("--port", s.port, "Port of 127.0.0.1 to listen on (default: a free one)").range(1, 65535);
  add_threads_option(server, s);
}

/// What the words say, but for the threads of the server.
ExploreSettings settings_of(std::vector<std::string> words, const std::string& trace, int threads) {
  ExploreSettings s;
  words.push_back(trace);
  parse_words(std::move(words), [&](const Command& explore) { add_options(explore, s); });
  s.identify.threads = threads;
  return s;
}

/// The words of a command line without these options and their values.
std::vector<std::string> without(const std::vector<std::string>& options, const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (std::find(options.begin(), options.end(), words[k]) == options.end()) {
      out.push_back(words[k]);
    } else {
      ++k;  // with its value
    }
  }
  return out;
}

WorkbenchOptions options_for(const ExploreSettings& s, const std::vector<std::string>& arguments) {
  WorkbenchOptions options;
  if (std::ranges::any_of(s.formulas, [](const std::string& text) { return text.starts_with('@'); }))
    throw UsageError("--formula: type it, or paste it into the page; @FILE is not read here");
  options.identify = options_from(s);
  const Input input = only_input(s, options.identify.read, "explore");
  options.input = input.trace;
  options.notes = input.notes;
  options.warnings = input.warnings;
  const auto others =
      without({"--law", "--effect", "--formula", "--start", "--bounds", "--cycles", "--exclude"}, arguments);
  options.arguments = arguments_for(input, others);  // the page changes the choice
  options.instruments_declared = !s.instruments.empty();
  options.begin.law = options.identify.laws.front();
  options.begin.effects = s.effects;
  options.begin.formulas = s.formulas;
  options.begin.given = options.identify.fit.given;
  options.begin.selection = options.identify.selection;
  options.identify.laws = IdentifyOptions().laws;  // all of them climb in a diagnosis
  return options;
}

/// The words with other conditions; those not stated are found in the record, as ever.
std::vector<std::string> with_conditions(const std::vector<std::string>& words, const StatedConditions& conditions) {
  std::vector<std::string> out, names;
  for (const auto& [name, value] : conditions) {
    names.push_back("--" + name);
    if (!value.empty()) out.insert(out.end(), {names.back(), value});
  }
  const std::vector<std::string> others = without(names, words);
  out.insert(out.end(), others.begin(), others.end());
  return out;
}

/// A saved session has its own options: others beside it would have no effect.
void refuse_beside_session(const std::vector<std::string>& arguments) {
  std::string others;
  for (const std::string& word : arguments) {
    if (word.rfind("--", 0) != 0) continue;
    if (others.find(word) == std::string::npos) others += (others.empty() ? "" : ", ") + word;
  }
  if (others.empty()) return;
  throw UsageError("--session: the saved session has its own options; leave out " + others +
                   " (only --port and --threads may be given beside it)");
}

/// The settings that a saved session was begun with, but for what is given to the server itself now.
void take_over(const SavedWorkbench& saved, ExploreSettings& s) {
  const ExploreSettings now = s;
  try {
    s = settings_of(saved.arguments, saved.trace, now.identify.threads);
  } catch (const UsageError& error) {
    throw InputError(std::string("holds options that cannot be read: ") + error.what(), "save the session again",
                     {now.session, 0, ""});
  }
  if (!now.traces.empty()) s.traces = now.traces;
  s.session = now.session;
  s.port = now.port;
}

/// Signals that end the server in an orderly way, held back from every thread but the one that waits for them.
sigset_t hold_back_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return set;
}

/// Many connections at a time need as many descriptors, of which most systems allow more than they give unasked.
void allow_many_connections() {
  constexpr rlim_t kDescriptors = 4096;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kDescriptors) return;
  limit.rlim_cur = std::min(limit.rlim_max, kDescriptors);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// Serves until a signal comes. Throws where the server ends by itself.
void serve(WorkbenchServer& server) {
  const sigset_t signals = hold_back_signals();
  std::atomic<bool> ended = false;
  const auto answer = [&] {
    server.run();
    ended = true;
    ::kill(::getpid(), SIGTERM);  // wakes who waits for a signal, where the server has ended by itself
  };
  std::future<void> answering;
  try {
    answering = std::async(std::launch::async, answer);
  } catch (const std::system_error&) {
    throw std::runtime_error("the system starts no further thread; end other programs, or allow more (ulimit -u)");
  }
  for (int signal = 0; sigwait(&signals, &signal) != 0;) {
  }
  if (ended) throw std::runtime_error("the server of the workbench has stopped unexpectedly");
  server.stop();
  // A fit that is under way ends in a moment; one that does not is given up.
  constexpr auto kPatience = std::chrono::milliseconds(1500);
  if (answering.wait_for(kPatience) != std::future_status::ready) ::_exit(static_cast<int>(ExitStatus::done));
}

ExitStatus run_explore(ExploreSettings& s, const std::vector<std::string>& given) {
  std::vector<std::string> arguments = given;
  std::string saved;
  if (!s.session.empty()) {
    constexpr std::uint64_t kMost = 64 << 20;
    saved = text_of_file(s.session, kMost, "give --session a file that the page saved");
    const SavedWorkbench earlier = saved_workbench(saved, s.session);
    take_over(earlier, s);
    arguments = earlier.arguments;
  }
  set_memory(Memory::of_two_heaps);
  WorkbenchSession session(options_for(s, arguments));
  if (!saved.empty()) session.load(saved, s.session);
  allow_many_connections();
  const Reread reread = [&](const StatedConditions& conditions) {
    try {
      const std::vector<std::string> words = with_conditions(arguments, conditions);
      return std::make_unique<WorkbenchSession>(
          options_for(settings_of(words, s.traces.front(), s.identify.threads), words));
    } catch (const UsageError& error) {
      throw InputError(error.what(), "give conditions as the command line takes them: 15mm, 4rpm, 50N");
    }
  };
  WorkbenchServer server(session, s.port, reread);
  print("The workbench for " + session.record().path + " is at\n\n  " + server.address() +
        "\n\nOpen it in a browser on this machine. Ctrl-C ends it.\n");
  serve(server);
  return ExitStatus::done;
}

}  // namespace

void add_explore(const Command& app) {
  const Command verb = app.add_verb(
      "explore", "A live page: switch effects on and watch the error fall",
      "Serves a page on this machine (127.0.0.1) until Ctrl-C: choose the law and effects, drag starts and bounds,\n"
      "choose cycles, exclude stretches of time, type a formula, change radius, speed and load; each change is fitted\n"
      "at once, and the ladder keeps every model visited. The page shows the command that fits the model shown, and\n"
      "saves the session as a file. The printed address holds the token that gives access.\n\n"
      "Examples:\n"
      "  identify explore --radius 15mm trace.csv\n"
      "  identify explore --radius 15mm --effect viscous --port 8080 trace.csv\n"
      "  identify explore --session trace-session.json");
  const auto settings = std::make_shared<ExploreSettings>();
  add_options(verb, *settings);
  verb.on_run([settings, verb] {
    if (!settings->session.empty()) refuse_beside_session(verb.own_options());
    if (settings->traces.empty() && settings->session.empty())
      throw UsageError("no trace given; try `identify explore --radius 15mm trace.csv`");
    return run_explore(*settings, verb.own_options());
  });
}
