#include "tribofit/report/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "report/charts/gnuplot.hpp"
#include "report/charts/gnuplot_process.hpp"
#include "report/charts/gnuplot_text.hpp"
#include "report/whole_folder.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

struct Picture {
  std::string name;  ///< of its file, without the ending
  const Chart* chart;
};

/// Charts of a report, each with a name of its own that is safe as one of a file.
std::vector<Picture> pictures_of(const Report& report) {
  std::vector<Picture> pictures;
  std::set<std::string> taken;
  for (const ReportSection& section : report.sections) {
    for (const ReportItem& item : section.items) {
      const Chart* chart = std::get_if<Chart>(&item);
      if (chart == nullptr || chart->panels.empty()) continue;
      std::string id;
      for (const char c : chart->id) {
        const bool safe = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        id += safe ? c : '-';
      }
      if (id.empty()) id = "chart";
      std::string name = id;
      for (int k = 2; !taken.insert(name).second; ++k) name = id + "-" + std::to_string(k);
      pictures.push_back({name, chart});
    }
  }
  return pictures;
}

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

void replace_first(std::string& text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  if (at != std::string::npos) text.replace(at, old.size(), by);
}

/// gnuplot gives its size in pixels and names that a viewer shows under the pointer: instead the size on paper and the
/// title of the chart. Names from the data cannot be taken for these: their '<' is escaped.
std::string finished_svg(std::string svg, const Chart& chart, int height) {
  const int width = terminal_width(PictureFormat::svg);
  replace_first(svg, fmt::format("width=\"{}\" height=\"{}\"", width, height),
                fmt::format("width=\"{}mm\" height=\"{:.2f}mm\"", kPictureWidth, height * kPictureWidth / width));
  replace_first(svg, "<title>Gnuplot</title>", "<title>" + xml_escaped(one_line(chart.title)) + "</title>");
  const std::string begin = "<title>gnuplot_plot_", end = "</title>";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at)) {
    svg.erase(at, svg.find(end, at) + end.size() - at);
  }
  return svg;
}

/// The chunk pHYs, which says how large a dot is: 600 of them an inch, 23622 a metre, across and along.
std::string finished_png(std::string png) {
  static_assert(kPicturePixelsPerInch == 600);
  constexpr std::string_view kDots("\x00\x00\x00\x09pHYs\x00\x00\x5C\x46\x00\x00\x5C\x46\x01\x14\x94\x43\x41", 21);
  constexpr std::size_t kAfterHeader = 33;  // signature and IHDR
  if (png.size() > kAfterHeader) png.insert(kAfterHeader, kDots);
  return png;
}

std::string finished(std::string written, const Chart& chart, PictureFormat format) {
  switch (format) {
    case PictureFormat::svg:
      return finished_svg(std::move(written), chart, terminal_height(layout_of(chart), format));
    case PictureFormat::pdf:
      return written;
    case PictureFormat::png:
      return finished_png(std::move(written));
  }
  return written;
}

std::string caption_of(const Picture& picture, PictureFormat format) {
  const Chart& chart = *picture.chart;
  return picture.name + "." + name_of(format) + "\n" + one_line(chart.title) + "\n" +
         (chart.note.empty() ? "" : one_line(chart.note) + "\n");
}

}  // namespace

struct PictureFiles::Files {
  explicit Files(const std::string& path) : folder(path) {}
  WholeFolder folder;
};

std::string name_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::svg:
      return "svg";
    case PictureFormat::pdf:
      return "pdf";
    case PictureFormat::png:
      return "png";
  }
  return "";
}

bool can_write_pictures() {
  return gnuplot_is_installed();
}

PictureFiles::PictureFiles(const Report& report, const std::string& folder, PictureFormat format) {
  const std::vector<Picture> pictures = pictures_of(report);
  if (pictures.empty()) throw InputError("there is no chart to draw a picture of", "leave --figures out");
  const auto write_script = [&](const std::vector<std::string>& outputs) {
    std::string script;
    for (std::size_t k = 0; k < pictures.size(); ++k) script += gnuplot_script(*pictures[k].chart, format, outputs[k]);
    return script;
  };
  std::vector<std::string> written = run_gnuplot(pictures.size(), write_script);
  files_ = std::make_unique<Files>(folder);  // no folder while gnuplot may still fail or be stopped
  std::string captions;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    files_->folder.add(pictures[k].name + "." + name_of(format))
        .write(finished(std::move(written[k]), *pictures[k].chart, format));
    captions += (k > 0 ? "\n" : "") + caption_of(pictures[k], format);
  }
  files_->folder.add("figures.txt").write(captions);
  files_->folder.finish();
}

PictureFiles::~PictureFiles() = default;
PictureFiles::PictureFiles(PictureFiles&&) noexcept = default;
PictureFiles& PictureFiles::operator=(PictureFiles&&) noexcept = default;

void PictureFiles::commit() {
  files_->folder.commit();
}

void write_pictures(const Report& report, const std::string& folder, PictureFormat format) {
  PictureFiles(report, folder, format).commit();
}

}  // namespace tribofit
