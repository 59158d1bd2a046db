#include "command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

#include "console.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "typed_values.hpp"

namespace {

constexpr std::size_t kHelpColumn = 30;

/// Where results go, and how runs are found and combined: that does not shape the analysis.
bool shapes_analysis(const Command::Typed& option) {
  const std::string& s = option.section;
  return !option.is_positional && s != section::kOutput && s != section::kBatch && s != section::kTogether &&
         s != section::kServer && s != section::kMeans;
}

/// The option meant by a misspelt one, for the message.
std::string nearest_option(const CLI::App& app, const std::string& message) {
  const std::size_t at = message.find("--");
  if (at == std::string::npos) return "";
  const std::string word = message.substr(at, message.find_first_of("= ", at) - at);
  std::vector<std::string> known;
  for (const CLI::App* part : {&app, app.get_subcommands().empty() ? &app : app.get_subcommands().front()}) {
    for (const CLI::Option* option : part->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  const std::string nearest = tribofit::nearest_name(word, known);
  constexpr std::size_t kAlike = 4;  // two dashes and two letters: anything less is not a misspelling
  return nearest.substr(0, kAlike) == word.substr(0, kAlike) ? "; did you mean " + nearest + "?" : "";
}

/// The words in "TEXT:{svg,pdf,png}".
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return tribofit::split(std::string_view(type).substr(begin + 1, end - begin - 1), ',');
}

std::vector<CLI::App*> verbs_of(CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Where a command of an example may go on in the next line: before an option, else at the last blank.
std::size_t break_of_command(const std::string& line, std::size_t width) {
  constexpr std::size_t kContinued = 6;  // blanks before it
  const std::size_t last = std::min(width - 2, line.size() - 1);
  const std::size_t option = line.rfind(" -", last), blank = line.rfind(' ', last);
  if (option != std::string::npos && option > kContinued + 10) return option;
  return blank != std::string::npos && blank > kContinued ? blank : std::string::npos;
}

/// A line of an example, "  identify ...    what for", as lines of the width: what it is for below it, where both do
/// not fit beside each other.
std::string folded_example(const std::string& line, std::size_t width) {
  if (line.size() <= width) return line + "\n";
  const std::size_t gap = line.find("  ", line.find_first_not_of(' '));
  if (gap != std::string::npos) {
    const std::string what = line.substr(line.find_first_not_of(' ', gap));
    return folded_example(line.substr(0, gap), width) + "      " + folded(std::string(6, '#') + what, 6).substr(6) +
           "\n";
  }
  const std::size_t at = break_of_command(line, width);
  if (at == std::string::npos) return line + "\n";
  return line.substr(0, at) + " \\\n" + folded_example("      " + line.substr(at + 1), width);
}

/// The help of CLI11 with lines no wider than the terminal.
class FoldedHelp : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    const std::size_t width = prose_width();
    std::string out, sentence;  // lines of prose are put together again
    const auto flush = [&] {
      if (!sentence.empty()) out += folded(sentence) + "\n";
      sentence.clear();
    };
    for (const std::string& line : tribofit::split(CLI::Formatter::make_help(app, std::move(name), mode), '\n')) {
      const bool is_prose = !line.empty() && line[0] != ' ' && line.back() != ':' && !line.starts_with("Usage");
      if (is_prose) {
        sentence += (sentence.empty() ? "" : " ") + line;
        continue;
      }
      flush();
      if (line.starts_with("  identify") || line.starts_with("  source") || line.starts_with("      ")) {
        const bool is_column = line.find_first_not_of(' ') >= kHelpColumn;
        out += is_column ? line.substr(0, kHelpColumn) + folded_after(line.substr(kHelpColumn)) + "\n"
                         : folded_example(line, width);
      } else if (line.size() > kHelpColumn && line.starts_with("  ")) {
        out += line.substr(0, kHelpColumn) + folded_after(line.substr(kHelpColumn)) + "\n";
      } else {
        out += line + "\n";
      }
    }
    flush();
    while (out.ends_with("\n\n")) out.pop_back();
    return out;
  }

 private:
  static std::string folded_after(const std::string& text) {
    return folded(std::string(kHelpColumn, '#') + text, kHelpColumn).substr(kHelpColumn);
  }
};

ExitStatus wrong_usage(const CLI::App& app, const std::string& text) {
  const auto verbs = app.get_subcommands();
  print_error(text + "\n`identify " + (verbs.empty() ? "" : verbs.front()->get_name() + " ") +
              "--help` lists the options");
  return ExitStatus::wrong_usage;
}

}  // namespace

