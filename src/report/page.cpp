#include "tribofit/report/page.hpp"

#include <string_view>

#include "page_parts.hpp"
#include "report/charts/report_json.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// JSON that can stand within a script element: no name in it ends the element or begins a comment.
std::string embedded(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";  // stands in strings only
    } else {
      out += c;
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
  const std::string text = embedded(data);
  constexpr std::size_t kPage = std::size_t{1} << 21;
  std::string page;
  page.reserve(kPage + text.size());
  for (const std::string_view piece : parts.head) page += piece;
  page += html_escaped(title);
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
