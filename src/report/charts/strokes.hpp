#pragma once

#include <array>
#include <cstddef>

#include "tribofit/report/chart.hpp"

namespace tribofit {

/// How the k-th of several lines is drawn: told apart by colour and by dash, so that black and white will do.
inline Stroke stroke_of(std::size_t k) {
  constexpr std::array kColours = {Colour::black, Colour::blue,   Colour::red,
                                   Colour::green, Colour::purple, Colour::grey};
  constexpr std::array kDashes = {Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted, Dash::long_dashed};
  return {.colour = kColours[k % kColours.size()], .dash = kDashes[(k + k / kColours.size()) % kDashes.size()]};
}

/// The same for points that stand for something each, joined or not.
inline Stroke marked(std::size_t k, bool joined = true) {
  constexpr std::array kSymbols = {Symbol::circle,  Symbol::square,        Symbol::triangle_up,
                                   Symbol::diamond, Symbol::triangle_down, Symbol::cross};
  Stroke out = stroke_of(k);
  out.symbol = kSymbols[k % kSymbols.size()];
  out.joined = joined;
  return out;
}

}  // namespace tribofit
