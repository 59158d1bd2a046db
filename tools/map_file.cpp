#include "map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
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

[[noreturn]] void refuse_writing(const std::string& path, const std::string& advice) {
  throw InputError(std::string("cannot be written: ") + std::strerror(errno), advice, {path, 0, ""});
}

}  // namespace

MapFile::MapFile(const std::string& folder, const MapRequest& request, bool again)
    : request_(request), done_(request.y.values.size(), false), rows_(request.y.values.size()) {
  if (folder.empty()) return;
  const auto refuse = [](const std::string& problem, const std::string& advice, const std::string& path) {
    throw InputError(problem, advice, {path, 0, ""});
  };
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) refuse("the folder cannot be made: " + error.message(), "name a folder you may write to", folder);
  rows_path_ = folder + "/map.rows";
  map_path_ = folder + "/map.csv";
  if (std::filesystem::is_directory(map_path_))
    refuse("is a folder, but the table would be written there", "name another folder", map_path_);
  if (!again && std::filesystem::exists(map_path_))
    refuse("a map exists here already", "name another folder, or replace it with --again", map_path_);
  const std::string head = head_of(request) + "\n";
  if (!again && std::filesystem::exists(rows_path_)) read_known(head);
  std::string text = head;
  for (std::size_t row = 0; row < rows_.size(); ++row) text += done_[row] ? text_of(row) : "";
  write_whole(rows_path_, text);  // without a row that was cut off
  out_.open(rows_path_, std::ios::binary | std::ios::app);
  if (!out_) refuse_writing(rows_path_, "name a folder you may write to");
}

/// Rows of map.rows that are whole and of this map.
void MapFile::read_known(const std::string& head) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
  const std::string text = text_of_file(rows_path_, kMost, "name another folder");
  if (!text.starts_with(head)) return;
  for (std::size_t at = head.size(); text.compare(at, 4, "row ") == 0;) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) return;
    std::size_t row = 0;
    const auto [last, error] = std::from_chars(text.data() + at + 4, text.data() + end, row);
    if (error != std::errc{} || last != text.data() + end || row >= rows_.size()) return;
    at = std::min(text.find("row ", end), text.size());
    std::vector<MapCell> cells = map_row_from_csv(request_, row, text.substr(end + 1, at - end - 1));
    if (cells.empty()) continue;
    rows_[row] = std::move(cells);
    done_[row] = true;
  }
}

std::size_t MapFile::known_count() const {
  return static_cast<std::size_t>(std::count(done_.begin(), done_.end(), true));
}

std::string MapFile::text_of(std::size_t row) const {
  return fmt::format("row {}\n", row) + map_csv_row(request_, row, rows_[row]);
}

void MapFile::add(std::size_t row, const std::vector<MapCell>& cells) {
  rows_[row] = cells;
  done_[row] = true;
  if (!out_.is_open()) return;
  out_ << text_of(row) << std::flush;
  if (!out_) refuse_writing(rows_path_, "free some space and start again: the rows written so far are kept");
}

void MapFile::finish() {
  if (map_path_.empty()) return;
  std::string text = map_csv_header(request_);
  for (std::size_t row = 0; row < rows_.size(); ++row) text += map_csv_row(request_, row, rows_[row]);
  write_whole(map_path_, text);
  out_.close();
  std::filesystem::remove(rows_path_);
}
