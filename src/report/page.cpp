#include <fmt/format.h>

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "json_parts.hpp"
#include "output/described.hpp"
#include "report/charts/styles.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

std::string rgba(const Paint& paint) {
  const auto part = [&](std::size_t k) { return channel_of(paint.colour, k); };
  return fmt::format("rgba({},{},{},{})", part(0), part(1), part(2), paint.opacity);
}

/// The styles, as CSS has them, under the names that lines and stretches use.
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

constexpr std::string_view to_string(ReportText::Kind kind) {
  constexpr std::string_view kKinds[] = {"plain", "soft",  "warning", "problem", "command", "heading",
                                         "item",  "title", "name",    "detail",  "drawing"};
  return style_of(kind, kKinds);
}

TRIBOFIT_DESCRIBED(ChartAxis, quantity, unit, low, high, from_zero, logarithmic, names, part);
TRIBOFIT_DESCRIBED(Stroke, colour, dash, symbol, width, size, joined);
TRIBOFIT_DESCRIBED(ChartLine, name, stroke, x, y, low, high, bars, shown, panel);
TRIBOFIT_DESCRIBED(ChartMark, at, dash, upright, text, panel);
TRIBOFIT_DESCRIBED(HeatMap, x, y, z, quantity, unit, low, high, diverging);
TRIBOFIT_DESCRIBED(Stretch, from, to, shade);
TRIBOFIT_DESCRIBED(Chart, id, title, note, height, half, x, panels, lines, map, stretches, marks);
TRIBOFIT_DESCRIBED(ReportText, kind, text);
TRIBOFIT_DESCRIBED(ReportFacts, facts);
TRIBOFIT_DESCRIBED(ReportColumn, name, number);
TRIBOFIT_DESCRIBED(ReportTable, caption, columns, rows, folded);
TRIBOFIT_DESCRIBED(Animation::Block, name, time, displacement, friction, sticks);
TRIBOFIT_DESCRIBED(Animation, id, title, note, disc_velocity, blocks);

namespace {

/// Numbers to as many digits as are drawn, finer than any screen: a page stays small.
void round_numbers(Json& json, int digits = chart_detail.digits) {
  static const std::set<std::string, std::less<>> abscissas = {"x", "at", "from", "to", "time"};
  if (json.is_number_float()) json = rounded(json.get<double>(), digits);
  if (json.is_array()) {
    for (Json& one : json) round_numbers(one, digits);
  } else if (json.is_object()) {
    for (auto& [name, one] : json.get_ref<Json::object_t&>()) {
      round_numbers(one, abscissas.contains(name) ? chart_detail.time_digits : digits);
    }
  }
}

}  // namespace

Json section_json(const ReportSection& section) {
  constexpr std::string_view kTypes[] = {"text", "facts", "table", "chart", "animation"};  // of AnyItem
  Json items = Json::array();
  for (const ReportItem& item : section.items) {
    if (!is_for_page(item)) continue;
    items.push_back(std::visit([](const auto& one) { return json_of(one); }, item));
    items.back()["type"] = kTypes[item.index()];
  }
  round_numbers(items);
  return object("id", section.id, "title", section.title, "items", std::move(items));
}

Json report_json(const Report& report) {
  Json sections = Json::array();
  for (const ReportSection& section : report.sections) {
    if (is_for_page(section)) sections.push_back(section_json(section));
  }
  return object("kind", report.kind, "title", report.title, "subtitle", report.subtitle, "lead", report.lead,
                "warnings", report.warnings, "facts", json_of(report.facts), "styles", styles_json(), "sections",
                std::move(sections));
}

/// The page with @TITLE@ and @DATA@ in their places (page/assemble.mjs); empty in a build without it.
std::string_view page_template();

bool has_report_page() {
  return !page_template().empty();
}

std::string report_page(const Report& report) {
  std::string page(page_template());
  if (page.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  std::string data;
  // No name in a string ends the script element or begins a comment.
  for (const char c : line_of(report_json(report))) data += c == '<' ? std::string("\\u003c") : std::string(1, c);
  for (const auto& [mark, text] : {std::pair("@DATA@", data), std::pair("@TITLE@", escaped(report.title))}) {
    page.replace(page.find(mark), std::string_view(mark).size(), text);
  }
  return page;
}

}  // namespace tribofit
