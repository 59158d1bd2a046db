#include "tribofit/report/pictures.hpp"

#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "output/whole_folder.hpp"
#include "report/pictures/draw.hpp"

namespace tribofit {
namespace {

/// The name of a chart's file, without the ending: safe, and its own.
std::string free_name(const Chart& chart, std::set<std::string>& taken) {
  std::string id;
  for (const char c : chart.id) {
    const bool safe = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    id += safe ? c : '-';
  }
  if (id.empty()) id = "chart";
  std::string name = id;
  for (int k = 2; !taken.insert(name).second; ++k) name = id + "-" + std::to_string(k);
  return name;
}

}  // namespace

std::string name_of(PictureFormat format) {
  return format == PictureFormat::svg ? "svg" : format == PictureFormat::pdf ? "pdf" : "png";
}

bool can_write_pictures(PictureFormat format) {
  return format == PictureFormat::svg || can_convert();
}

PictureFiles::PictureFiles(const Report& report, const std::string& folder, PictureFormat format) {
  std::set<std::string> taken;
  std::vector<std::pair<std::string, std::string>> files;
  std::string captions;
  for (const ReportSection& section : report.sections) {
    for (const ReportItem& item : section.items) {
      const Chart* chart = std::get_if<Chart>(&item);
      if (chart == nullptr || chart->panels.empty()) continue;
      const std::string name = free_name(*chart, taken) + "." + name_of(format), title = one_line(chart->title);
      const std::string svg = drawn(*chart);
      files.emplace_back(name, format == PictureFormat::svg ? svg : converted(svg, format, title));
      captions += (captions.empty() ? "" : "\n") + name + "\n" + title + "\n";
      if (!chart->note.empty()) captions += one_line(chart->note) + "\n";
    }
  }
  if (files.empty()) captions = "There is no chart to draw: " + one_line(report.lead) + "\n";
  folder_ = std::make_shared<WholeFolder>(folder);  // no folder while drawing may still fail or be stopped
  for (const auto& [name, file] : files) folder_->add(name).write(file);
  folder_->add("figures.txt").write(captions);
  folder_->finish();
}

void PictureFiles::commit() {
  folder_->commit();
}

void write_pictures(const Report& report, const std::string& folder, PictureFormat format) {
  PictureFiles(report, folder, format).commit();
}

}  // namespace tribofit
