#include "commands.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "terminal_text.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

std::string shell_quoted(const std::string& argument) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  if (printable(argument) != argument) {  // bash, zsh and ksh read these
    return "$'" + printable(replaced(replaced(argument, "\\", "\\\\"), "'", "\\'")) + "'";
  }
  return "'" + replaced(argument, "'", "'\\''") + "'";
}

std::string command_line(const std::vector<std::string>& words, const std::vector<std::string>& inputs) {
  std::string text = "identify";
  for (const std::string& word : words) text += " " + shell_quoted(word);
  for (const std::string& input : inputs) text += " " + shell_quoted(input.rfind('-', 0) == 0 ? "./" + input : input);
  return text;
}

std::vector<std::string> words_of(std::vector<std::string> words, const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& dropped) {
  const auto is_dropped = [&](const std::string& word) {
    return std::find(dropped.begin(), dropped.end(), word) != dropped.end();
  };
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (is_dropped(arguments[k] + "=")) {
      ++k;
    } else if (!is_dropped(arguments[k])) {
      words.push_back(arguments[k]);
    }
  }
  return words;
}

std::string diagnose_command(const std::vector<std::string>& arguments, const std::string& path) {
  return command_line(words_of({"diagnose"}, arguments, {"--profile", "--protocol="}), {path});
}

void add_ways_to_look(const std::string& verb, const std::string& path, const ReportOptions& options, Report& report) {
  if (!has_report_page()) return;
  if (!options.report_written) {
    const std::string page = std::filesystem::path(path).stem().string() + ".html";
    const std::vector<std::string> words = words_of({}, options.arguments);
    report.next.push_back(
        {"to see it as a page of charts",
         command_line(joined(verb.empty() ? words : joined({verb}, words), {"--report", page}), {path})});
  }
  const std::vector<std::string> other_verbs = {"--profile", "--protocol=", "--confirm=", "--time-limit="};
  report.next.push_back({"to switch effects on and off in a browser",
                         command_line(words_of({"explore"}, options.arguments, other_verbs), {path})});
}

Suggestion first_of(std::initializer_list<NextStep> steps) {
  const auto next = std::find_if(steps.begin(), steps.end(), [](const NextStep& step) { return step.is_next; });
  return next == steps.end() ? Suggestion{} : Suggestion{next->reason, next->command};
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

bool has_option(const std::vector<std::string>& arguments, const std::string& name) {
  return std::any_of(arguments.begin(), arguments.end(),
                     [&](const std::string& a) { return a == name || a.rfind(name + "=", 0) == 0; });
}

std::string csv_folder_for(const std::string& path) {
  return std::filesystem::path(path).stem().string() + "-csv";
}

std::string folded_command(const std::string& command, std::size_t width) {
  constexpr char kNoBreak = '\x1f';
  std::string text = command;
  bool quoted = false;
  std::size_t begin = 0;  // of a word; one in quotes is whole, and an option stays with its value
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (text[i] != ' ') continue;
    const std::string_view word = std::string_view(text).substr(begin, i - begin);
    const bool waits = word.starts_with("--") && word.find(kNoBreak) == word.npos && text[i + 1] != '-';
    text[i] = quoted || waits ? kNoBreak : ' ';
    if (text[i] == ' ') begin = i + 1;
  }
  // The first line, which begins with "identify", stands four columns further left than the others.
  text = "  " + text.substr(0, 4) + replaced(wrapped(text.substr(4), width - 2, 6), "\n", " \\\n");
  std::replace(text.begin(), text.end(), kNoBreak, ' ');
  return text;
}

}  // namespace tribofit
