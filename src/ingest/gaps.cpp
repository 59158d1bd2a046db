#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "recording.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

bool is_usable(double value) {
  return std::abs(value) < kLargestValue;
}

[[noreturn]] void refuse(const RawTable& table, const std::vector<Column>& used, std::size_t row,
                         const FileRecord& recording) {
  const auto column =
      std::ranges::find_if(used, [&](const Column& c) { return !is_usable(table.columns[c.index].numbers[row]); });
  const InputLocation where = recording.location(row, column->channel);
  const auto& known = table.first_gap;
  if (known && known->row == row) throw InputError(known->problem, known->advice, where);
  throw InputError(
      fmt::format("'{}' is not a finite number of a usable size", general(table.columns[column->index].numbers[row])),
      "fill it in or remove the row", where);
}

}  // namespace

std::vector<std::size_t> find_gappy_rows(const RawTable& table, const std::vector<Column>& used,
                                         const FileRecord& recording) {
  std::vector<std::size_t> rows;
  for (const Column& column : used) {
    const auto& values = table.columns[column.index].numbers;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!is_usable(values[i])) rows.push_back(i);
    }
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  if (rows.empty()) return rows;
  const std::size_t all = table.columns[used.front().index].numbers.size();
  bool isolated = rows.size() * kRowsPerGap <= all;
  for (std::size_t k = kMostLostInARow; k < rows.size() && isolated; ++k) {
    isolated = rows[k] - rows[k - kMostLostInARow] > kMostLostInARow;
  }
  if (!isolated) refuse(table, used, rows.front(), recording);
  return rows;
}

std::vector<std::size_t> find_repeated_rows(const FileRecord& recording) {
  const std::vector<double>& time = recording[Channel::time];
  std::vector<std::size_t> rows;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] == time[i - 1]) rows.push_back(i);
  }
  return rows.size() * kRowsPerRepeat <= time.size() ? rows : std::vector<std::size_t>();
}

void exclude(const std::vector<std::size_t>& rows, std::string_view what, FileRecord& recording) {
  if (rows.empty()) return;
  const bool one = rows.size() == 1;
  recording.warnings.push_back(fmt::format("{} row{} {} {} left out as {} ({})", rows.size(), one ? "" : "s", what,
                                           one ? "was" : "were", one ? "a gap" : "gaps", recording.places_of(rows)));
  std::vector<bool> kept(recording.rows(), true);
  for (const std::size_t row : rows) kept[row] = false;
  LineMap lines;
  const bool has_lines = recording.lines.line_of(0) > 0;
  for (std::size_t i = 0, to = 0; has_lines && i < kept.size(); ++i) {
    if (kept[i]) lines.set(to++, recording.lines.line_of(i));
  }
  recording.lines = std::move(lines);
  for (const Channel which : recording.present()) {
    std::vector<double>& channel = recording[which];
    std::size_t to = 0;
    for (std::size_t i = 0; i < channel.size(); ++i) {
      if (kept[i]) channel[to++] = channel[i];
    }
    channel.resize(to);
  }
  for (RawStep& step : recording.stated_steps) {
    step.begin -= static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), step.begin) - rows.begin());
  }
}

void leave_out_unloaded_ends(FileRecord& recording) {
  const auto& load = recording[Channel::load];
  if (!recording.has(Channel::load) || recording.has(Channel::mu) || recording.is_points()) return;
  const auto& friction = recording[recording.has(Channel::force) ? Channel::force : Channel::torque];
  if (friction.size() != load.size()) return;
  double largest = kSmallestLoad;
  for (const double value : load) largest = std::max(largest, std::abs(value));
  const auto loaded = [&](double value) { return std::abs(value) > kLoadKnownTo * largest; };  // a zero may be off
  const auto first = std::ranges::find_if(load, loaded);
  if (first == load.end()) return;  // refused where friction is made
  auto begin = static_cast<std::size_t>(first - load.begin());
  auto end = static_cast<std::size_t>(std::find_if(load.rbegin(), load.rend(), loaded).base() - load.begin());
  const auto coefficient = [&](std::size_t from, std::size_t to) {
    double forces = 0, loads = 0;
    for (std::size_t i = from; i < to; ++i) forces += std::abs(friction[i]), loads += std::abs(load[i]);
    return loads > 0 ? forces / loads : 0;
  };
  // A low step of a programme is no end without load: it keeps its side, and friction as its load makes it.
  const double usual = coefficient(begin, end);
  const auto is_step = [&](std::size_t from, std::size_t to) {
    const auto on_side = [&](std::size_t i) { return load[i] * *first > 0; };
    for (std::size_t i = from; i < to; ++i) {
      if (!on_side(i)) return false;
    }
    return coefficient(from, to) > kFrictionOfLoad * usual;
  };
  if (is_step(0, begin)) begin = 0;
  if (is_step(end, load.size())) end = load.size();
  const std::size_t without = load.size() - (end - begin);
  if (without == 0) return;
  recording.warnings.push_back(
      fmt::format("{} of {} rows have no load, before or after the test: they take no part", without, load.size()));
  recording.keep_rows(begin, end);
}

}  // namespace tribofit