Option Option::required() const {
  parsed_->required();
  return *this;
}

Option Option::describe(const char* help) const {
  parsed_->description(help);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) const {
  parsed_->check(CLI::IsMember(words));
  return *this;
}

template <class T>
Option Option::range(T least, T most) const {
  parsed_->check(CLI::Range(least, most));
  return *this;
}
template Option Option::range(int, int) const;
template Option Option::range(double, double) const;

Command::Command(CLI::App& app, ExitStatus& status)
    : app_(&app), status_(&status), readers_(std::make_shared<std::vector<std::function<void()>>>()) {}

std::string Command::likely_verb(const std::string& word) const {
  std::vector<std::string> known;
  for (const CLI::App* verb : verbs_of(*app_)) known.push_back(verb->get_name());
  return tribofit::likely_name(word, known);
}

Command Command::add_verb(const char* name, const char* help, const char* footer) const {
  CLI::App* verb = app_->add_subcommand(name, help);
  if (*footer != 0) verb->footer(footer);  // else it has that of the verb above it
  return {*verb, *status_};
}

Command Command::in(const char* section) const {
  Command out = *this;
  out.section_ = section;
  return out;
}

void Command::narrow_help() const {
  app_->get_formatter()->column_width(kHelpColumn);
}

void Command::requires_kind(const char* advice) const {
  app_->require_subcommand(0, 1);
  app_->callback([app = app_, advice] {
    if (app->get_subcommands().empty()) throw UsageError(advice);
  });
}

Option Command::added(CLI::Option* option) const {
  if (section_ != nullptr) option->group(section_);
  return Option(option);
}

template <class T>
Option Command::add_option(const std::string& names, T& value, const std::string& help) const {
  CLI::Option* option = app_->add_option(names, value, help);
  if constexpr (std::is_same_v<T, std::vector<std::string>>) option->allow_extra_args(false);
  return added(option);
}
template Option Command::add_option(const std::string&, std::string&, const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&) const;
template Option Command::add_option(const std::string&, int&, const std::string&) const;
template Option Command::add_option(const std::string&, std::size_t&, const std::string&) const;
template Option Command::add_option(const std::string&, double&, const std::string&) const;

Option Command::add_names(const std::string& name, std::vector<std::string>& values, const std::string& help) const {
  return added(app_->add_option(name, values, help));
}

Option Command::add_flag(const std::string& names, bool& value, const std::string& help) const {
  return added(app_->add_flag(names, value, help));
}

Option Command::option(const char* name) const {
  return Option(app_->get_option(name));
}

Option Command::add_read(const std::string& names, Read read, const std::string& help,
                         const std::string& otherwise) const {
  const auto text = std::make_shared<std::string>(otherwise);
  readers_->push_back([text, read = std::move(read)] {
    if (!text->empty()) read(*text);
  });
  CLI::Option* option = app_->add_option(names, *text, help);
  if (!otherwise.empty()) option->capture_default_str();
  return added(option);
}

Option Command::add_each(const std::string& names, Read read, const std::string& help) const {
  const auto texts = std::make_shared<std::vector<std::string>>();
  readers_->push_back([texts, read = std::move(read)] { std::for_each(texts->begin(), texts->end(), read); });
  return add_option(names, *texts, help);
}

Option Command::add_number(const std::string& name, const TypedNumber& how, std::function<void(double)> take,
                           const std::string& help) const {
  const auto read = [name, how, take = std::move(take)](const std::string& text) {
    take((how.is_positive ? positive_value : stated_value)(text, how.quantity, name));
  };
  return add_read(name, read, help, how.otherwise);
}

void Command::run_later(std::function<ExitStatus()> run) const {
  app_->callback([own = *this, run = std::move(run)] {
    if (!own.app_->get_subcommands().empty()) return;
    own.read_options();
    *own.status_ = run();
  });
}

