#include "tribofit/report/page.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "page_parts.hpp"
#include "report/charts/report_json.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

/// The text with some of its characters replaced.
std::string replaced(std::string_view text, std::initializer_list<std::pair<char, std::string_view>> by) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const auto at = std::find_if(by.begin(), by.end(), [&](const auto& one) { return one.first == c; });
    if (at == by.end()) {
      out += c;
    } else {
      out += at->second;
    }
  }
  return out;
}

std::string assembled(const std::string& title, const Json& data) {
  const PageParts parts = page_parts();
  if (parts.head.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  // No name in a string ends the script element or begins a comment.
  const std::string text = replaced(line_of(data), {{'<', "\\u003c"}});
  constexpr std::size_t kPage = std::size_t{1} << 21;
  std::string page;
  page.reserve(kPage + text.size());
  for (const std::string_view piece : parts.head) page += piece;
  page += replaced(title, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}});
  for (const std::string_view piece : parts.middle) page += piece;
  page += text;
  for (const std::string_view piece : parts.tail) page += piece;
  return page;
}

}  // namespace

bool has_report_page() {
  return !page_parts().head.empty();
}

std::string report_page(const Report& report) {
  return assembled(report.title, report_json(report));
}

}  // namespace tribofit
