#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "report/charts/styles.hpp"
#include "report/json_parts.hpp"

namespace tribofit {
namespace {

constexpr std::array<std::string_view, 6> kTexts = {"plain", "soft", "warning", "command", "heading", "item"};

/// Everything about styles that the page must know, under the names that lines, bars and stretches use.
Json styles_json() {
  Json json;
  for (std::size_t k = 0; k < kColours.size(); ++k) {
    json["colours"][kColours[k].name] = kColours[k].rgb;
    json["pale"][kColours[k].name] = pale(static_cast<Colour>(k)).opacity;
  }
  for (const DashStyle& dash : kDashes) json["dashes"][dash.name] = dash.lengths;
  for (const SymbolStyle& symbol : kSymbols) json["symbols"][symbol.name] = symbol.path;
  for (const auto& [name, meaning, paint] : kShades)
    json["shades"][name] = object("meaning", meaning, "colour", paint.colour, "opacity", paint.opacity);
  json["most_symbols"] = kMostSymbols;
  json["heat"] = kHeatColours;
  json["diverging"] = kDivergingColours;
  add_members(json, "grid", kGridColour, "axis", kAxisColour, "text", kTextColour, "disc", kDiscColour, "sticking",
              kStickingColour, "slipping", kSlippingColour);
  return json;
}

/// Adds what differs from its default: no false, no zero, no empty text or list, no number that is not known.
template <class Value, class... More>
void add_given(Json& json, const char* name, Value&& value, More&&... more) {
  make_room(json, 1 + sizeof...(more) / 2);
  using Plain = std::remove_cvref_t<Value>;
  if constexpr (std::is_floating_point_v<Plain>) {
    if (std::isfinite(value)) json[name] = value;
  } else if constexpr (std::is_integral_v<Plain>) {
    if (value != 0) json[name] = value;
  } else {
    if (!value.empty()) json[name] = std::forward<Value>(value);  // long lists are not copied
  }
  if constexpr (sizeof...(more) > 0) add_given(json, std::forward<More>(more)...);
}

Json axis_json(const ChartAxis& axis) {
  Json json = object("quantity", axis.quantity, "unit", axis.unit);
  add_given(json, "low", axis.low, "high", axis.high, "from_zero", axis.from_zero, "logarithmic", axis.logarithmic,
            "falling", axis.falling, "names", axis.names);
  return json;
}

Json line_json(const ChartLine& line, int digits_of_x) {
  const Stroke& stroke = line.stroke;
  Json json = object_with_room(10, "name", line.name, "x", rounded_list(line.x, digits_of_x), "colour",
                               style_of(stroke.colour, kColours).name, "dash", style_of(stroke.dash, kDashes).name,
                               "width", stroke.width);
  add_given(json, "y", rounded_list(line.y, chart_detail.digits), "low", rounded_list(line.low, chart_detail.digits),
            "high", rounded_list(line.high, chart_detail.digits), "bars", line.bars, "panel", line.panel);
  if (stroke.symbol != Symbol::none)
    add_members(json, "symbol", style_of(stroke.symbol, kSymbols).name, "size", stroke.size);
  if (!stroke.joined) json["joined"] = false;
  if (!line.listed) json["listed"] = false;
  if (!line.shown) json["shown"] = false;
  return json;
}

Json map_json(const HeatMap& map, const ChartAxis& x) {
  const auto row = [](const std::vector<double>& values) { return rounded_list(values, 4); };
  Json json = object_with_room(4, "x", rounded_list(map.x, x.digits), "y", rounded_list(map.y, chart_detail.digits),
                               "z", list_of(map.z, row), "quantity", map.quantity, "unit", map.unit);
  add_given(json, "low", map.low, "high", map.high, "diverging", map.diverging, "contours", map.contours);
  return json;
}

void add_annotations(const Chart& chart, Json& json) {
  const int digits = chart.x.digits;
  const auto stretch = [&](const Stretch& s) {
    return object("from", rounded(s.from, digits), "to", rounded(s.to, digits), "shade",
                  style_of(s.shade, kShades).name);
  };
  const auto mark = [](const ChartMark& m) {
    Json one = object("at", rounded(m.at, chart_detail.time_digits), "dash", style_of(m.dash, kDashes).name);
    add_given(one, "upright", m.upright, "text", m.text, "panel", m.panel);
    return one;
  };
  const auto label = [&](const ChartLabel& l) {
    Json one = object("x", rounded(l.x, digits), "y", rounded(l.y, chart_detail.digits), "text", l.text);
    add_given(one, "panel", l.panel);
    return one;
  };
  add_given(json, "stretches", list_of(chart.stretches, stretch), "marks", list_of(chart.marks, mark), "labels",
            list_of(chart.labels, label));
}

Json facts_json(const Facts& facts) {
  return list_of(facts, [](const auto& f) { return Json::array({f.first, f.second}); });
}

Json item_json(const ReportText& text) {
  return object("type", "text", "kind", style_of(text.kind, kTexts), "text", text.text);
}

Json item_json(const ReportFacts& facts) {
  return object("type", "facts", "pairs", facts_json(facts.facts));
}

Json item_json(const ReportTable& table) {
  Json header = Json::array(), numeric = Json::array();
  for (const ReportColumn& column : table.columns) {
    if (column.number) numeric.push_back(header.size());
    header.push_back(column.name);
  }
  Json json =
      object_with_room(2, "type", "table", "caption", table.caption, "header", std::move(header), "rows", table.rows);
  add_given(json, "numeric", numeric, "folded", table.folded);
  return json;
}

Json item_json(const Animation& animation) {
  const auto block = [](const Animation::Block& b) {
    return object("name", b.name, "time", rounded_list(b.time, chart_detail.time_digits), "displacement",
                  rounded_list(b.displacement, chart_detail.digits), "friction",
                  rounded_list(b.friction, chart_detail.digits), "sticks",
                  list_of(b.sticks, [](bool stick) { return Json(stick ? 1 : 0); }));
  };
  return object("type", "animation", "id", animation.id, "title", animation.title, "note", animation.note,
                "disc_velocity", rounded(animation.disc_velocity, chart_detail.digits), "blocks",
                list_of(animation.blocks, block));
}

Json item_json(const Chart& chart) {
  const auto panel = [](const ChartPanel& p) { return object("axis", axis_json(p.axis), "part", p.part); };
  const auto bars = [](const ChartBars& b) {
    return object("name", b.name, "values", rounded_list(b.values, chart_detail.digits), "colour",
                  style_of(b.colour, kColours).name, "hatched", b.hatched);
  };
  const auto line = [&](const ChartLine& l) { return line_json(l, chart.x.digits); };
  Json json = object_with_room(7, "type", "chart", "id", chart.id, "title", chart.title, "note", chart.note, "height",
                               chart.height, "x", axis_json(chart.x), "panels", list_of(chart.panels, panel));
  add_given(json, "half", chart.half, "lines", list_of(chart.lines, line), "bars", list_of(chart.bars, bars));
  if (chart.map) json["map"] = map_json(*chart.map, chart.x);
  add_annotations(chart, json);
  return json;
}

}  // namespace

Json item_json(const ReportItem& item) {
  return std::visit([](const auto& own) { return item_json(own); }, item);
}

Json section_json(const ReportSection& section) {
  Json items = Json::array();
  for (const ReportItem& item : section.items) {
    if (item.medium != Medium::terminal) items.push_back(item_json(item));
  }
  return object("id", section.id, "title", section.title, "items", std::move(items));
}

Json report_json_without_sections(const Report& report) {
  return object("kind", report.kind, "title", report.title, "subtitle", report.subtitle, "lead", report.lead,
                "warnings", report.warnings, "facts", facts_json(report.facts), "styles", styles_json());
}

Json report_json(const Report& report) {
  Json json = report_json_without_sections(report);
  Json& sections = json["sections"] = Json::array();
  for (const ReportSection& section : report.sections) {
    if (section.medium != Medium::terminal) sections.push_back(section_json(section));
  }
  return json;
}

}  // namespace tribofit
