#include "steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "heading.hpp"
#include "ingest/column_names.hpp"
#include "ingest/stated_conditions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

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
  step.conditions = stated_conditions(facts, table).conditions;
  const bool states = step.conditions.radius.known() || step.conditions.speed.known() || step.conditions.load.known();
  return states || !step.label.empty() ? std::optional(step) : std::nullopt;
}

}  // namespace

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

std::size_t stray_text(const std::vector<RawStep>& steps, const Rows& rows) {
  const auto in_place = [&](const TextLine& line) {
    const bool heads =
        std::any_of(steps.begin(), steps.end(), [&](const RawStep& step) { return step.begin == line.row; });
    return heads || line.row >= rows.size();
  };
  const auto placed = static_cast<std::size_t>(std::count_if(rows.text.begin(), rows.text.end(), in_place));
  return rows.text_rows - placed;
}

}  // namespace tribofit
