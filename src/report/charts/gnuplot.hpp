#pragma once

#include <string>

#include "report/charts/layout.hpp"
#include "tribofit/report/chart.hpp"
#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// What gnuplot reads to draw a chart: terminal, output, commands and data. The file name may hold no control
/// characters.
std::string gnuplot_script(const Chart& chart, PictureFormat format, const std::string& output);

/// Height of the picture for which the terminal is set, in its own units [CSS pixels, points or dots].
int terminal_height(const PictureLayout& layout, PictureFormat format);
int terminal_width(PictureFormat format);

}  // namespace tribofit
