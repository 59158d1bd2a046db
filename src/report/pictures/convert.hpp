#pragma once

#include <string>

#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// An SVG as PDF or PNG, drawn by librsvg; throws InputError where it cannot be drawn, and in a build without it.
std::string converted(const std::string& svg, PictureFormat format, const std::string& title);
bool can_convert();

}  // namespace tribofit
