#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/report/report.hpp"

namespace tribofit {

/// Columns a text takes: bytes that continue a UTF-8 character take none.
std::size_t displayed(std::string_view text);

std::size_t widest(const std::vector<std::string>& lines);

/// `sentence` broken at blanks to `width` columns, continuation lines indented by `indent`.
std::string wrapped(std::string_view sentence, std::size_t width, std::size_t indent);

/// Lines of these columns of a table, the header first, with `indent` blanks before each; numbers stand to the right.
std::vector<std::string> aligned(const ReportTable& table, std::size_t indent, const std::vector<std::size_t>& columns);

/// A bar of `value` on a scale on which `full` fills `columns`; the part up to `pale` is drawn lighter. Block
/// characters with eighths of a column, or '-' and '#' where only ASCII can be shown.
std::string bar(double value, double full, std::size_t columns, bool unicode, double pale = 0);

/// The two signs of which a bar is made: {lighter, full}.
std::pair<const char*, const char*> bar_signs(bool unicode);

}  // namespace tribofit
