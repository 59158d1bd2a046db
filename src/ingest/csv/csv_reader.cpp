#include "csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dialect.hpp"
#include "encoding.hpp"
#include "ingest/column_names.hpp"
#include "rows.hpp"

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
  column.is_text = index >= dialect.first_row.size() || !is_number(dialect.first_row[index], dialect.decimal);
  return column;
}

void say_text_rows(const Rows& rows, RawTable& table) {
  if (rows.text_rows == 0) return;
  std::string note = fmt::format("{} line{} of text or comment dropped, the first is line {}", rows.text_rows,
                                 rows.text_rows == 1 ? "" : "s", rows.first_text_line);
  (rows.text_rows * 100 > rows.size() ? table.warnings : table.notes).push_back(std::move(note));
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
  say_text_rows(rows, table);
  table.checksum = rows.checksum;
  table.is_finite = true;
  table.rows.front().lines = std::move(rows.lines);
  for (std::size_t k = 0; k < wanted.size(); ++k) table.columns[wanted[k].index].numbers = std::move(rows.values[k]);
}

bool recognises_text(std::string_view head) {
  return is_text(head);
}

RawTable read_csv(std::shared_ptr<const InputFile> file) {
  const auto dialect = std::make_shared<const Dialect>(find_dialect(*file));
  RawTable table;
  table.path = file->path();
  for (std::size_t i = 0; i < dialect->columns; ++i) table.columns.push_back(heading_of(*dialect, i));
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
