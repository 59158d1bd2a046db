#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "dialect.hpp"
#include "encoding.hpp"
#include "ingest/limits.hpp"
#include "ingest/raw_table.hpp"
#include "ingest/reader.hpp"
#include "ingest/stated_conditions.hpp"
#include "rows.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

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

std::string text_of(const TextLine& line) {
  return to_utf8(line.text, guess_encoding(line.text));
}

/// The lines of text that stand together before one row.
using Lines = std::span<const TextLine>;

void refuse_other_columns(const Dialect& dialect, Lines lines, const std::string& path) {
  for (const TextLine& line : lines) {
    auto cells = split_cells(text_of(line), dialect.separator);
    while (!cells.empty() && cells.back().empty()) cells.pop_back();
    if (cells.size() < 2 || cells == dialect.names || 2 * cells.size() < dialect.names.size()) continue;
    const auto named = std::count_if(cells.begin(), cells.end(), [](const std::string& cell) {
      return is_field_name(parse_column_name(cell).base);
    });
    if (named < 2) continue;
    throw InputError("the columns change here: " + listed(cells),
                     "split the file here, one file for each set of columns", {path, line.line, ""});
  }
}

/// The step that these lines set apart: they number it or state a condition of it.
std::optional<RawStep> step_of(Lines lines, const RawTable& table) {
  std::vector<RawFact> facts;
  RawStep step;
  step.begin = lines.front().row;
  for (const TextLine& line : lines) {
    if (auto fact = find_fact(text_of(line), line.line)) facts.push_back(std::move(*fact));
    const std::string number = number_of_step(text_of(line));
    if (!number.empty()) step.label = number;
  }
  step.conditions = conditions_in(facts, table).conditions;
  const bool states = step.conditions.radius.known() || step.conditions.speed.known() || step.conditions.load.known();
  return states || !step.label.empty() ? std::optional(step) : std::nullopt;
}

/// Steps that lines of text between the rows set apart ("Step 2 started at ...", "Radius = 3.9", a repeated header),
/// each with the conditions its own lines state. None where no lines do.
/// Throws InputError where such lines name other columns than those above.
std::vector<RawStep> find_steps(const Dialect& dialect, const Rows& rows, const RawTable& table) {
  std::vector<RawStep> steps;
  for (auto begin = rows.text.begin(); begin != rows.text.end();) {
    const auto end = std::find_if(begin, rows.text.end(), [&](const TextLine& line) { return line.row != begin->row; });
    const Lines lines(begin, end);
    begin = end;
    if (lines.front().row >= rows.size() || lines.front().row == 0) continue;
    refuse_other_columns(dialect, lines, table.path);
    auto step = step_of(lines, table);
    if (!step) continue;
    if (steps.empty()) steps.push_back({0, dialect.first_step, {}});
    steps.push_back(std::move(*step));
  }
  return steps;
}

/// Counts the lines of text that head no step and end no file.
std::size_t stray_text(const std::vector<RawStep>& steps, const Rows& rows) {
  const auto in_place = [&](const TextLine& line) {
    const bool heads =
        std::any_of(steps.begin(), steps.end(), [&](const RawStep& step) { return step.begin == line.row; });
    return heads || line.row >= rows.size();
  };
  const auto placed = static_cast<std::size_t>(std::count_if(rows.text.begin(), rows.text.end(), in_place));
  return rows.text_rows - placed;
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
  Rows rows = read_rows(file, dialect, wanted, threads);
  if (rows.size() == 0) {
    throw InputError("has no rows of numbers", "check that the export was complete", {table.path, 0, ""});
  }
  table.rows.front().steps = find_steps(dialect, rows, table);
  say_text_rows(rows, table);
  table.first_gap = rows.first_gap;
  for (RawRows& block : table.rows) block.lines = rows.lines;
  for (std::size_t k = 0; k < wanted.size(); ++k) table.columns[wanted[k].index].numbers = std::move(rows.values[k]);
  if (table.rows.size() > 1) end_blocks(table, columns);
}

/// The file, or itself with CR for the ends of lines where they have nothing else.
std::shared_ptr<const InputFile> with_lines(std::shared_ptr<const InputFile> file) {
  const std::string head = file->read_text(0, kHeadBytes);
  const bool lone_cr = head.find('\n') == std::string::npos && head.find('\r') + 1 < head.size();
  return lone_cr ? std::make_shared<const InputFile>(file->with_line_end('\r')) : file;
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

/// Lines of cells: comma, semicolon or tab; decimal comma; BOM; CR LF; quotes; preamble and comment lines; units in the
/// header or in a row of their own; Latin-1 and GBK headers; trailing separators; text rows between data. Lines of the
/// preamble such as "Sampling rate: 1000 Hz" are facts. Only the columns asked for must be numbers.
/// Takes every text that no other reader recognises.
const Reader csv_reader = {"CSV", is_text, read_csv};

}  // namespace tribofit
