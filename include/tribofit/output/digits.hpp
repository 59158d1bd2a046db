#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tribofit {

// Every number that people read, in a message, a table or on a page, gets its digits here.

/// `value` with at most `digits` digits and no zeros behind them: "15", "4.001", "1.2e-05", "nan". For messages.
std::string general(double value, int digits = 6);

/// The same with its sign: "+0.51".
std::string general_with_sign(double value, int digits);

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

/// The same with its sign, "+0.51"; `more` behind a number that is known.
std::string with_sign(double value, int places, std::string_view more = "");

/// A value and its standard error to the same place: "0.05214 +/- 0.00043", or four digits of the value when the error
/// is unknown.
std::string with_error(double value, double std_error);

/// "1.3 %", "0.05 %", "130 %".
std::string percent(double share);

/// A part of a whole, with as many nines as it deserves: "93.1 %", "99.97 %", never rounded up to 100 %.
std::string share_text(double share);

/// 2400000 -> "2 400 000".
std::string grouped(std::size_t count);

/// "[0.507, 0.511]"; "-" where neither end is known.
std::string interval_text(double lower, double upper, int places);

/// "p < 0.0001" or "p = 0.03".
std::string p_value_text(double p_value);

}  // namespace tribofit
