#include "console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace {

/// The length of "ESC [ ... m" at the beginning of `text`: a colour, which the report sets; 0 for anything else.
std::size_t length_of_colour(std::string_view text) {
  if (!text.starts_with("\033[")) return 0;
  const std::size_t end = text.find_first_not_of("0123456789;", 2);
  return end != std::string_view::npos && text[end] == 'm' ? end + 1 : 0;
}

/// What a terminal may be sent: control characters in the names of files and columns are spelt out.
std::string for_terminal(std::string_view text, bool with_colour) {
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t colour = with_colour ? length_of_colour(text.substr(at)) : 0;
    const bool as_it_is = colour > 0 || text[at] == '\n' || text[at] == '\t';
    const std::size_t end = as_it_is ? at + std::max<std::size_t>(colour, 1) : text.find_first_of("\033\n\t", at + 1);
    const std::string_view part = text.substr(at, std::min(end, text.size()) - at);
    shown += as_it_is ? std::string(part) : tribofit::printable(part);
    at += part.size();
  }
  return shown;
}

}  // namespace

void print(const std::string& raw) {
  static bool nobody_reads = false;
  if (nobody_reads) return;
  const std::string text = for_terminal(raw, wants_colour());
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (written) return;
  const int error = errno;
  nobody_reads = true;
  if (error == EPIPE) return;
  throw tribofit::InputError(std::string("cannot be written: ") + std::strerror(error), "send it somewhere else",
                             {"standard output", 0, ""});
}

bool wants_colour() {
  const char* terminal = std::getenv("TERM");
  const char* refused = std::getenv("NO_COLOR");
  return ::isatty(STDOUT_FILENO) == 1 && (refused == nullptr || *refused == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

bool wants_unicode() {
  const char* terminal = std::getenv("TERM");
  if (terminal != nullptr && std::string_view(terminal) == "dumb") return false;
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {  // the first that is set decides, as in POSIX
    const char* locale = std::getenv(name);
    if (locale == nullptr || *locale == '\0') continue;
    const std::string lower = tribofit::lower_case(locale);
    return lower.find("utf-8") != std::string::npos || lower.find("utf8") != std::string::npos;
  }
  return false;
}

std::size_t terminal_width() {
  if (const char* columns = std::getenv("COLUMNS")) {
    std::size_t width = 0;
    const char* end = columns + std::strlen(columns);
    const auto [last, error] = std::from_chars(columns, end, width);
    if (error == std::errc{} && last == end && width > 0) return width;
  }
  struct winsize size {};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void progress(const std::string& text) {
  if (::isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "%s\n", for_terminal(text, false).c_str());
}

ProgressLine::ProgressLine() : watched_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  end();
}

void ProgressLine::end() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

std::string time_left(double seconds) {
  const double minutes = seconds / 60;
  if (minutes < 1.5) return tribofit::fixed(std::max(1.0, seconds), 0) + " s left";
  return minutes < 90 ? tribofit::fixed(minutes, 0) + " min left" : tribofit::fixed(minutes / 60, 1) + " h left";
}

void ProgressLine::show(std::string_view words, double part) {
  constexpr std::size_t kBar = 20;
  if (!watched_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  part = std::clamp(part, 0.0, 1.0);
  std::string what = tribofit::printable(words);
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const bool says_time = what.find(" left") != std::string::npos;
  if (!says_time && elapsed > 1 && part > 0.02) what += "; " + time_left(elapsed * (1 - part) / part);
  std::string bar(static_cast<std::size_t>(part * kBar), '#');
  bar.resize(kBar, '-');
  const std::size_t before = kBar + 10;
  const std::size_t width = std::max<std::size_t>(terminal_width(), before + 10);
  const std::size_t room = width - before;  // a line that wraps cannot be rewritten
  std::fprintf(stderr, "\r\033[K[%s] %3d %%  %.*s", bar.c_str(), static_cast<int>(100 * part),
               static_cast<int>(std::min(what.size(), room)), what.data());
  std::fflush(stderr);
  shown_ = true;
}

std::size_t letters_in(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::size_t prose_width() {
  constexpr std::size_t kNarrowest = 80, kWidest = 120;
  return std::clamp(terminal_width(), kNarrowest, kWidest);
}

std::string folded(const std::string& sentence, std::size_t indent) {
  const std::size_t width = prose_width();
  std::string out;
  std::size_t column = 0;
  for (std::size_t at = 0; at < sentence.size();) {
    const std::size_t end = std::min(sentence.find(' ', at), sentence.size());
    const std::string_view word = std::string_view(sentence).substr(at, end - at);
    const std::size_t length = letters_in(word);
    if (column > indent && column + 1 + length > width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (at > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += length;
    at = end + 1;
  }
  return out;
}

void print_error(const std::string& text) {
  std::fprintf(stderr, "identify: error: %s\n", for_terminal(text, false).c_str());
}
