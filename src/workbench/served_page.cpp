#include "served_page.hpp"

#include "tribofit/report/page.hpp"
#include "tribofit/report/report.hpp"

#include <filesystem>
#include <string_view>

#include "tribofit/report/page.hpp"

namespace tribofit::workbench {

namespace {

/// The part between two marks.
std::string between(const std::string& text, std::string_view from, std::string_view to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return {};
  const std::size_t after = begin + from.size();
  return text.substr(after, text.find(to, after) - after);
}

}  // namespace

ServedPage served_page(const std::string& trace) {
  Report empty;
  empty.kind = "workbench";
  empty.title = std::filesystem::path(trace).filename().string();
  ServedPage page;
  page.html = report_page(empty);
  // A report asks nobody for anything; this page asks its own server.
  constexpr std::string_view kNothing = "default-src 'none'";
  const std::size_t at = page.html.find(kNothing);
  if (at != std::string::npos) page.html.insert(at + kNothing.size(), "; connect-src 'self'");
  page.policy =
      between(page.html, "http-equiv=\"Content-Security-Policy\" content=\"", "\"") + "; frame-ancestors 'none'";
  return page;
}

}  // namespace tribofit::workbench
