#include "gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

bool is_usable(double value) {
  return std::abs(value) < kLargestValue;
}

[[noreturn]] void refuse(const RawTable& table, const std::vector<Column>& used, std::size_t row,
                         const FileRecord& recording) {
  const auto column = std::find_if(used.begin(), used.end(),
                                   [&](const Column& c) { return !is_usable(table.columns[c.index].numbers[row]); });
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
  bool isolated = rows.size() * kRowsPerLostRow <= all;
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
  constexpr std::size_t most_shown = 12;
  std::vector<std::string> places;
  for (const std::size_t row : rows) {
    if (places.size() == most_shown) {
      places.emplace_back("...");
      break;
    }
    const InputLocation where = recording.location(row, Channel::time);
    places.push_back(std::to_string(where.line > 0 ? where.line : where.value));
  }
  const char* plural = rows.size() == 1 ? "" : "s";
  const char* unit = recording.location(rows.front(), Channel::time).line > 0 ? "line" : "value";
  recording.warnings.push_back(fmt::format("{} row{} {} {} left out as {} ({}{} {})", rows.size(), plural, what,
                                           rows.size() == 1 ? "was" : "were", rows.size() == 1 ? "a gap" : "gaps", unit,
                                           plural, listed(places)));
  std::size_t size = 0;
  for (const Channel which : recording.present()) {
    std::vector<double>& channel = recording[which];
    size = channel.size();
    std::size_t to = rows.front(), next = 0;
    for (std::size_t i = to; i < size; ++i) {
      if (next < rows.size() && rows[next] == i) {
        ++next;
      } else {
        channel[to++] = channel[i];
      }
    }
    channel.resize(to);
  }
  const bool has_lines = recording.lines.line_of(0) > 0;
  LineMap lines;
  for (std::size_t i = 0, next = 0; has_lines && i < size; ++i) {
    if (next < rows.size() && rows[next] == i) {
      ++next;
    } else {
      lines.set(i - next, recording.lines.line_of(i));
    }
  }
  recording.lines = std::move(lines);
  for (RawStep& step : recording.stated_steps) {
    step.begin -= static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), step.begin) - rows.begin());
  }
}

}  // namespace tribofit
