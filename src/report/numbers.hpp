#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// `value` with `digits` significant digits: plain ("0.0521", "83.9") between 1e-4 and 1e6, else "1.2e-05". "-" for
/// NaN.
std::string significant(double value, int digits);

/// Up to four digits without trailing zeros, for conditions: "15", "4.001".
std::string brief(double value);

/// Decimal places at which a value with this standard error is shown: two digits of the error.
/// Negative places round to tens and hundreds, as the error deserves.
int places_for(double std_error);

/// `value` rounded to `places` decimal places.
std::string fixed(double value, int places);

/// A value and its standard error to the same place: "0.05214 +/- 0.00043", or four digits of the value when the error
/// is unknown.
std::string with_error(double value, double std_error);

/// "1.3 %", "0.05 %", "130 %".
std::string percent(double share);

/// A part of a whole, with as many nines as it deserves: "93.1 %", "99.97 %", never rounded up to 100 %.
std::string share_text(double share);

/// 2400000 -> "2 400 000".
std::string grouped(std::size_t count);

/// Sampling rate: "20 kHz", "118.3 Hz".
std::string rate_text(double hertz);

/// Unit of friction levels: "1", or "N" where friction is a force.
std::string friction_unit(const Motion& motion);

/// Unit in which a parameter is shown: its own, except that what scales with friction has newtons in its unit where
/// friction is a force ("N", "N s/mm", "N/mm").
std::string shown_unit(const FitParameter& parameter, const Motion& motion);

/// A SI quantity of this parameter in the unit people read.
double shown(const FitParameter& parameter, double value_in_si);

/// A table whose columns line up; the first is left-aligned, numbers to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> header, std::vector<bool> left = {});
  void add(std::vector<std::string> row);
  bool empty() const { return rows_.size() < 2; }
  /// Columns of a terminal that its lines take, without indentation.
  std::size_t width() const;
  /// Lines with `indent` blanks before each; the header line is passed through `emphasise` codes when given.
  std::string text(std::size_t indent, std::string_view header_on = "", std::string_view header_off = "") const;

 private:
  std::vector<std::size_t> widths() const;

  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> left_;
};

/// Columns a text takes: bytes that continue a UTF-8 character take none.
std::size_t displayed(std::string_view text);

/// A command on lines no longer than `width`, as a shell reads them: indented, and broken between words with a
/// backslash.
std::string folded_command(const std::string& command, std::size_t width);

/// `sentence` broken at blanks to `width` columns, continuation lines indented by `indent`.
std::string wrapped(std::string_view sentence, std::size_t width, std::size_t indent);

}  // namespace tribofit
