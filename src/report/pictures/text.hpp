#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/pictures/sizes.hpp"

namespace tribofit {

/// Texts of pictures and how wide they are.

/// `text` as valid UTF-8 on one line: what is not, and control characters, become a replacement sign or a blank.
std::string one_line(std::string_view text);

/// `text` as XML and HTML have it.
std::string escaped(std::string_view text);

/// A part of a text: on the line (0), set low (-1) or high (1).
struct TextPiece {
  std::string text;
  int level = 0;
};
/// "v_{r}" and "s^{2}" cut at what is set low and high; all else as it is.
std::vector<TextPiece> pieces_of(std::string_view markup);

/// What a text takes in a picture, in Arial, Helvetica or Liberation Sans [mm]; of markup without its signs.
double width_of(std::string_view text, double points = sizes.text);

/// `text`, with its middle left out where it is wider than `width` [mm].
std::string shortened(std::string_view text, double width, double points = sizes.text);

}  // namespace tribofit
