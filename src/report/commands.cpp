#include "commands.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "terminal_text.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/report/page.hpp"

namespace tribofit {
namespace {

/// The words of a command; a quoted one stays whole.
std::vector<std::string> split_command(const std::string& command) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char c : command) {
    if (c == '\'') quoted = !quoted;
    if (c == ' ' && !quoted) {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string shell_quoted(const std::string& argument) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(argument.begin(), argument.end(), is_control)) {  // bash, zsh and ksh read these
    const std::string escaped = replaced(replaced(argument, "\\", "\\\\"), "'", "\\'");
    return "$'" + printable(escaped) + "'";
  }
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string command_line(const std::vector<std::string>& words, const std::vector<std::string>& inputs) {
  std::string text = "identify";
  for (const std::string& word : words) text += " " + shell_quoted(word);
  for (const std::string& input : inputs) text += " " + shell_quoted(input.rfind('-', 0) == 0 ? "./" + input : input);
  return text;
}

std::string command_line(const ReportOptions& options, const std::vector<std::string>& more, const std::string& path) {
  return command_line(joined(options.arguments, more), {path});
}

std::vector<std::string> words_of(std::vector<std::string> words, const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& flags, const std::vector<std::string>& valued) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (contains(valued, arguments[k])) {
      ++k;
    } else if (!contains(flags, arguments[k])) {
      words.push_back(arguments[k]);
    }
  }
  return words;
}

std::string diagnose_command(const std::vector<std::string>& arguments, const std::string& path) {
  return command_line(words_of({"diagnose"}, arguments, {"--profile"}, {"--protocol"}), {path});
}

std::vector<Suggestion> ways_to_look(const std::string& verb, const std::vector<std::string>& arguments,
                                     const std::string& path, bool report_written) {
  if (!has_report_page()) return {};
  const std::vector<std::string> begin = verb.empty() ? std::vector<std::string>{} : std::vector{verb};
  const std::string page = std::filesystem::path(path).stem().string() + ".html";
  std::vector<Suggestion> ways;
  if (!report_written) {
    ways.push_back({"to see it as a page of charts",
                    command_line(joined(words_of(begin, arguments), {"--report", page}), {path})});
  }
  ways.push_back(
      {"to switch effects on and off in a browser",
       command_line(words_of({"explore"}, arguments, {"--profile"}, {"--protocol", "--confirm", "--time-limit"}),
                    {path})});
  return ways;
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
  constexpr std::size_t kIndent = 2, kContinued = 6;
  std::string text(kIndent, ' ');
  std::size_t column = kIndent;
  std::vector<std::string> parts;  // an option stays with its value
  for (const std::string& word : split_command(command)) {
    if (!parts.empty() && parts.back().starts_with("--") && parts.back().find(' ') == std::string::npos &&
        !word.starts_with("-")) {
      parts.back() += " " + word;
    } else {
      parts.push_back(word);
    }
  }
  for (const std::string& word : parts) {
    const bool first = column == kIndent;
    const std::size_t length = displayed(word);
    if (!first && column + 1 + length + 2 > width) {
      text += " \\\n" + std::string(kContinued, ' ') + word;
      column = kContinued + length;
      continue;
    }
    text += (first ? "" : " ") + word;
    column += length + (first ? 0 : 1);
  }
  return text;
}

}  // namespace tribofit
