#include "tribofit/report/report.hpp"

#include <string_view>

#include "json_parts.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

/// The page with @TITLE@ and @DATA@ in their places (page/assemble.mjs); empty in a build without it.
std::string_view page_template();

bool has_report_page() {
  return !page_template().empty();
}

std::string report_page(const Report& report) {
  std::string page(page_template());
  if (page.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  std::string data;
  // No name in a string ends the script element or begins a comment.
  for (const char c : line_of(report_json(report))) data += c == '<' ? std::string("\\u003c") : std::string(1, c);
  for (const auto& [mark, text] : {std::pair("@DATA@", data), std::pair("@TITLE@", escaped(report.title))}) {
    page.replace(page.find(mark), std::string_view(mark).size(), text);
  }
  return page;
}

}  // namespace tribofit
