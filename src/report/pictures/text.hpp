#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// Sizes of everything in a picture, which is as wide as one column of a journal: mm, where nothing else is said.
struct PictureSizes {
  double width = 85, edge = 1;  ///< of the sheet, and what is blank at its edges
  double pixel = 0.16;          ///< of the height that a chart has on the page
  double pixel_points = 0.45;   ///< [pt] of its lines and symbols: a column is about half as wide as the page
  double between_panels = 2.2, least_panel = 14;

  double text = 8, small_text = 7;           ///< [pt]
  double script = 0.75, script_rise = 0.33;  ///< of what is set low or high, and how far, in sizes of its line
  double half_capital = 0.35;                ///< from the foot of a line half-way up its letters, in its size
  double halo = 2;                           ///< of the pen behind letters that have one [pt]
  double text_line = 3.4, mark_line = 3;     ///< heights of a line of text, and of words beside marks
  double beside_mark = 0.8;

  double tic = 0.7, tic_gap = 1.2;     ///< a stroke at an axis; between the axis and its numbers
  std::size_t most_names = 40;         ///< at an axis: more cannot be read
  double name = 30, name_part = 0.42;  ///< longest of names on end; of those at the ordinate, of the width
  double key_sample = 6, key_half = 1.1, key_gap = 1, between_keys = 3;
  double colour_box = 2.5;
  int colour_steps = 64;

  double tolerance = 0.02, symbol_cell = 0.08;  ///< what is nearer to a line, or to a symbol, is not drawn
  double half_cap = 0.4;                        ///< of a bar of errors
};
inline constexpr PictureSizes sizes;
inline constexpr double kMillimetresPerPoint = 25.4 / 72;

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
