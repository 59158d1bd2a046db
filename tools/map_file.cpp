#include "map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/report/study.hpp"
#include "tribofit/version.hpp"

using namespace tribofit;

namespace {

/// What the rows depend on, to the last digit.
std::string head_of(const MapRequest& request) {
  const Machine& m = request.machine;
  std::string text = fmt::format("# identify {} map of settled motion; m={} c={} k={} N={} r={} w={} law={}", version,
                                 m.rig.mass, m.rig.damping, m.rig.stiffness, m.load, m.radius, m.speed, m.model.name());
  for (const double p : m.parameters) text += fmt::format(" {}", p);
  text += fmt::format("; sharpness={} start={}", request.settle.sharpness, static_cast<int>(request.settle.start));
  for (const MapAxis* axis : {&request.x, &request.y}) {
    text += fmt::format("; {}={}..{}:{}", axis->variable.name, axis->values.front(), axis->values.back(),
                        axis->values.size());
  }
  for (const Effect& effect : m.model.effects()) text += "; " + describe(effect).equation;
  return text;
}

std::string read_all(const std::string& path) {
  if (!std::filesystem::exists(path)) return {};
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
  return text_of_file(path, kMost, "name another folder");
}

}  // namespace

MapFile::MapFile(const std::string& folder, const MapRequest& request, bool again) : request_(request) {
  done_.assign(request.y.values.size(), false);
  rows_.resize(request.y.values.size());
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("the folder cannot be made: " + error.message(), "name a folder you may write to",
                     {folder, 0, ""});
  rows_path_ = folder + "/map.rows";
  map_path_ = folder + "/map.csv";
  if (std::filesystem::is_directory(map_path_)) {
    throw InputError("is a folder, but the table would be written there", "name another folder", {map_path_, 0, ""});
  }
  if (!again && std::filesystem::exists(map_path_)) {
    throw InputError("a map exists here already", "name another folder, or replace it with --again",
                     {map_path_, 0, ""});
  }
  head_ = head_of(request);
  if (!again) read_known();
  std::string text = head_ + "\n";
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    if (done_[row]) text += fmt::format("row {}\n", row) + map_csv_row(request_, row, rows_[row]);
  }
  write_whole(rows_path_, text);  // without a row that was cut off
  out_.open(rows_path_, std::ios::binary | std::ios::app);
  if (!out_)
    throw InputError(std::string("cannot be written: ") + std::strerror(errno), "name a folder you may write to",
                     {rows_path_, 0, ""});
}

/// Rows of map.rows that are whole and of this map.
void MapFile::read_known() {
  const std::string text = read_all(rows_path_);
  if (text.compare(0, head_.size() + 1, head_ + "\n") != 0) return;
  std::size_t at = head_.size() + 1;
  while (text.compare(at, 4, "row ") == 0) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) return;
    const std::string number = text.substr(at + 4, end - at - 4);
    if (number.empty() || number.size() > 6 || number.find_first_not_of("0123456789") != std::string::npos) return;
    const std::size_t row = std::stoul(number);
    const std::size_t next = std::min(text.find("row ", end), text.size());
    if (row >= rows_.size()) return;
    std::vector<MapCell> cells = map_row_from_csv(request_, row, text.substr(end + 1, next - end - 1));
    if (!cells.empty()) {
      rows_[row] = std::move(cells);
      done_[row] = true;
    }
    at = next;
  }
}

std::size_t MapFile::known_count() const {
  return static_cast<std::size_t>(std::count(done_.begin(), done_.end(), true));
}

void MapFile::write(const std::string& text) {
  out_ << text << std::flush;
  if (!out_)
    throw InputError(std::string("cannot be written: ") + std::strerror(errno),
                     "free some space and start again: the rows written so far are kept", {rows_path_, 0, ""});
}

void MapFile::add(std::size_t row, const std::vector<MapCell>& cells) {
  rows_[row] = cells;
  done_[row] = true;
  if (out_.is_open()) write(fmt::format("row {}\n", row) + map_csv_row(request_, row, cells));
}

void MapFile::finish() {
  if (map_path_.empty()) return;
  std::string text = map_csv_header(request_);
  for (std::size_t row = 0; row < rows_.size(); ++row) text += map_csv_row(request_, row, rows_[row]);
  write_whole(map_path_, text);
  out_.close();
  std::filesystem::remove(rows_path_);
}
