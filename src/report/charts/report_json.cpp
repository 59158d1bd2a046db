#include "report/charts/report_json.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "report/charts/styles.hpp"
#include "report/page_series.hpp"

namespace tribofit {
namespace {

constexpr std::array<std::string_view, 6> kTexts = {"plain", "soft", "warning", "command", "heading", "item"};

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

Json axis_json(const ChartAxis& axis) {
  Json json = {{"quantity", axis.quantity}, {"unit", axis.unit}};
  if (std::isfinite(axis.low)) json["low"] = axis.low;
  if (std::isfinite(axis.high)) json["high"] = axis.high;
  if (axis.from_zero) json["from_zero"] = true;
  if (axis.logarithmic) json["logarithmic"] = true;
  if (axis.falling) json["falling"] = true;
  if (!axis.names.empty()) json["names"] = axis.names;
  return json;
}

Json line_json(const ChartLine& line, int digits_of_x) {
  const Stroke& stroke = line.stroke;
  Json json = {{"name", line.name},
               {"x", numbers_json(line.x, digits_of_x)},
               {"colour", style_of(stroke.colour, kColours).name},
               {"dash", style_of(stroke.dash, kDashes).name},
               {"width", stroke.width}};
  if (!line.y.empty()) json["y"] = numbers_json(line.y);
  if (stroke.symbol != Symbol::none) {
    json["symbol"] = style_of(stroke.symbol, kSymbols).name;
    json["size"] = stroke.size;
  }
  if (!stroke.joined) json["joined"] = false;
  if (!line.low.empty()) {
    json["low"] = numbers_json(line.low);
    json["high"] = numbers_json(line.high);
  }
  if (line.bars) json["bars"] = true;
  if (!line.listed) json["listed"] = false;
  if (!line.shown) json["shown"] = false;
  if (line.panel > 0) json["panel"] = line.panel;
  return json;
}

Json map_json(const HeatMap& map, const ChartAxis& x) {
  Json z = Json::array();
  for (const std::vector<double>& row : map.z) z.push_back(numbers_json(row, 4));
  Json json = {{"x", numbers_json(map.x, x.digits)},
               {"y", numbers_json(map.y)},
               {"z", std::move(z)},
               {"quantity", map.quantity},
               {"unit", map.unit}};
  if (std::isfinite(map.low)) json["low"] = map.low;
  if (std::isfinite(map.high)) json["high"] = map.high;
  return json;
}

void add_annotations(const Chart& chart, Json& json) {
  const int digits = chart.x.digits;
  for (const Stretch& s : chart.stretches) {
    json["stretches"].push_back(
        {{"from", rounded(s.from, digits)}, {"to", rounded(s.to, digits)}, {"shade", style_of(s.shade, kShades).name}});
  }
  for (const ChartMark& mark : chart.marks) {
    Json one = {{"at", rounded(mark.at, kTimeDigits)}, {"dash", style_of(mark.dash, kDashes).name}};
    if (mark.upright) one["upright"] = true;
    if (!mark.text.empty()) one["text"] = mark.text;
    if (mark.panel > 0) one["panel"] = mark.panel;
    json["marks"].push_back(std::move(one));
  }
  for (const ChartLabel& label : chart.labels) {
    Json one = {{"x", rounded(label.x, digits)}, {"y", rounded(label.y)}, {"text", label.text}};
    if (label.panel > 0) one["panel"] = label.panel;
    json["labels"].push_back(std::move(one));
  }
}

Json text_json(const ReportText& text) {
  return {{"type", "text"}, {"kind", style_of(text.kind, kTexts)}, {"text", text.text}};
}

Json table_json(const ReportTable& table) {
  Json header = Json::array(), numeric = Json::array();
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    header.push_back(table.columns[k].name);
    if (table.columns[k].number) numeric.push_back(k);
  }
  Json json = {{"type", "table"}, {"caption", table.caption}, {"header", header}, {"rows", table.rows}};
  if (!numeric.empty()) json["numeric"] = numeric;
  if (table.folded) json["folded"] = true;
  return json;
}

Json animation_json(const Animation& animation) {
  Json json = {{"type", "animation"},
               {"id", animation.id},
               {"title", animation.title},
               {"note", animation.note},
               {"disc_velocity", rounded(animation.disc_velocity)},
               {"blocks", Json::array()}};
  for (const Animation::Block& block : animation.blocks) {
    Json sticks = Json::array();
    for (const bool stick : block.sticks) sticks.push_back(stick ? 1 : 0);
    json["blocks"].push_back({{"name", block.name},
                              {"time", numbers_json(block.time, kTimeDigits)},
                              {"displacement", numbers_json(block.displacement)},
                              {"friction", numbers_json(block.friction)},
                              {"sticks", std::move(sticks)}});
  }
  return json;
}

struct ItemJson {
  Json operator()(const ReportText& text) const { return text_json(text); }
  Json operator()(const ReportTable& table) const { return table_json(table); }
  Json operator()(const Chart& chart) const { return chart_json(chart); }
  Json operator()(const Animation& animation) const { return animation_json(animation); }
};

}  // namespace

Json chart_json(const Chart& chart) {
  Json json = {{"type", "chart"},        {"id", chart.id},          {"title", chart.title},   {"note", chart.note},
               {"height", chart.height}, {"x", axis_json(chart.x)}, {"panels", Json::array()}};
  if (chart.half) json["half"] = true;
  for (const ChartPanel& panel : chart.panels) {
    json["panels"].push_back({{"axis", axis_json(panel.axis)}, {"part", panel.part}});
  }
  for (const ChartLine& line : chart.lines) json["lines"].push_back(line_json(line, chart.x.digits));
  for (const ChartBars& bars : chart.bars) {
    json["bars"].push_back({{"name", bars.name},
                            {"values", numbers_json(bars.values)},
                            {"colour", style_of(bars.colour, kColours).name},
                            {"hatched", bars.hatched}});
  }
  if (chart.map) json["map"] = map_json(*chart.map, chart.x);
  add_annotations(chart, json);
  return json;
}

Json report_json(const Report& report) {
  Json json = {{"kind", report.kind},       {"title", report.title},       {"subtitle", report.subtitle},
               {"lead", report.lead},       {"warnings", report.warnings}, {"facts", Json::array()},
               {"sections", Json::array()}, {"styles", styles_json()}};
  for (const auto& [name, value] : report.facts) json["facts"].push_back(Json::array({name, value}));
  for (const ReportSection& section : report.sections) {
    Json one = {{"id", section.id}, {"title", section.title}, {"items", Json::array()}};
    for (const ReportItem& item : section.items) one["items"].push_back(std::visit(ItemJson{}, item));
    json["sections"].push_back(std::move(one));
  }
  return json;
}

}  // namespace tribofit
