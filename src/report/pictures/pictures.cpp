#include "tribofit/report/pictures.hpp"

#include <set>
#include <variant>
#include <vector>

#include "output/whole_folder.hpp"
#include "report/pictures/canvas.hpp"
#include "report/pictures/draw.hpp"
#include "report/pictures/layout.hpp"

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

std::string drawn(const Chart& chart, PictureFormat format) {
  const PictureLayout layout = layout_of(chart);
  const std::string title = one_line(chart.title);
  const auto canvas = format == PictureFormat::svg ? make_svg(kPictureWidth, layout.height, title)
                                                   : make_cairo(format, kPictureWidth, layout.height, title);
  draw_chart(chart, layout, *canvas);
  return canvas->finish();
}

std::string caption_of(const Picture& picture, PictureFormat format) {
  const Chart& chart = *picture.chart;
  return picture.name + "." + name_of(format) + "\n" + one_line(chart.title) + "\n" +
         (chart.note.empty() ? "" : one_line(chart.note) + "\n");
}

}  // namespace

std::string name_of(PictureFormat format) {
  return format == PictureFormat::svg ? "svg" : format == PictureFormat::pdf ? "pdf" : "png";
}

bool can_write_pictures(PictureFormat format) {
  return format == PictureFormat::svg || has_cairo();
}

PictureFiles::PictureFiles(const Report& report, const std::string& folder, PictureFormat format) {
  const std::vector<Picture> pictures = pictures_of(report);
  std::vector<std::string> files;
  for (const Picture& picture : pictures) files.push_back(drawn(*picture.chart, format));
  folder_ = std::make_unique<WholeFolder>(folder);  // no folder while drawing may still fail or be stopped
  std::string captions = pictures.empty() ? "There is no chart to draw: " + one_line(report.lead) + "\n" : "";
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    folder_->add(pictures[k].name + "." + name_of(format)).write(files[k]);
    captions += (k > 0 ? "\n" : "") + caption_of(pictures[k], format);
  }
  folder_->add("figures.txt").write(captions);
  folder_->finish();
}

PictureFiles::~PictureFiles() = default;
PictureFiles::PictureFiles(PictureFiles&&) noexcept = default;
PictureFiles& PictureFiles::operator=(PictureFiles&&) noexcept = default;

void PictureFiles::commit() {
  folder_->commit();
}

void write_pictures(const Report& report, const std::string& folder, PictureFormat format) {
  PictureFiles(report, folder, format).commit();
}

}  // namespace tribofit
