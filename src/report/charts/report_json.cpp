#include "report/charts/report_json.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>

#include "report/charts/styles.hpp"

namespace tribofit {
namespace {

constexpr int kDigits = 5;  // of what is drawn: finer than any screen

constexpr std::array<std::string_view, 6> kTexts = {"plain", "soft", "warning", "command", "heading", "item"};

/// A number with no more digits than are drawn, so that a page stays small; null for what is not known.
Json rounded(double value, int digits = kDigits) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 40> text = {};
  const auto end = fmt::format_to_n(text.data(), text.size(), "{:.{}g}", value, digits).out;
  std::from_chars(text.data(), end, value);
  return value;
}

Json numbers_json(std::span<const double> values, int digits = kDigits) {
  return list_of(values, [&](double value) { return rounded(value, digits); });
}

std::string rgba(const Paint& paint) {
  const auto part = [&](std::size_t at) { return std::stoi(std::string(paint.colour.substr(at, 2)), nullptr, 16); };
  return fmt::format("rgba({},{},{},{})", part(1), part(3), part(5), paint.opacity);
}

/// Corners as an SVG path in a box of 2 by 2 about the origin; a circle where there are none.
std::string path_of(const SymbolStyle& style) {
  if (style.count == 0) return "M-1,0a1,1 0 1,0 2,0a1,1 0 1,0 -2,0z";
  std::string path;
  for (std::size_t k = 0; k < style.count; ++k) {
    const bool lifted = k == 0 || (style.name == "x" && k == 2);
    path += fmt::format("{}{},{}", lifted ? 'M' : 'L', style.corners[k][0], -style.corners[k][1]);
  }
  return path + (style.name == "x" ? "" : "z");
}

/// Everything about styles that the page must know, under the names that lines, bars and stretches use.
Json styles_json() {
  Json json;
  for (std::size_t k = 0; k < kColours.size(); ++k) {
    json["colours"][kColours[k].name] = kColours[k].rgb;
    json["pale"][kColours[k].name] = rgba(pale(static_cast<Colour>(k)));
  }
  for (const DashStyle& dash : kDashes) {
    std::string lengths;
    for (const double length : dash.lengths) {
      if (length > 0) lengths += fmt::format("{}{}px", lengths.empty() ? "" : ",", length);
    }
    json["dashes"][dash.name] = lengths.empty() ? "solid" : lengths;
  }
  for (const SymbolStyle& symbol : kSymbols) json["symbols"][symbol.name] = path_of(symbol);
  for (const ShadeStyle& shade : kShades) {
    json["shades"][shade.name] = {{"meaning", shade.meaning}, {"fill", rgba(shade.paint)}};
  }
  json["heat"] = kHeatColours;
  return json;
}

/// Adds what differs from its default: no false, no zero, no empty text or list, no number that is not known.
template <class Value, class... More>
void add_given(Json& json, const char* name, const Value& value, const More&... more) {
  if constexpr (std::is_floating_point_v<Value>) {
    if (std::isfinite(value)) json[name] = value;
  } else if constexpr (std::is_integral_v<Value>) {
    if (value != 0) json[name] = value;
  } else {
    if (!value.empty()) json[name] = value;
  }
  if constexpr (sizeof...(more) > 0) add_given(json, more...);
}

Json axis_json(const ChartAxis& axis) {
  Json json = {{"quantity", axis.quantity}, {"unit", axis.unit}};
  add_given(json, "low", axis.low, "high", axis.high, "from_zero", axis.from_zero, "logarithmic", axis.logarithmic,
            "falling", axis.falling, "names", axis.names);
  return json;
}

Json line_json(const ChartLine& line, int digits_of_x) {
  const Stroke& stroke = line.stroke;
  Json json = {{"name", line.name},
               {"x", numbers_json(line.x, digits_of_x)},
               {"colour", style_of(stroke.colour, kColours).name},
               {"dash", style_of(stroke.dash, kDashes).name},
               {"width", stroke.width}};
  add_given(json, "y", numbers_json(line.y), "low", numbers_json(line.low), "high", numbers_json(line.high), "bars",
            line.bars, "panel", line.panel);
  if (stroke.symbol != Symbol::none) {
    json["symbol"] = style_of(stroke.symbol, kSymbols).name;
    json["size"] = stroke.size;
  }
  if (!stroke.joined) json["joined"] = false;
  if (!line.listed) json["listed"] = false;
  if (!line.shown) json["shown"] = false;
  return json;
}

Json map_json(const HeatMap& map, const ChartAxis& x) {
  Json json = {{"x", numbers_json(map.x, x.digits)},
               {"y", numbers_json(map.y)},
               {"z", list_of(map.z, [](const std::vector<double>& row) { return numbers_json(row, 4); })},
               {"quantity", map.quantity},
               {"unit", map.unit}};
  add_given(json, "low", map.low, "high", map.high);
  return json;
}

void add_annotations(const Chart& chart, Json& json) {
  const int digits = chart.x.digits;
  const auto stretch = [&](const Stretch& s) {
    return Json{
        {"from", rounded(s.from, digits)}, {"to", rounded(s.to, digits)}, {"shade", style_of(s.shade, kShades).name}};
  };
  const auto mark = [](const ChartMark& m) {
    Json one = {{"at", rounded(m.at, kTimeDigits)}, {"dash", style_of(m.dash, kDashes).name}};
    add_given(one, "upright", m.upright, "text", m.text, "panel", m.panel);
    return one;
  };
  const auto label = [&](const ChartLabel& l) {
    Json one = {{"x", rounded(l.x, digits)}, {"y", rounded(l.y)}, {"text", l.text}};
    add_given(one, "panel", l.panel);
    return one;
  };
  add_given(json, "stretches", list_of(chart.stretches, stretch), "marks", list_of(chart.marks, mark), "labels",
            list_of(chart.labels, label));
}

Json item_json(const ReportText& text) {
  return {{"type", "text"}, {"kind", style_of(text.kind, kTexts)}, {"text", text.text}};
}

Json item_json(const ReportTable& table) {
  Json json = {{"type", "table"},
               {"caption", table.caption},
               {"header", list_of(table.columns, [](const ReportColumn& column) { return Json(column.name); })},
               {"rows", table.rows}};
  Json numeric = Json::array();
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].number) numeric.push_back(k);
  }
  add_given(json, "numeric", numeric, "folded", table.folded);
  return json;
}

