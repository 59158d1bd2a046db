#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// Texts of pictures and how wide they are.

/// Size of every text of a picture [pt].
inline constexpr double kTextPoints = 8, kSmallTextPoints = 7;
inline constexpr double kMillimetresPerPoint = 25.4 / 72;

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
/// Size of a piece beside that of the line, and how far it is raised, in sizes of the line.
inline constexpr double kScriptSize = 0.75, kScriptRise = 0.33;
/// From the foot of a line to half-way up its letters, in sizes.
inline constexpr double kHalfOfCapital = 0.35;

/// What a text takes in a picture, in Arial, Helvetica or Liberation Sans [mm]; of markup without its signs.
double width_of(std::string_view text, double points = kTextPoints);

/// `text`, with its middle left out where it is wider than `width` [mm].
std::string shortened(std::string_view text, double width, double points = kTextPoints);

}  // namespace tribofit
