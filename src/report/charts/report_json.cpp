#include "report/charts/report_json.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "report/page_series.hpp"

namespace tribofit {
namespace {

template <class Enum, std::size_t N>
std::string_view name_of(Enum value, const std::array<std::string_view, N>& names) {
  return names.at(static_cast<std::size_t>(value));
}

constexpr std::array<std::string_view, 6> kColours = {"black", "blue", "red", "green", "purple", "grey"};
constexpr std::array<std::string_view, 5> kDashes = {"solid", "dash", "dot", "dashdot", "longdash"};
constexpr std::array<std::string_view, 7> kSymbols = {"none",        "circle",        "square", "diamond",
                                                      "triangle-up", "triangle-down", "x"};
constexpr std::array<std::string_view, 4> kShades = {"stick", "slip", "beyond", "left-out"};
constexpr std::array<std::string_view, 6> kTexts = {"plain", "soft", "warning", "command", "heading", "item"};

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
               {"colour", name_of(stroke.colour, kColours)},
               {"dash", name_of(stroke.dash, kDashes)},
               {"width", stroke.width}};
  if (!line.y.empty()) json["y"] = numbers_json(line.y);
  if (stroke.symbol != Symbol::none) {
    json["symbol"] = name_of(stroke.symbol, kSymbols);
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
    json["stretches"].push_back({{"from", rounded(s.from, digits)},
                                 {"to", rounded(s.to, digits)},
                                 {"shade", name_of(s.shade, kShades)},
                                 {"meaning", meaning_of(s.shade)}});
  }
  for (const ChartMark& mark : chart.marks) {
    Json one = {{"at", rounded(mark.at, kTimeDigits)}, {"dash", name_of(mark.dash, kDashes)}};
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
  return {{"type", "text"}, {"kind", name_of(text.kind, kTexts)}, {"text", text.text}};
}

Json table_json(const ReportTable& table) {
  Json json = {{"type", "table"}, {"caption", table.caption}, {"header", table.header}, {"rows", table.rows}};
  if (!table.numeric.empty()) json["numeric"] = table.numeric;
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

std::string meaning_of(Shade shade) {
  constexpr std::array<std::string_view, 4> kMeanings = {"stick", "slip", "beyond the data", "left out"};
  return std::string(name_of(shade, kMeanings));
}

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
                            {"colour", name_of(bars.colour, kColours)},
                            {"hatched", bars.hatched}});
  }
  if (chart.map) json["map"] = map_json(*chart.map, chart.x);
  add_annotations(chart, json);
  return json;
}

Json report_json(const Report& report) {
  Json json = {{"kind", report.kind},      {"title", report.title},       {"subtitle", report.subtitle},
               {"lead", report.lead},      {"warnings", report.warnings}, {"facts", Json::array()},
               {"sections", Json::array()}};
  for (const auto& [name, value] : report.facts) json["facts"].push_back(Json::array({name, value}));
  for (const ReportSection& section : report.sections) {
    Json one = {{"id", section.id}, {"title", section.title}, {"items", Json::array()}};
    for (const ReportItem& item : section.items) one["items"].push_back(std::visit(ItemJson{}, item));
    json["sections"].push_back(std::move(one));
  }
  return json;
}

}  // namespace tribofit
