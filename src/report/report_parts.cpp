#include "report_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "condition_texts.hpp"
#include "json_parts.hpp"
#include "measures.hpp"
#include "numbers.hpp"
#include "parameter_cells.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

std::string_view word_of(HealthItem::Status status) {
  switch (status) {
    case HealthItem::Status::problem:
      return "✕ problem";
    case HealthItem::Status::warning:
      return "! warning";
    case HealthItem::Status::ok:
      break;
  }
  return "✓ ok";
}

/// Value, interval, systematic part and remarks of every parameter, in the digits that its error allows.
ReportTable parameter_table(const Fit& fit, const Motion& motion, bool systematic) {
  const bool profile = std::any_of(fit.parameters.begin(), fit.parameters.end(),
                                   [](const FitParameter& p) { return std::isfinite(p.profile_lower95); });
  ReportTable table{"", {"parameter", "value", "unit", "std error", "95 % interval"}, {}, {1, 3, 4}, false};
  const auto column = [&](const char* name) {
    table.numeric.push_back(table.header.size());
    table.header.emplace_back(name);
  };
  if (systematic) column("systematic");
  if (profile) column("95 % by profile");
  table.header.emplace_back("remarks");
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    const int places = places_of(p);
    const bool has_error = std::isfinite(p.std_error) && p.std_error > 0;
    const auto text = [&](double si) { return fixed(shown(p, si), places); };
    const auto interval = [&](double lower, double upper) { return bracket(shown(p, lower), shown(p, upper), places); };
    std::vector<std::string> row = {p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name,
                                    text(p.value), shown_unit(p, motion), has_error ? text(p.std_error) : "-",
                                    has_error ? interval(p.lower95, p.upper95) : "-"};
    if (systematic) row.push_back(p.systematic > 0 ? text(p.systematic) : "-");
    if (profile) {
      row.push_back(std::isfinite(p.profile_lower95) ? interval(p.profile_lower95, p.profile_upper95) : "-");
    }
    row.push_back(flags_of(fit, k));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string error_sentence(const Fit& fit, const Motion& motion) {
  const std::string unit = friction_unit(motion) == "N" ? " N" : "";
  const auto level = [&](double value) { return significant(value, 3) + unit; };
  return fmt::format(
      "RMSE {}, on data not seen {}; floor {} (noise {}, break-away scatter {}). Relative error mean {}, largest {}; "
      "{} "
      "of the error above the floor is explained.",
      level(fit.error.rmse), level(fit.error.held_out_rmse), level(fit.floor.rmse), level(fit.floor.noise),
      level(fit.floor.scatter), percent(fit.error.mean_relative), percent(fit.error.max_relative),
      share_text(fit.explained));
}

/// How parameters move together: the covariance as correlations.
ReportTable correlation_table(const Fit& fit) {
  const std::size_t n = fit.parameters.size();
  ReportTable table{"Correlations of the parameters", {""}, {}, {}, true};
  for (std::size_t i = 0; i < n; ++i) {
    const FitParameter& p = fit.parameters[i];
    const std::string name = p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name;
    table.header.push_back(name);
    table.numeric.push_back(i + 1);
    std::vector<std::string> row = {name};
    for (std::size_t j = 0; j < n; ++j) {
      const double size = std::sqrt(fit.covariance[i * n + i] * fit.covariance[j * n + j]);
      row.push_back(size > 0 ? fixed(fit.covariance[i * n + j] / size, 2) : "-");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_fit(const Fit& fit, const std::string& name, const Motion& motion, const ReportOptions& options,
             ReportSection& section) {
  section.items.push_back(heading_text(name));
  section.items.push_back(soft_text(std::string(equation(fit.model.law()))));
  for (const Effect& effect : fit.model.effects()) {
    const EffectInfo info = describe(effect);
    section.items.push_back(soft_text(info.spelled() + ": " + info.equation));
  }
  if (!fit.converged) {
    section.items.push_back(ReportText{"Did not converge: this is not a fit to rely on.", ReportText::Kind::warning});
  }
  if (has_parameters(fit)) {
    section.items.push_back(parameter_table(fit, motion, options.instruments_declared));
    section.items.push_back(soft_text(error_sentence(fit, motion)));
    const std::size_t n = fit.parameters.size();
    if (n > 1 && fit.covariance.size() == n * n) section.items.push_back(correlation_table(fit));
  }
  for (const std::string& message : fit.messages) section.items.push_back(soft_text("Note: " + message));
}

std::string count_text(const Segmentation& s) {
  switch (s.kind) {
    case MotionKind::always_slipping:
      return "none: the block never sticks";
    case MotionKind::always_sticking:
      return "none: the block never slips";
    case MotionKind::stick_slip:
      break;
  }
  return std::to_string(count_of_cycles(s));
}

}  // namespace

TerminalOptions terminal_like(const ReportOptions& options) {
  TerminalOptions terminal;
  terminal.arguments = options.arguments;
  terminal.inputs = options.inputs;
  terminal.instruments_declared = options.instruments_declared;
  return terminal;
}

std::string file_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  // Names of files need not be valid UTF-8; reports are.
  const std::string text = Json(name.empty() ? path : name).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(text).get<std::string>();
}

std::string curve_name(const Fit& fit) {
  return fit.model.name() + (fit.protocol == Protocol::published ? ", published protocol" : "");
}

bool has_parameters(const Fit& fit) {
  return !fit.parameters.empty();
}

ReportText plain_text(std::string text) {
  return {std::move(text), ReportText::Kind::plain};
}

ReportText soft_text(std::string text) {
  return {std::move(text), ReportText::Kind::soft};
}

ReportText heading_text(std::string text) {
  return {std::move(text), ReportText::Kind::heading};
}

void add(std::vector<Chart> charts, ReportSection& section) {
  for (Chart& chart : charts) section.items.emplace_back(std::move(chart));
}

std::vector<std::pair<std::string, std::string>> facts_of(const Identification& r) {
  const Segmentation& s = r.segmentation;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"record",
       fmt::format("{} samples, {} s at {}", grouped(r.samples), significant(r.duration, 4), rate_text(r.rate))}};
  for (auto& fact : condition_texts(r.motion)) facts.push_back(std::move(fact));
  facts.emplace_back("cycles with a stick and a slip", count_text(s));
  const auto measure = [&](const char* name, const Estimate& m, double unit, const char* unit_name) {
    if (!std::isfinite(m.value) || s.kind != MotionKind::stick_slip) return;
    facts.emplace_back(name, with_error(m.value / unit, m.std_error / unit) + " " + unit_name);
  };
  measure("frequency", s.frequency, 1, "Hz");
  measure("amplitude of v_r", s.amplitude, kMillimetre, "mm/s");
  measure("stick time", s.stick_time, kMillisecond, "ms");
  measure("slip time", s.slip_time, kMillisecond, "ms");
  return facts;
}

