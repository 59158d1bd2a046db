#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tribofit/ingest/units.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// How `identify` ends; the help states the same.
enum class ExitStatus {
  done = 0,
  failed = 1,       ///< the data were read but the analysis could not be done, or one of several traces failed
  wrong_usage = 2,  ///< the command line cannot be meant
  bad_input = 3,    ///< a file cannot be read or is invalid
};

/// The worse of two.
inline ExitStatus worse(ExitStatus a, ExitStatus b) {
  return a < b ? b : a;
}

/// The command line cannot be meant: what is wrong, in one sentence.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Sections of the help. They say what an option is for, too: what shapes the analysis is repeated in the commands that
/// a result names.
namespace section {
inline constexpr const char *kConditions = "Conditions", *kReading = "Reading", *kOutput = "Output", *kBatch = "Batch",
                            *kTogether = "Runs together", *kMeans = "What can be done", *kServer = "Server",
                            *kStudy = "Study", *kFit = "Law and fit", *kSpring = "Mass on a spring",
                            *kSteps = "Velocity steps and holds",
                            *kRig = "Rig (default: the published test of the nearest radius, 4 rpm, 50 N)",
                            *kFriction = "Friction (default: the published values at the nearest radius)",
                            *kDrive = "Motion of the disc, load and temperature", *kScatter = "Scatter of break-away",
                            *kSensors = "Sensors";
}

/// One option of a command. It is filled in when the command line is parsed.
class Option {
 public:
  explicit Option(CLI::Option* parsed) : parsed_(parsed) {}

  Option required() const;
  Option describe(const char* help) const;
  Option one_of(const std::vector<std::string>& words) const;
  /// T: int or double.
  template <class T>
  Option range(T least, T most) const;

 private:
  CLI::Option* parsed_;
};

/// How a number is typed.
struct TypedNumber {
  tribofit::Quantity quantity = tribofit::Quantity::dimensionless;
  const char* otherwise = "";  ///< what holds unless it is typed, which the help shows; empty: nothing
  bool is_positive = false;    ///< it must be greater than zero
};
constexpr TypedNumber positive(tribofit::Quantity quantity, const char* otherwise = "") {
  return {quantity, otherwise, true};
}

/// A command line of `identify`, or of one of its verbs: options, help, and what it runs.
///
/// The one place that knows the parser (CLI11): command.cpp. Its headers take 8 s to compile.
class Command {
 public:
  Command(CLI::App& app, ExitStatus& status);

  /// footer: what stands below the options in the help of the verb.
  Command add_verb(const char* name, const char* help, const char* footer = "") const;
  /// The same command; what is added to it stands in that section of the help.
  Command in(const char* section) const;
  /// The verb that a word is likely to mean; empty where it is like none.
  std::string likely_verb(const std::string& word) const;
  void narrow_help() const;
  /// The verb has kinds of its own; `advice` is the usage error where none is named.
  void requires_kind(const char* advice) const;

  /// T: text, a number, or a list of texts, one value each time it is given.
  template <class T>
  Option add_option(const std::string& names, T& value, const std::string& help) const;
  /// Names that stand for themselves, as many as there are.
  Option add_names(const std::string& name, std::vector<std::string>& values, const std::string& help) const;
  /// names: "--trim,!--no-trim" has a negative form.
  Option add_flag(const std::string& names, bool& value, const std::string& help) const;
  Option option(const char* name) const;

  /// What reads a text: it throws UsageError or tribofit::InputError.
  using Read = std::function<void(const std::string&)>;
  /// An option whose text is read when all are parsed, before the verb runs, in the order in which they were added.
  /// otherwise: what is read unless it is typed, which the help shows.
  Option add_read(const std::string& names, Read read, const std::string& help,
                  const std::string& otherwise = "") const;
  /// The same of one that may be given several times.
  Option add_each(const std::string& names, Read read, const std::string& help) const;
  /// A number with a unit, in SI. name: as messages have it.
  Option add_number(const std::string& name, const TypedNumber& how, std::function<void(double)> take,
                    const std::string& help) const;
  template <class T>
  Option add_number(const std::string& name, const TypedNumber& how, T& value, const std::string& help) const {
    return add_number(
        name, how, [&value](double number) { value = number; }, help);
  }
  /// One of a few words, each of which stands for a value.
  template <class T>
  Option add_choice(const std::string& name, T& value, const std::vector<std::pair<std::string, T>>& choices,
                    const std::string& help) const {
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    const auto read = [&value, choices](const std::string& text) {
      for (const auto& [word, meaning] : choices) value = word == text ? meaning : value;
    };
    return add_read(name, read, help).one_of(words);
  }

  /// What it does once its options are read, with its exit status unless that is always done. Not called where a verb
  /// of it is named.
  template <class Run>
  void on_run(Run run) const {
    run_later([run] {
      if constexpr (std::is_void_v<decltype(run())>) {
        run();
        return ExitStatus::done;
      } else {
        return run();
      }
    });
  }
  /// Reads what add_read() and its like hold; on_run() does. Usage error: an option that is given an empty value.
  void read_options() const;
  /// Called with the name of the verb before that runs.
  void before_verb(std::function<void(const std::string& verb)> check) const;

  /// An option as it was typed.
  struct Typed {
    std::string name;
    std::vector<std::string> values;  ///< of a flag: "true" or "false"
    bool is_flag = false, is_positional = false;
    std::string section;
  };
  std::vector<Typed> typed() const;
  /// Keeps that when all are read.
  void keep_typed(std::vector<Typed>& out) const;

  /// Of this command the empty text, then each verb and the verbs of each: "study speed".
  std::vector<std::string> verbs() const;
  /// What may be typed where these words stand before it: words of an option or verbs; as an option, if that has begun.
  struct Offer {
    std::vector<std::string> words;
    bool is_open = false;  ///< a file may stand there, too
  };
  Offer offer_after(const std::vector<std::string>& before, bool is_option) const;

  /// The options as typed that shape the analysis, for the next command; where `wanted` is given, those of them.
  std::vector<std::string> own_options(const std::function<bool(const Typed&)>& wanted = {}) const;

 private:
  Option added(CLI::Option* option) const;
  void run_later(std::function<ExitStatus()> run) const;

  CLI::App* app_;
  ExitStatus* status_;
  const char* section_ = nullptr;
  std::shared_ptr<std::vector<std::function<void()>>> readers_;
};

/// Parses a command line and runs what it names. setup: adds options and verbs. Usage errors are printed; what a verb
/// throws else is thrown on.
struct Program {
  const char* name;
  const char* description;
  const char* footer;
  std::string version;
};
ExitStatus run_program(const Program& program, int argc, char** argv, const std::function<void(const Command&)>& setup);

/// Reads words by the options that setup adds; throws UsageError where they do not fit.
void parse_words(std::vector<std::string> words, const std::function<void(const Command&)>& setup);
