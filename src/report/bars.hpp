#pragma once

#include <cstddef>
#include <string>

namespace tribofit {

/// A bar of `value` on a scale on which `full` fills `columns`; the part up to `pale` is drawn lighter. Block
/// characters with eighths of a column, or '-' and '#' where only ASCII can be shown.
std::string bar(double value, double full, std::size_t columns, bool unicode, double pale = 0);

/// The two signs of which a bar is made: {lighter, full}.
struct BarSigns {
  const char* pale;
  const char* full;
};
BarSigns bar_signs(bool unicode);

}  // namespace tribofit