ReportTable health_table(std::span<const Identification> traces) {
  const bool several = traces.size() > 1;
  ReportTable table{"Health of the data", {"check", "status", "what was found"}, {}, {}, false};
  if (several) table.header.insert(table.header.begin(), "trace");
  for (const HealthItem::Status status :
       {HealthItem::Status::problem, HealthItem::Status::warning, HealthItem::Status::ok}) {
    for (const Identification& trace : traces) {
      for (const HealthItem& item : trace.motion.health) {
        if (item.status != status) continue;
        std::vector<std::string> row = {item.check, std::string(word_of(status)), item.message};
        if (several) row.insert(row.begin(), trace.path);
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

void add_parameters(std::span<const Fit> fits, std::size_t best, const Motion& motion, const ReportOptions& options,
                    ReportSection& section) {
  for (std::size_t k = 0; k < fits.size(); ++k) {
    add_fit(fits[k], curve_name(fits[k]) + (k == best && fits.size() > 1 ? " (best)" : ""), motion, options, section);
  }
  section.items.push_back(soft_text(
      options.instruments_declared
          ? "Intervals are statistical, from cycle to cycle; systematic is one standard uncertainty from the declared "
            "instruments, not part of them."
          : "Intervals are statistical, from cycle to cycle; no instrument uncertainties were declared "
            "(--instruments), "
            "so there is no systematic part."));
}

void TraceSections::add_trace(const DrawnTrace& drawn) {
  std::vector<Chart> windows = cycle_charts(drawn);
  const bool has_cycles = !windows.empty();
  if (drawn.trace.motion.size() < 2) return;
  if (!has_cycles) windows.push_back(record_chart(drawn));
  add(std::move(windows), trace);
  add(law_charts(drawn), law);
  add(error_charts(drawn), errors);
  add(measure_charts(drawn), cycles);
  if (has_cycles) cycles.items.emplace_back(record_chart(drawn));
}

ReportSection run_section(const std::string& command, std::span<const Identification> traces, const Suggestion& next) {
  ReportSection section{"run", "What was run", {}};
  section.items.push_back(plain_text("This report is made by"));
  section.items.push_back(ReportText{command, ReportText::Kind::command});
  ReportTable inputs{"Input", {"file", "samples", "duration [s]", "checksum of the rows (XXH64)"}, {}, {1, 2}, false};
  bool notes = false;
  for (const Identification& trace : traces) {
    inputs.rows.push_back({trace.path, std::to_string(trace.samples), significant(trace.duration, 4),
                           fmt::format("{:016x}", trace.checksum)});
    notes = notes || !trace.notes.empty();
  }
  section.items.push_back(std::move(inputs));
  if (notes) section.items.push_back(heading_text("How the input was read"));
  for (const Identification& trace : traces) {
    for (const std::string& note : trace.notes) section.items.push_back(ReportText{note, ReportText::Kind::item});
  }
  section.items.push_back(plain_text("Next, " + next.reason + ":"));
  section.items.push_back(ReportText{next.command, ReportText::Kind::command});
  section.items.push_back(soft_text(made_by("Made") + ". Charts by plotly.js (MIT licence)."));
  return section;
}

void append_filled(std::vector<ReportSection> sections, Report& report) {
  for (ReportSection& section : sections) {
    if (!section.items.empty()) report.sections.push_back(std::move(section));
  }
}

std::string made_by(const std::string& what) {
  return fmt::format("{} by tribofit {}", what, version);
}

}  // namespace tribofit
