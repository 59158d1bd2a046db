#pragma once

#include <cstddef>
#include <string>

/// Writes to standard output. Nobody reading any more (a closed pipe) is no error and is not complained about; a full
/// disc throws tribofit::InputError.
void print(const std::string& text);

/// Whether colours are wanted: standard output is a terminal that can, and NO_COLOR is not set.
bool wants_colour();

/// Columns of the terminal; 100 where there is none.
std::size_t terminal_width();

/// One line to standard error, only where a person watches.
void progress(const std::string& text);

/// "identify: error: TEXT" to standard error.
void complain(const std::string& text);
