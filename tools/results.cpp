#include "results.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "command.hpp"
#include "console.hpp"
#include "tribofit/ingest/output_tables.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"

using namespace tribofit;

namespace {

PictureFormat picture_format(const Settings& s) {
  return s.picture_format.value_or(PictureFormat::svg);
}

/// Usage error: a page that this build cannot write, or one onto another output.
void check_report(const Settings& s) {
  if (s.report.empty()) return;
  if (!has_report_page()) {
    throw UsageError(
        "--report: this build leaves the page out; build where npm is installed (scripts/setup page), or use --json or "
        "--csv");
  }
  if (s.report == s.json || same_file(s.report, s.json)) throw UsageError("--report and --json are one file");
}

/// Usage error: pictures that cannot be drawn here, or whose folder is another output.
void check_figures(const Settings& s) {
  if (s.figures.empty()) {
    if (s.picture_format) throw UsageError("--format needs --figures FOLDER");
    return;
  }
  if (s.figures == s.json || s.figures == s.report) {
    throw UsageError("--figures is a folder; name another than the file of --json or --report");
  }
  if (!can_write_pictures(picture_format(s))) {
    throw UsageError("--format " + name_of(picture_format(s)) +
                     " needs rsvg-convert; use --format svg, or install it (apt install librsvg2-bin)");
  }
}

/// Bytes of a file, or of the files in a folder.
std::uintmax_t size_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return std::filesystem::file_size(path, error);
  std::uintmax_t bytes = 0;
  for (std::filesystem::recursive_directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
    if (std::error_code ignored; at->is_regular_file(ignored)) bytes += at->file_size(ignored);
  }
  return bytes;
}

std::string size_text(std::uintmax_t bytes) {
  const double size = static_cast<double>(bytes);
  if (size < 1e3) return fmt::format("{} bytes", bytes);
  if (size < 1e6) return fixed(size / 1e3, size < 1e4 ? 1 : 0) + " kB";
  return fixed(size / 1e6, size < 1e7 ? 1 : 0) + " MB";
}

/// "wrote FILE (2.1 MB)", a line each.
std::string written(const Settings& s, bool with_csv) {
  std::string text;
  const auto add = [&](const std::string& path) {
    if (std::error_code ignored; path.empty() || !std::filesystem::exists(path, ignored)) return;
    text += (text.empty() ? "\n" : "") + written_line(path);
  };
  add(s.json), add(s.report), add(s.figures);
  if (with_csv) add(s.csv);
  return text;
}

}  // namespace

std::string written_line(const std::string& path) {
  return fmt::format("wrote {} ({})\n", printable(path), size_text(size_of(path)));
}

ReportFiles::ReportFiles(const Settings& s, const Report& report) {
  if (!s.figures.empty()) pictures_.emplace(report, s.figures, picture_format(s));
  if (s.report.empty()) return;
  page_.emplace(s.report);
  page_->write(report_page(report));
  page_->finish();
}

void ReportFiles::commit() {
  if (pictures_) pictures_->commit();
  if (page_) page_->commit();
}

void deliver(const Settings& s, const Outputs& outputs) {
  std::optional<WholeFile> json;
  if (!s.json.empty()) {
    json.emplace(s.json == "-" ? "/dev/stdout" : s.json);
    json->write(outputs.json());
    json->finish();
  }
  const bool printed = !s.quiet && s.json != "-";
  Report report;
  if (printed || !s.report.empty() || !s.figures.empty()) report = outputs.report();
  ReportFiles drawn(s, report);
  if (!s.csv.empty() && outputs.csv) outputs.csv(s.csv);
  drawn.commit();
  if (json) json->commit();
  if (printed) print(render_terminal(report, terminal_options(s, {})) + written(s, outputs.csv != nullptr));
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return a == b || std::filesystem::equivalent(a, b, ignored);
}

void refuse_overwriting(const Settings& s, const std::vector<std::string>& inputs) {
  check_report(s);
  check_figures(s);
  for (const std::string& input : inputs) {
    if (!s.report.empty() && same_file(s.report, input)) {
      throw UsageError("--report would overwrite " + input);
    }
    if (!s.json.empty() && same_file(s.json, input)) throw UsageError("--json would overwrite " + input);
    if (s.csv.empty()) continue;
    const std::filesystem::path own_folder = std::filesystem::path(s.csv) / std::filesystem::path(input).stem();
    for (const OutputTable& file : output_tables) {
      if (same_file((s.csv / std::filesystem::path(file.name)).string(), input) ||
          same_file((own_folder / file.name).string(), input)) {
        throw UsageError("--csv would overwrite " + input + " with its own " + std::string(file.name));
      }
    }
  }
}
