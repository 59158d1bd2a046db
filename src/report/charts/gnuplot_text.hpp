#pragma once

#include <string>
#include <string_view>

namespace tribofit {

/// Text for gnuplot: how wide it is and how it is written so that nothing in it is taken for a command.

/// Size of every text of a picture [pt].
inline constexpr double kTextPoints = 8, kSmallTextPoints = 7;

/// `text` as valid UTF-8 on one line: what is not, and control characters, become a replacement sign or a blank.
std::string one_line(std::string_view text);

/// A literal string of gnuplot that shows `text` as it is where `noenhanced` is said.
std::string quoted(std::string_view text);

/// A literal string of gnuplot's enhanced text: "v_{r}" and "s^{2}" set low and high, all else as it is.
std::string quoted_markup(std::string_view text);

/// What a text takes in a picture, in a sans-serif face [mm]; of markup without its signs.
double width_of(std::string_view text, double points = kTextPoints);

/// `text`, with its middle left out where it is wider than `width` [mm].
std::string shortened(std::string_view text, double width, double points = kTextPoints);

}  // namespace tribofit