void Command::read_options() const {
  for (const Typed& option : typed()) {
    const auto& values = option.values;
    if (option.is_flag || std::find(values.begin(), values.end(), "") == values.end()) continue;
    const std::string name = option.is_positional ? "a trace" : option.name;
    throw UsageError(name + " is given an empty value; give one or leave it out");
  }
  for (const auto& read : *readers_) read();
}

void Command::before_verb(std::function<void(const std::string&)> check) const {
  app_->parse_complete_callback([app = app_, check = std::move(check)] {
    const auto verbs = app->get_subcommands();
    if (!verbs.empty()) check(verbs.front()->get_name());
  });
}

std::vector<Command::Typed> Command::typed() const {
  std::vector<Typed> out;
  for (const CLI::Option* option : app_->get_options()) {
    if (option->count() == 0) continue;
    out.push_back({option->get_name(), option->results(), option->get_items_expected_max() == 0,
                   option->get_positional(), option->get_group()});
  }
  return out;
}

void Command::keep_typed(std::vector<Typed>& out) const {
  readers_->push_back([app = app_, status = status_, &out] { out = Command(*app, *status).typed(); });
}

std::vector<std::string> Command::verbs() const {
  std::vector<std::string> out = {""};
  for (CLI::App* verb : verbs_of(*app_)) {
    for (const std::string& below : Command(*verb, *status_).verbs())
      out.push_back(verb->get_name() + (below.empty() ? "" : " ") + below);
  }
  return out;
}

Command::Offer Command::offer_after(const std::vector<std::string>& before, bool is_option) const {
  CLI::App* at = app_;
  for (const std::string& word : before) {
    for (CLI::App* verb : verbs_of(*at)) at = verb->get_name() == word ? verb : at;
  }
  Offer offer;
  for (const CLI::Option* option : at->get_options()) {
    const std::vector<std::string> words = words_of(*option);
    for (const std::string& name : option->get_lnames()) {
      if (!before.empty() && before.back() == "--" + name && !words.empty()) return {words};
      if (is_option) offer.words.push_back("--" + name);
    }
    if (option->get_positional() && !is_option) offer.words.insert(offer.words.end(), words.begin(), words.end());
  }
  if (is_option) return offer;
  offer.is_open = true;
  for (const CLI::App* verb : verbs_of(*at)) offer.words.push_back(verb->get_name());
  return offer;
}

std::vector<std::string> Command::own_options(const std::function<bool(const Typed&)>& wanted) const {
  std::vector<std::string> arguments;
  for (const Typed& option : typed()) {
    if (!shapes_analysis(option) || (wanted && !wanted(option))) continue;
    if (option.is_flag) {
      arguments.push_back(option.values.front() == "false" ? "--no-" + option.name.substr(2) : option.name);
      continue;
    }
    for (const std::string& value : option.values) arguments.insert(arguments.end(), {option.name, value});
  }
  return arguments;
}

ExitStatus run_program(const Program& program, int argc, char** argv,
                       const std::function<void(const Command&)>& setup) {
  CLI::App app(program.description, program.name);
  app.footer(program.footer);
  app.formatter(std::make_shared<FoldedHelp>());
  app.get_formatter()->column_width(kHelpColumn);
  app.set_version_flag("--version", program.version, "Print the version and exit");
  ExitStatus status = ExitStatus::done;
  setup(Command(app, status));
  try {
    std::vector<const char*> words(argv, argv + argc);
    // A subject may have the name of a verb, which the parser would take it for.
    if (argc == 3 && std::string_view(argv[1]) == "help" && argv[2][0] != '-') words.insert(words.begin() + 2, "--");
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ExtrasError& error) {
    return wrong_usage(app, error.what() + nearest_option(app, error.what()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return wrong_usage(app, error.what());
    app.exit(error);  // prints help or version
  } catch (const UsageError& error) {
    return wrong_usage(app, error.what());
  }
  return status;
}

void parse_words(std::vector<std::string> words, const std::function<void(const Command&)>& setup) {
  CLI::App app;
  ExitStatus ignored = ExitStatus::done;
  const Command command(app, ignored);
  setup(command);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
    command.read_options();
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
}
