#include "tribofit/report/page.hpp"

#include <string_view>

#include "json_parts.hpp"
#include "page_parts.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

bool has_report_page() {
  return !page_parts().head.empty();
}

std::string report_page(const Report& report) {
  const PageParts parts = page_parts();
  if (parts.head.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  std::string data;
  // No name in a string ends the script element or begins a comment.
  for (const char c : line_of(report_json(report))) data += c == '<' ? std::string("\\u003c") : std::string(1, c);
  constexpr std::size_t kPage = std::size_t{1} << 21;
  std::string page;
  page.reserve(kPage + data.size());
  for (const std::string_view piece : parts.head) page += piece;
  page += escaped(report.title);
  for (const std::string_view piece : parts.middle) page += piece;
  page += data;
  for (const std::string_view piece : parts.tail) page += piece;
  return page;
}

}  // namespace tribofit
