#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "output/described.hpp"
#include "report/charts/styles.hpp"
#include "report/json_parts.hpp"

namespace tribofit {
namespace {

/// Numbers finer than any screen; of times more.
template <class Get>
constexpr auto drawn(Get get) {
  return to_digits(chart_detail.digits, get);
}
template <class Get>
constexpr auto drawn_time(Get get) {
  return to_digits(chart_detail.time_digits, get);
}

/// A member by the name of its style.
template <class Get, class Styles>
constexpr auto named(Get get, const Styles& styles) {
  return [get, &styles](const auto& one) { return style_of(std::invoke(get, one), styles).name; };
}

std::string rgba(const Paint& paint) {
  const auto part = [&](std::size_t k) { return channel_of(paint.colour, k); };
  return fmt::format("rgba({},{},{},{})", part(0), part(1), part(2), paint.opacity);
}

/// Everything about styles that the page must know, as CSS has it, under the names that lines, bars and stretches use.
Json styles_json() {
  Json json;
  for (std::size_t k = 0; k < kColours.size(); ++k) {
    json["colours"][kColours[k].name] = kColours[k].rgb;
    json["pale"][kColours[k].name] = rgba(pale(static_cast<Colour>(k)));
  }
  for (const DashStyle& dash : kDashes) {
    std::string lengths;
    for (const double length : dash.lengths) lengths += length > 0 ? fmt::format(",{}px", length) : "";
    json["dashes"][dash.name] = lengths.empty() ? "solid" : lengths.substr(1);
  }
  for (const SymbolStyle& symbol : kSymbols) json["symbols"][symbol.name] = symbol.path;
  for (const auto& [name, meaning, paint] : kShades)
    json["shades"][name] = object("meaning", meaning, "fill", rgba(paint));
  json["most_symbols"] = kMostSymbols;
  json["heat"] = kHeatColours;
  json["diverging"] = kDivergingColours;
  add_members(json, "paper", "#ffffff", "halo", "rgba(255,255,255,0.8)", "grid", kGridColour, "axis", kAxisColour,
              "text", kTextColour, "disc", kDiscColour, "sticking", kStickingColour, "slipping", kSlippingColour);
  return json;
}

template <class Part>
bool is_for_page(const Part& part) {
  return part.medium != Medium::terminal;
}

}  // namespace

constexpr auto description(const ChartAxis*) {
  return described("quantity", &ChartAxis::quantity, "unit", &ChartAxis::unit, "low", &ChartAxis::low, "high",
                   &ChartAxis::high, "from_zero", &ChartAxis::from_zero, "logarithmic", &ChartAxis::logarithmic,
                   "falling", &ChartAxis::falling, "names", &ChartAxis::names, "part", &ChartAxis::part);
}
constexpr auto description(const Stroke*) {
  return described("colour", named(&Stroke::colour, kColours), "dash", named(&Stroke::dash, kDashes), "symbol",
                   named(&Stroke::symbol, kSymbols), "width", &Stroke::width, "size", &Stroke::size, "joined",
                   &Stroke::joined);
}
constexpr auto description(const ChartLine*) {
  return described(
      "name", &ChartLine::name, "stroke", &ChartLine::stroke, "x", [](const ChartLine&) { return Json(); }, "y",
      drawn(&ChartLine::y), "low", drawn(&ChartLine::low), "high", drawn(&ChartLine::high), "bars", &ChartLine::bars,
      "shown", &ChartLine::shown, "panel", &ChartLine::panel);
}
constexpr auto description(const ChartBars*) {
  return described("name", &ChartBars::name, "values", drawn(&ChartBars::values), "colour",
                   named(&ChartBars::colour, kColours), "hatched", &ChartBars::hatched);
}
constexpr auto description(const ChartMark*) {
  return described("at", drawn_time(&ChartMark::at), "dash", named(&ChartMark::dash, kDashes), "upright",
                   &ChartMark::upright, "text", &ChartMark::text, "panel", &ChartMark::panel);
}
constexpr auto description(const ChartLabel*) {
  return described("x", drawn_time(&ChartLabel::x), "y", drawn(&ChartLabel::y), "text", &ChartLabel::text, "panel",
                   &ChartLabel::panel);
}
constexpr auto description(const HeatMap*) {
  const auto rows = [](const HeatMap& map) {
    return list_of(map.z, [](const std::vector<double>& row) { return rounded_list(row, chart_detail.digits - 1); });
  };
  return described("x", drawn(&HeatMap::x), "y", drawn(&HeatMap::y), "z", rows, "quantity", &HeatMap::quantity, "unit",
                   &HeatMap::unit, "low", &HeatMap::low, "high", &HeatMap::high, "diverging", &HeatMap::diverging,
                   "contours", &HeatMap::contours);
}
constexpr auto description(const Chart*) {
  const auto lines = [](const Chart& chart) {
    return list_of(chart.lines, [&](const ChartLine& line) {
      Json json = json_of(line);
      json["x"] = rounded_list(line.x, chart.x.digits);
      return json;
    });
  };
  const auto stretches = [](const Chart& chart) {
    return list_of(chart.stretches, [&](const Stretch& one) {
      return object("from", rounded(one.from, chart.x.digits), "to", rounded(one.to, chart.x.digits), "shade",
                    style_of(one.shade, kShades).name);
    });
  };
  return described(
      "type", [](const Chart&) { return "chart"; }, "id", &Chart::id, "title", &Chart::title, "note", &Chart::note,
      "height", &Chart::height, "half", &Chart::half, "x", &Chart::x, "panels", &Chart::panels, "lines", lines, "bars",
      &Chart::bars, "map", &Chart::map, "stretches", stretches, "marks", &Chart::marks, "labels", &Chart::labels);
}
constexpr auto description(const ReportText*) {
  const auto kind = [](const ReportText& text) {
    constexpr std::string_view kTexts[] = {"plain", "soft", "warning", "command", "heading", "item"};
    return style_of(text.kind, kTexts);
  };
  return described(
      "type", [](const ReportText&) { return "text"; }, "kind", kind, "text", &ReportText::text);
}
constexpr auto description(const ReportFacts*) {
  return described(
      "type", [](const ReportFacts&) { return "facts"; }, "pairs", &ReportFacts::facts);
}
constexpr auto description(const ReportColumn*) {
  return described("name", &ReportColumn::name, "number", &ReportColumn::number);
}
constexpr auto description(const ReportTable*) {
  return described(
      "type", [](const ReportTable&) { return "table"; }, "caption", &ReportTable::caption, "columns",
      &ReportTable::columns, "rows", &ReportTable::rows, "folded", &ReportTable::folded);
}
constexpr auto description(const Animation::Block*) {
  using Block = Animation::Block;
  return described("name", &Block::name, "time", drawn_time(&Block::time), "displacement", drawn(&Block::displacement),
                   "friction", drawn(&Block::friction), "sticks", &Block::sticks);
}
constexpr auto description(const Animation*) {
  return described(
      "type", [](const Animation&) { return "animation"; }, "id", &Animation::id, "title", &Animation::title, "note",
      &Animation::note, "disc_velocity", drawn(&Animation::disc_velocity), "blocks", &Animation::blocks);
}
constexpr auto description(const ReportSection*) {
  const auto items = [](const ReportSection& section) {
    Json list = Json::array();
    for (const ReportItem& item : section.items) {
      if (is_for_page(item)) list.push_back(std::visit([](const auto& one) { return json_of(one); }, item));
    }
    return list;
  };
  return described("id", &ReportSection::id, "title", &ReportSection::title, "items", items);
}

Json section_json(const ReportSection& section) {
  return json_of(section);
}

Json report_json(const Report& report) {
  Json sections = Json::array();
  for (const ReportSection& section : report.sections) {
    if (is_for_page(section)) sections.push_back(json_of(section));
  }
  return object("kind", report.kind, "title", report.title, "subtitle", report.subtitle, "lead", report.lead,
                "warnings", report.warnings, "facts", json_of(report.facts), "styles", styles_json(), "sections",
                std::move(sections));
}

}  // namespace tribofit
