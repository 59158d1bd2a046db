#pragma once

#include <cstddef>

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
  double beside_mark = 0.8, above_label = 2.6;

  double tic = 0.7, tic_gap = 1.2;     ///< a stroke at an axis; between the axis and its numbers
  std::size_t most_names = 40;         ///< at an axis: more cannot be read
  double name = 30, name_part = 0.42;  ///< longest of names on end; of those at the ordinate, of the width
  double key_sample = 6, key_half = 1.1, key_gap = 1, between_keys = 3;
  double colour_box = 2.5;
  int colour_steps = 64;

  double tolerance = 0.02, symbol_cell = 0.08;  ///< what is nearer to a line, or to a symbol, is not drawn
  double half_cap = 0.4;                        ///< of a bar of errors
  double hatching = 1.1;                        ///< along the abscissa
  double bars_together = 0.76;                  ///< of the distance between names
};
inline constexpr PictureSizes sizes;
inline constexpr double kMillimetresPerPoint = 25.4 / 72;

}  // namespace tribofit
