#pragma once

#include <string>

#include "tribofit/report/chart.hpp"
#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// How gnuplot is told what a line looks like. Colours are those of the page (page/chart.js).

/// "#0072b2".
std::string ink(Colour colour);
/// The same, as it lies over what is below it: "#c70072b2".
std::string pale(Colour colour);
/// On white paper, without transparency.
std::string fill(Shade shade);

/// "lw 1.2 dt (..) lc rgb '..'" of a line this wide [pt].
std::string line_style(PictureFormat format, const std::string& colour, double points, Dash dash = Dash::solid);
/// "pt 7 ps 0.5 lw 1 dt 1 lc rgb '..'" of a symbol.
std::string symbol_style(PictureFormat format, const Stroke& stroke);

/// Widths and sizes on the page, in CSS pixels, on paper [pt].
double line_width(const Stroke& stroke);
double symbol_size(const Stroke& stroke);

}  // namespace tribofit
