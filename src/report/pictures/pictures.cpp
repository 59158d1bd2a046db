#include "tribofit/report/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "output/whole_folder.hpp"
#include "report/pictures/picture.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

/// The name of a chart's file, without the ending: safe, and its own.
std::string free_name(std::string id, std::set<std::string>& taken) {
  std::ranges::replace_if(
      id, [](unsigned char c) { return c >= 0x80 || (!std::isalnum(c) && c != '_'); }, '-');
  std::string name = id;
  for (int k = 2; !taken.insert(name).second; ++k) name = id + "-" + std::to_string(k);
  return name;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// The chunk pHYs, which says how large a dot is: 600 of them an inch, 23622 a metre, across and along.
std::string with_dots_per_metre(std::string png) {
  static_assert(kPicturePixelsPerInch == 600);
  constexpr std::string_view kDots("\x00\x00\x00\x09pHYs\x00\x00\x5C\x46\x00\x00\x5C\x46\x01\x14\x94\x43\x41", 21);
  constexpr std::size_t kAfterHeader = 33;  // signature and IHDR
  return png.size() > kAfterHeader ? png.insert(kAfterHeader, kDots) : png;
}

/// An SVG as PDF or PNG, drawn by rsvg-convert. Throws InputError where it cannot be drawn.
std::string converted(const std::string& svg, PictureFormat format) {
  const File picture(std::tmpfile(), &std::fclose);
  std::string out;
  int status = -1;
  if (picture && std::fputs(svg.c_str(), picture.get()) >= 0 && std::fflush(picture.get()) == 0) {
    const int dpi = format == PictureFormat::pdf ? 72 : kPicturePixelsPerInch;
    const std::string command = fmt::format("rsvg-convert --format={0} --dpi-x={1} --dpi-y={1} /dev/fd/{2}",
                                            name_of(format), dpi, ::fileno(picture.get()));
    File made(::popen(command.c_str(), "r"), &::pclose);
    std::array<char, 1 << 16> part;
    for (std::size_t count = 1; made && count > 0; out.append(part.data(), count))
      count = std::fread(part.data(), 1, part.size(), made.get());
    if (made) status = ::pclose(made.release());
  }
  if (status != 0) throw InputError("rsvg-convert cannot draw the pictures", "write them as SVG (--format svg)");
  return format == PictureFormat::pdf ? out : with_dots_per_metre(std::move(out));
}

}  // namespace

std::string name_of(PictureFormat format) {
  return format == PictureFormat::svg ? "svg" : format == PictureFormat::pdf ? "pdf" : "png";
}

bool can_write_pictures(PictureFormat format) {
  static const bool can_convert = std::system("rsvg-convert --version >/dev/null 2>&1") == 0;
  return format == PictureFormat::svg || can_convert;
}

PictureFiles::PictureFiles(const Report& report, const std::string& folder, PictureFormat format) {
  std::set<std::string> taken;
  std::vector<std::pair<std::string, std::string>> files;
  std::string captions;
  for (const ReportSection& section : report.sections) {
    for (const ReportItem& item : section.items) {
      const Chart* chart = std::get_if<Chart>(&item);
      if (chart == nullptr || chart->panels.empty()) continue;
      const std::string name = free_name(chart->id, taken) + "." + name_of(format), title = one_line(chart->title);
      const std::string svg = drawn(*chart);
      files.emplace_back(name, format == PictureFormat::svg ? svg : converted(svg, format));
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

}  // namespace tribofit
