#include "csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dialect.hpp"
#include "encoding.hpp"
#include "ingest/column_names.hpp"
#include "ingest/limits.hpp"
#include "rows.hpp"
#include "steps.hpp"

namespace tribofit {
namespace {

RawColumn heading_of(const Dialect& dialect, std::size_t index) {
  RawColumn column;
  column.named = index < dialect.names.size() && !dialect.names[index].empty();
  column.name = column.named ? dialect.names[index] : fmt::format("#{}", index + 1);
  column.line = dialect.header_line;
  if (index < dialect.units.size() && !dialect.units[index].empty()) {
    column.unit = strip_brackets(dialect.units[index]);
    column.unit_line = dialect.units_line;
  }
  if (index < dialect.blocks.size()) {
    column.place = fmt::format("block {}", dialect.blocks[index] + 1);
    if (dialect.blocks_apart) column.rows = dialect.blocks[index];
  }
  column.is_text = index >= dialect.first_row.size() || !is_number(dialect.first_row[index], dialect.decimal);
  return column;
}

void say_text_rows(const Rows& rows, RawTable& table) {
  const auto& steps = table.rows.front().steps;
  if (!steps.empty())
    table.notes.push_back(fmt::format("lines between the rows divide the file into {} steps", steps.size()));
  const std::size_t stray = stray_text(steps, rows);
  if (stray == 0) return;
  std::string note = fmt::format("{} line{} of text or comment dropped, the first is line {}", stray,
                                 stray == 1 ? "" : "s", rows.text.front().line);
  (stray * kRowsPerStrayLine > rows.size() ? table.warnings : table.notes).push_back(std::move(note));
}

/// Blocks that have clocks of their own have rows of their own, which may end before the others.
void end_blocks(RawTable& table, std::span<const std::size_t> columns) {
  for (std::size_t block = 0; block < table.rows.size(); ++block) {
    std::size_t end = 0;
    for (const std::size_t index : columns) {
      const RawColumn& column = table.columns[index];
      if (column.rows != block) continue;
      const auto last = std::find_if(column.numbers.rbegin(), column.numbers.rend(), [](double v) { return v == v; });
      end = std::max(end, static_cast<std::size_t>(column.numbers.rend() - last));
    }
    for (const std::size_t index : columns) {
      if (table.columns[index].rows == block) table.columns[index].numbers.resize(end);
    }
  }
}

void load_columns(const InputFile& file, const Dialect& dialect, RawTable& table, std::span<const std::size_t> columns,
                  int threads) {
  std::vector<WantedCell> wanted;
  for (const std::size_t index : columns) wanted.push_back({index, table.columns[index].shown_name()});
  const auto before = [](const WantedCell& a, const WantedCell& b) { return a.index < b.index; };
  const auto same = [](const WantedCell& a, const WantedCell& b) { return a.index == b.index; };
  std::sort(wanted.begin(), wanted.end(), before);
  wanted.erase(std::unique(wanted.begin(), wanted.end(), same), wanted.end());
  Rows rows = read_rows(file, dialect, wanted, threads);
  if (rows.size() == 0) {
    throw InputError("has no rows of numbers", "check that the export was complete", {table.path, 0, ""});
  }
  table.rows.front().steps = find_steps(dialect, rows, table);
  say_text_rows(rows, table);
  table.is_finite = !rows.first_gap;
  table.first_gap = rows.first_gap;
  for (RawRows& block : table.rows) block.lines = rows.lines;
  for (std::size_t k = 0; k < wanted.size(); ++k) table.columns[wanted[k].index].numbers = std::move(rows.values[k]);
  if (table.rows.size() > 1) end_blocks(table, columns);
}

/// The file, or itself with CR for the ends of lines where they have nothing else.
std::shared_ptr<const InputFile> with_lines(std::shared_ptr<const InputFile> file) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file->size(), kHeadBytes)), '\0');
  head.resize(file->read(0, head));
  const bool lone_cr = head.find('\n') == std::string::npos && head.find('\r') + 1 < head.size();
  return lone_cr ? std::make_shared<const InputFile>(file->with_line_end('\r')) : file;
}

bool recognises_text(std::string_view head) {
  return is_text(head);
}

RawTable read_csv(std::shared_ptr<const InputFile> given) {
  const auto file = with_lines(std::move(given));
  const auto dialect = std::make_shared<const Dialect>(find_dialect(*file));
  RawTable table;
  table.path = file->path();
  for (std::size_t i = 0; i < dialect->columns; ++i) table.columns.push_back(heading_of(*dialect, i));
  if (dialect->blocks_apart) table.rows.resize(1 + dialect->blocks.back());
  table.facts = dialect->facts;
  table.notes = dialect->notes;
  table.load = [file, dialect](RawTable& filled, std::span<const std::size_t> columns, int threads) {
    load_columns(*file, *dialect, filled, columns, threads);
  };
  return table;
}

}  // namespace

const Reader csv_reader = {"CSV", recognises_text, read_csv};

}  // namespace tribofit
