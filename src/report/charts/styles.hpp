#pragma once

#include <cstddef>

#include "tribofit/report/chart.hpp"

namespace tribofit {

/// How the same thing is drawn in every chart.

inline constexpr Stroke kMeasured = {Colour::blue, Dash::solid, Symbol::none, 1.1};
inline constexpr Stroke kDisc = {Colour::red, Dash::dashed, Symbol::none, 1.5};
inline constexpr Stroke kPublished = {Colour::grey, Dash::dotted, Symbol::none, 1.3};

/// Of the model that is k-th among those beside the samples.
inline Stroke model_stroke(std::size_t k) {
  constexpr Stroke kModels[] = {{Colour::black, Dash::solid, Symbol::none, 2},
                                {Colour::purple, Dash::dash_dotted, Symbol::none, 2},
                                {Colour::green, Dash::long_dashed, Symbol::none, 2},
                                {Colour::grey, Dash::dashed, Symbol::none, 1.6}};
  return kModels[k < 4 ? k : 3];
}

/// Points that are not joined.
constexpr Stroke dots(Colour colour, Symbol symbol, double size = 5) {
  return {colour, Dash::solid, symbol, 1.6, size, false};
}

inline ChartPanel panel(ChartAxis axis, double part = 1) {
  return {std::move(axis), part};
}

}  // namespace tribofit