Json item_json(const Animation& animation) {
  const auto block = [](const Animation::Block& b) {
    return Json{{"name", b.name},
                {"time", numbers_json(b.time, kTimeDigits)},
                {"displacement", numbers_json(b.displacement)},
                {"friction", numbers_json(b.friction)},
                {"sticks", list_of(b.sticks, [](bool stick) { return Json(stick ? 1 : 0); })}};
  };
  return {{"type", "animation"},
          {"id", animation.id},
          {"title", animation.title},
          {"note", animation.note},
          {"disc_velocity", rounded(animation.disc_velocity)},
          {"blocks", list_of(animation.blocks, block)}};
}

Json item_json(const Chart& chart) {
  const auto panel = [](const ChartPanel& p) { return Json{{"axis", axis_json(p.axis)}, {"part", p.part}}; };
  const auto bars = [](const ChartBars& b) {
    return Json{{"name", b.name},
                {"values", numbers_json(b.values)},
                {"colour", style_of(b.colour, kColours).name},
                {"hatched", b.hatched}};
  };
  const auto line = [&](const ChartLine& l) { return line_json(l, chart.x.digits); };
  Json json = {{"type", "chart"},
               {"id", chart.id},
               {"title", chart.title},
               {"note", chart.note},
               {"height", chart.height},
               {"x", axis_json(chart.x)},
               {"panels", list_of(chart.panels, panel)}};
  add_given(json, "half", chart.half, "lines", list_of(chart.lines, line), "bars", list_of(chart.bars, bars));
  if (chart.map) json["map"] = map_json(*chart.map, chart.x);
  add_annotations(chart, json);
  return json;
}

}  // namespace

Json report_json(const Report& report) {
  const auto fact = [](const auto& f) { return Json::array({f.first, f.second}); };
  const auto item = [](const ReportItem& i) { return std::visit([](const auto& own) { return item_json(own); }, i); };
  const auto section = [&](const ReportSection& s) {
    return Json{{"id", s.id}, {"title", s.title}, {"items", list_of(s.items, item)}};
  };
  return {{"kind", report.kind},
          {"title", report.title},
          {"subtitle", report.subtitle},
          {"lead", report.lead},
          {"warnings", report.warnings},
          {"facts", list_of(report.facts, fact)},
          {"sections", list_of(report.sections, section)},
          {"styles", styles_json()}};
}

}  // namespace tribofit
