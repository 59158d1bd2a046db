#include "tribofit/report/page.hpp"

#include <string_view>

#include "page_parts.hpp"
#include "report/charts/report_json.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

std::string assembled(const std::string& title, const Json& data) {
  const PageParts parts = page_parts();
  if (parts.head.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  std::string text;
  // No name in a string ends the script element or begins a comment.
  for (const char c : line_of(data)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  constexpr std::size_t kPage = std::size_t{1} << 21;
  std::string page;
  page.reserve(kPage + text.size());
  for (const std::string_view piece : parts.head) page += piece;
  page += escaped(title);
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
