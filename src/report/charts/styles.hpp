#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "tribofit/report/chart.hpp"

namespace tribofit {

/// What colours, dashes, symbols and shades look like, for page and pictures alike; the page gets them as data
/// (styles_json()).

/// A colour over what lies below it.
struct Paint {
  std::string_view colour = "#000000";
  double opacity = 1;
};

/// Colours of Okabe and Ito, purple and grey darkened to be read on white; by the value of Colour.
struct ColourStyle {
  std::string_view name, rgb;
};
inline constexpr std::array<ColourStyle, 6> kColours = {{{"black", "#000000"},
                                                         {"blue", "#0072b2"},
                                                         {"red", "#d55e00"},
                                                         {"green", "#009e73"},
                                                         {"purple", "#a0508a"},
                                                         {"grey", "#6b6b6b"}}};
/// What is not data: lines of the grid, frames and marks, text.
inline constexpr std::string_view kGridColour = "#e2e2e2", kAxisColour = "#444444", kTextColour = "#1b1b1b";
/// Of the animation: the disc, and the block while it sticks and while it slips.
inline constexpr std::string_view kDiscColour = "#dcdcdc", kStickingColour = "#cfe3f1", kSlippingColour = "#f7d9b0";
/// About a sample of a shade in the key.
inline constexpr std::string_view kKeyColour = "#bbbbbb";

constexpr Paint ink(Colour colour) {
  return {kColours[static_cast<std::size_t>(colour)].rgb};
}
/// Red, green or blue (0 to 2) of "#d55e00", 0 to 255.
inline int channel_of(std::string_view rgb, std::size_t which) {
  return std::stoi(std::string(rgb.substr(1 + 2 * which, 2)), nullptr, 16);
}
/// Of a band under its line.
constexpr Paint pale(Colour colour) {
  return {ink(colour).colour, colour == Colour::black ? 0.14 : 0.22};
}

/// Strokes and gaps in turn [CSS pixels]; 0 ends the list. By the value of Dash.
struct DashStyle {
  std::string_view name;
  std::array<double, 4> lengths;
};
inline constexpr std::array<DashStyle, 5> kDashes = {
    {{"solid", {}}, {"dash", {8, 4}}, {"dot", {2, 3}}, {"dashdot", {9, 3, 2, 3}}, {"longdash", {15.5, 4.5}}}};

/// A symbol about as large as a circle of radius 1, as a path of SVG. By the value of Symbol; the names are those of
/// plotly.js.
struct SymbolStyle {
  std::string_view name, path;
};
inline constexpr std::string_view kRound = "M-1,0a1,1 0 1,0 2,0a1,1 0 1,0 -2,0z";
inline constexpr std::array<SymbolStyle, 7> kSymbols = {{{"none", kRound},
                                                         {"circle", kRound},
                                                         {"square", "M-1,1H1V-1H-1z"},
                                                         {"diamond", "M0,1.3L1.3,0L0,-1.3L-1.3,0z"},
                                                         {"triangle-up", "M-1.25,0.9H1.25L0,-1.2z"},
                                                         {"triangle-down", "M-1.25,-0.9H1.25L0,1.2z"},
                                                         {"x", "M-0.9,0.9L0.9,-0.9M-0.9,-0.9L0.9,0.9"}}};

/// Symbols of a joined line, at most: more would hide it.
inline constexpr std::size_t kMostSymbols = 40;

/// By the value of Shade.
struct ShadeStyle {
  std::string_view name, meaning;
  Paint paint;
};
inline constexpr std::array<ShadeStyle, 5> kShades = {{{"stick", "stick", {"#000000", 0.07}},
                                                       {"slip", "slip", {"#e69f00", 0.16}},
                                                       {"beyond", "beyond the data", {"#000000", 0.11}},
                                                       {"left-out", "left out", {"#a0508a", 0.2}},
                                                       {"range", "95 % range", {"#a0508a", 0.3}}}};

/// Cividis (Nunez, Anderton & Renslow 2018), made for people who do not see colours alike: lightness rises evenly.
inline constexpr std::array<std::string_view, 10> kHeatColours = {
    "#00204c", "#00336f", "#39486b", "#575c6d", "#707173", "#8a8779", "#a69d75", "#c4b56c", "#e4cf5b", "#ffe945"};

/// Blue, pale, red (after ColorBrewer's RdBu, Harrower & Brewer 2003): the sign is seen without knowing the colours by
/// which end is darker in print, and zero stands out as palest.
inline constexpr std::array<std::string_view, 9> kDivergingColours = {
    "#053061", "#2166ac", "#4393c3", "#a7cfe4", "#f7f7f7", "#f6bfa3", "#d6604d", "#b2182b", "#67001f"};

inline std::span<const std::string_view> colours_of(const HeatMap& map) {
  if (map.diverging) return kDivergingColours;
  return kHeatColours;
}

template <class Enum, class Styles>
constexpr const auto& style_of(Enum value, const Styles& styles) {
  return styles[static_cast<std::size_t>(value)];
}

constexpr std::string_view to_string(Colour colour) {
  return style_of(colour, kColours).name;
}
constexpr std::string_view to_string(Dash dash) {
  return style_of(dash, kDashes).name;
}
constexpr std::string_view to_string(Symbol symbol) {
  return style_of(symbol, kSymbols).name;
}
constexpr std::string_view to_string(Shade shade) {
  return style_of(shade, kShades).name;
}
// How the same thing is drawn in every chart.

/// How much of a record charts show: stretches into which a series is cut (drawn_samples()), bins of what is taken
/// together, and things that are shown at most.
struct ChartDetail {
  std::size_t record = 1200, cycles = 1200, zoom = 300, measures = 200, spectrum = 800, motion = 400, least = 50;
  std::size_t speed_bins = 48, error_bins = 80, time_bins = 400;
  std::size_t curve_points = 161, break_aways = 200, runs = 300;
  std::size_t shown_cycles = 3, shown_groups = 6, shown_steps = 8, shown_sticks = 60;
  double event = 0.1;     ///< of the slip, to either side of its break-away and re-stick
  double harmonics = 12;  ///< multiples of the stick-slip frequency up to which a spectrum is shown
  double decades = 100;   ///< fastest over slowest from which points stand over the logarithm of the speed
  double square = 1.8;    ///< part of a panel that is nearly as high as half the page is wide
  int digits = 5;         ///< of what is drawn: finer than any screen, and a page stays small
  int time_digits = 9;    ///< over the abscissa: 20 us are distinguishable after an hour
};
inline constexpr ChartDetail chart_detail;

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

/// The k-th of several lines: distinguished by colour and by dash, so that black and white will do.
inline Stroke stroke_of(std::size_t k) {
  constexpr std::size_t kCount = kDashes.size();
  return {.colour = static_cast<Colour>(k % kColours.size()),
          .dash = static_cast<Dash>((k + k / kColours.size()) % kCount)};
}

/// The same for points that stand for something each, joined or not.
inline Stroke marked(std::size_t k, bool joined = true) {
  constexpr std::array kOrder = {Symbol::circle,  Symbol::square,        Symbol::triangle_up,
                                 Symbol::diamond, Symbol::triangle_down, Symbol::cross};
  Stroke out = stroke_of(k);
  out.symbol = kOrder[k % kOrder.size()];
  out.joined = joined;
  return out;
}

/// A chart of one panel, without lines yet.
inline Chart chart_of(std::string id, std::string title, ChartAxis x, ChartAxis y, std::string note = "") {
  Chart chart{.id = std::move(id), .title = std::move(title), .note = std::move(note), .x = std::move(x)};
  chart.panels[0] = std::move(y);
  return chart;
}

/// One that stands beside its neighbour.
inline Chart half_chart(std::string id, std::string title, ChartAxis x, ChartAxis y, std::string note = "") {
  Chart chart = chart_of(std::move(id), std::move(title), std::move(x), std::move(y), std::move(note));
  chart.half = true;
  return chart;
}

/// Points that are not joined.
constexpr Stroke dots(Colour colour, Symbol symbol, double size = 5) {
  return {colour, Dash::solid, symbol, 1.6, size, false};
}

}  // namespace tribofit
