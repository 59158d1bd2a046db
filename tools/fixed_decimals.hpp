#pragma once

#include <string>

namespace tribofit {

/// Appends value with a fixed number of decimals; the integer route is several times faster than printing a double, and
/// open to those whose digits fit into an integer. Throws InputError for what is no finite number.
void append_fixed(std::string& text, double value, int decimals);

/// Decimals that give every multiple of the sampling interval exactly, at most nine.
int time_decimals(double rate);

}  // namespace tribofit
