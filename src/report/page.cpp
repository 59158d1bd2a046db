#include "tribofit/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "diagnosis_sentences.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "page_charts.hpp"
#include "page_parts.hpp"
#include "parameter_cells.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "verdict.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawnTraces = 8, kDrawnModels = 3;

TerminalOptions terminal_like(const PageOptions& options) {
  TerminalOptions terminal;
  terminal.arguments = options.arguments;
  terminal.inputs = options.inputs;
  terminal.instruments_declared = options.instruments_declared;
  return terminal;
}

bool usable(const Fit& fit) {
  return !fit.parameters.empty();
}

std::string curve_name(const Fit& fit) {
  return fit.model.name() + (fit.protocol == Protocol::published ? ", published protocol" : "");
}

/// Value, interval, systematic part and remarks of every parameter, as text in the digits that its error allows.
Json table_json(const Fit& fit, const Motion& motion) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    const int places = places_of(p);
    const bool has_error = std::isfinite(p.std_error) && p.std_error > 0;
    const auto text = [&](double si) { return fixed(shown(p, si), places); };
    const auto interval = [&](double lower, double upper) { return bracket(shown(p, lower), shown(p, upper), places); };
    rows.push_back({p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name, text(p.value),
                    shown_unit(p, motion), has_error ? text(p.std_error) : "-",
                    has_error ? interval(p.lower95, p.upper95) : "-", p.systematic > 0 ? text(p.systematic) : "-",
                    std::isfinite(p.profile_lower95) ? interval(p.profile_lower95, p.profile_upper95) : "-",
                    flags_of(fit, k)});
  }
  return rows;
}

Json model_json(const Fit& fit, const Motion& motion, bool best) {
  Json effects = Json::array();
  for (const Effect& effect : fit.model.effects()) {
    const EffectInfo info = describe(effect);
    effects.push_back({{"key", info.spelled()}, {"equation", info.equation}, {"statement", info.statement}});
  }
  return {{"name", curve_name(fit)},
          {"law", equation(fit.model.law())},
          {"best", best},
          {"effects", std::move(effects)},
          {"rows", table_json(fit, motion)}};
}

Json models_json(std::span<const Fit> fits, std::size_t best, const Motion& motion) {
  Json list = Json::array();
  for (std::size_t k = 0; k < fits.size(); ++k) list.push_back(model_json(fits[k], motion, k == best));
  return list;
}

Json protocol_json(const Identification& result) {
  Json rows = Json::array();
  for (const ProtocolRow& row : protocol_rows(result)) {
    Json cells = row.cells;
    cells.push_back(row.differs ? "outside the 95 % interval" : "");
    rows.push_back(std::move(cells));
  }
  return rows;
}

/// The best fit, then the others by the same protocol.
std::vector<DrawnModel> models_of(const Identification& result) {
  std::vector<DrawnModel> models;
  if (result.fits.empty()) return models;
  const Fit& best = result.fits[result.best];
  if (usable(best)) models.push_back({curve_name(best), &best});
  for (const Fit& fit : result.fits) {
    if (&fit == &best || fit.protocol != best.protocol || !usable(fit) || models.size() == kDrawnModels) continue;
    models.push_back({curve_name(fit), &fit});
  }
  return models;
}

/// The final model, then the law it began with.
std::vector<DrawnModel> models_of(const DiagnosedTraces& result) {
  std::vector<DrawnModel> models;
  if (result.fits.empty()) return models;
  const Fit& best = result.fits[result.best];
  if (usable(best)) models.push_back({curve_name(best), &best});
  for (const Fit& fit : result.fits) {
    if (&fit == &best || fit.model.law() != result.diagnosis.law || !usable(fit) || models.size() > 1) continue;
    models.push_back({curve_name(fit), &fit});
  }
  return models;
}

std::vector<DrawnModel> curves_of(std::span<const Fit> fits) {
  std::vector<DrawnModel> models;
  for (const Fit& fit : fits) {
    if (usable(fit) && fit.fastest > 0) models.push_back({curve_name(fit), &fit});
  }
  return models;
}

std::string file_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.empty() ? path : name;
}

/// Names of files need not be valid UTF-8; pages are.
std::string valid_utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// JSON that can stand within a script element: no name in it ends the element or begins a comment.
std::string embedded(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";  // stands in strings only
    } else {
      out += c;
    }
  }
  return out;
}

std::string assembled(const std::string& title, const Json& data) {
  const PageParts parts = page_parts();
  if (parts.head.empty()) {
    throw InputError("this build leaves the report page out",
                     "build it where npm is installed (scripts/setup page), or use --json or --csv");
  }
  const std::string text = embedded(data);
  constexpr std::size_t kPage = std::size_t{1} << 21;
  std::string page;
  page.reserve(kPage + text.size());
  for (const std::string_view piece : parts.head) page += piece;
  page += html_escaped(valid_utf8(title));
  for (const std::string_view piece : parts.middle) page += piece;
  page += text;
  for (const std::string_view piece : parts.tail) page += piece;
  return page;
}

Json suggestion_json(const Suggestion& next) {
  return {{"reason", next.reason}, {"command", next.command}};
}

}  // namespace

bool has_report_page() {
  return !page_parts().head.empty();
}

std::string report_page(const Identification& result, const PageOptions& options) {
  const TerminalOptions terminal = terminal_like(options);
  const std::string title = file_name(result.path);
  Json data = {{"kind", "trace"},
               {"title", title},
               {"result", identification_json(result, {options.arguments})},
               {"verdict", verdict(result)},
               {"command", command_line(terminal, "", result.path)},
               {"next", suggestion_json(next_command(result, terminal))},
               {"models", models_json(result.fits, result.best, result.motion)},
               {"protocols", protocol_json(result)},
               {"laws", comparison_sentences(result)},
               {"curves", curve_charts(curves_of(result.fits))},
               {"instruments_declared", options.instruments_declared}};
  data["traces"] = Json::array({trace_charts(result, models_of(result))});
  return assembled(title, data);
}

std::string report_page(const DiagnosedTraces& result, const PageOptions& options) {
  const TerminalOptions terminal = terminal_like(options);
  const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  const std::size_t count = result.traces.size(), drawn = std::min(count, kDrawnTraces);
  const std::string title =
      count == 1 ? file_name(result.traces.front().path) : fmt::format("{} traces together", count);
  Json data = {{"kind", "diagnosis"},
               {"title", title},
               {"result", diagnosed_json(result, {options.arguments})},
               {"verdict", diagnosis_verdict(result)},
               {"where", where_sentence(result.diagnosis.where)},
               {"law", law_text(result.diagnosis)},
               {"command", diagnose_command(result, terminal)},
               {"next", suggestion_json(next_after_diagnosis(result, terminal))},
               {"models", models_json(result.fits, result.best, motion)},
               {"curves", curve_charts(curves_of(result.fits))},
               {"instruments_declared", options.instruments_declared}};
  data["traces"] = Json::array();
  const std::vector<DrawnModel> models = models_of(result);
  for (std::size_t k = 0; k < drawn; ++k) {
    data["traces"].push_back(trace_charts(result.traces[k], models, 1 / static_cast<double>(drawn)));
  }
  return assembled(title, data);
}

}  // namespace tribofit
