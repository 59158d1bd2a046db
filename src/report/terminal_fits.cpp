#include "terminal_fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "measures.hpp"
#include "numbers.hpp"
#include "parameter_cells.hpp"
#include "tribofit/fit/identification.hpp"

namespace tribofit {
namespace {

/// How much of each parameter a table shows, from everything to what a narrow terminal can hold.
enum class Detail { all, no_start, no_share, interval_only };

Table parameter_table(const Fit& fit, const Motion& motion, const TerminalOptions& options, Detail detail) {
  const bool profile = std::any_of(fit.parameters.begin(), fit.parameters.end(), [](const FitParameter& p) {
    return std::isfinite(p.profile_lower95) && p.profile_lower95 < p.profile_upper95;
  });
  const bool start = detail == Detail::all, share = detail <= Detail::no_start, error = detail <= Detail::no_share;
  std::vector<std::string> header = {"parameter", "value"};
  const auto column = [](std::vector<std::string>& row, bool wanted, std::string cell) {
    if (wanted) row.push_back(std::move(cell));
  };
  column(header, error, "std error");
  column(header, share, "");
  header.push_back("95 % interval");
  column(header, profile, "by profile");
  column(header, options.instruments_declared, "systematic");
  header.push_back("unit");
  column(header, start, "start");
  header.push_back("remarks");
  std::vector<bool> left(header.size(), false);
  left[header.size() - 1] = left[header.size() - (start ? 3 : 2)] = true;
  Table table(header, left);
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    const int places = places_of(p);
    const bool has_error = std::isfinite(p.std_error) && p.std_error > 0;
    std::vector<std::string> row = {p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name,
                                    fixed(shown(p, p.value), places)};
    column(row, error, has_error ? fixed(shown(p, p.std_error), places) : "-");
    column(row, share, has_error && p.value != 0 ? "(" + percent(p.std_error / std::abs(p.value)) + ")" : "");
    row.push_back(has_error ? bracket(shown(p, p.lower95), shown(p, p.upper95), places) : "-");
    column(row, profile, bracket(shown(p, p.profile_lower95), shown(p, p.profile_upper95), places));
    // Nothing declared that bears on it is not the same as no uncertainty.
    column(row, options.instruments_declared, p.systematic > 0 ? fixed(shown(p, p.systematic), places) : "-");
    row.push_back(shown_unit(p, motion));
    column(row, start, significant(shown(p, p.start), 3));
    row.push_back(flags_of(fit, k));
    table.add(row);
  }
  return table;
}

std::string parameter_lines(const Fit& fit, const Motion& motion, const TerminalOptions& options, const Style& style) {
  constexpr std::size_t kIndent = 2;
  for (const Detail detail : {Detail::all, Detail::no_start, Detail::no_share}) {
    const Table table = parameter_table(fit, motion, options, detail);
    if (kIndent + table.width() <= style.width) return table.text(kIndent, style.dim, style.off);
  }
  return parameter_table(fit, motion, options, Detail::interval_only).text(kIndent, style.dim, style.off);
}

std::string error_lines(const Fit& fit, const Motion& motion, const Style& style) {
  const std::string unit = friction_unit(motion) == "N" ? " N" : "";
  const auto level = [&](double value) { return significant(value, 3) + unit; };
  std::string text =
      fmt::format("RMSE {}, on held-out data {}; floor {} (noise {} from {}, break-away scatter {})",
                  level(fit.error.rmse), level(fit.error.held_out_rmse), level(fit.floor.rmse), level(fit.floor.noise),
                  fit.floor.source.empty() ? "the trace" : fit.floor.source, level(fit.floor.scatter));
  std::string lines = "  " + wrapped(text, style.width, 2) + "\n";
  text = fmt::format("relative error (Eq 5) mean {}, largest {}; explains {} of the error above the floor",
                     percent(fit.error.mean_relative), percent(fit.error.max_relative), share_text(fit.explained));
  lines += "  " + wrapped(text, style.width, 2) + "\n";
  if (fit.model.acts_in_stick() && std::isfinite(fit.stick_rmse)) {
    lines += fmt::format("  creep in stick: RMSE {} mm/s\n", significant(fit.stick_rmse / kMillimetre, 3));
  }
  return lines;
}

std::string one_fit(const Identification& r, const Fit& fit, const TerminalOptions& options, const Style& style) {
  const bool best = &fit == &r.fits[r.best] && r.fits.size() > 1;
  std::string text = fmt::format("\n{}{}, {} protocol{}{}   {}", style.bold, fit.model.name(), to_string(fit.protocol),
                                 style.off, best ? " (best)" : "", equation(fit.model.law()));
  for (const Effect& effect : fit.model.effects()) {
    const EffectInfo info = describe(effect);
    text += "\n  " + info.spelled() + ":  " + wrapped(info.equation, style.width, info.spelled().size() + 5);
  }
  text += "\n";
  if (!fit.converged)
    text += fmt::format("  {}did not converge{}: this is not a fit to rely on\n", style.red, style.off);
  if (!fit.parameters.empty()) {
    text += parameter_lines(fit, r.motion, options, style);
    text += error_lines(fit, r.motion, style);
  }
  for (const std::string& message : fit.messages) text += "  note: " + wrapped(message, style.width, 8) + "\n";
  return text;
}

/// What the published protocol makes of the same data, and by how much it is off the joint fit.
std::string protocol_lines(const Identification& r, const Style& style) {
  Table table({"law", "parameter", "published", "joint", "difference", "unit"},
              {true, true, false, false, false, true});
  const std::vector<ProtocolRow> rows = protocol_rows(r);
  for (const ProtocolRow& row : rows) table.add(row.cells);
  const bool different = std::any_of(rows.begin(), rows.end(), [](const ProtocolRow& row) { return row.differs; });
  std::string notes;
  for (const Fit& fit : r.fits) {
    if (fit.protocol != Protocol::published || (!fit.parameters.empty() && fit.converged)) continue;
    const Fit* joint = partner_of(r, fit);
    if (joint == nullptr || !joint->converged) continue;
    for (const std::string& message : fit.messages)
      notes += "  " + wrapped(fit.model.name() + ": " + message, style.width, 2) + "\n";
  }
  std::string text = style.heading("Published protocol beside the joint fit");
  if (rows.empty()) return notes.empty() ? "" : text + notes;
  if (!different) return text + "  agrees within the 95 % intervals of the joint fit\n" + notes;
  text += table.text(2, style.dim, style.off);
  text +=
      "  " +
      wrapped(
          "The published protocol takes mu_s and mu_k from the extremes of each cycle: noise widens extremes, and the "
          "minimum in slip lies above mu_k where slips end before friction has levelled off. Use the joint fit for "
          "values, the published one to compare with papers that used it.",
          style.width, 2) +
      "\n" + notes;
  return text;
}

std::string comparison_lines(const Identification& r, const Style& style) {
  std::string text;
  for (const std::string& line : comparison_sentences(r)) text += "  " + wrapped(line, style.width, 2) + "\n";
  return text.empty() ? "" : style.heading("Which law") + text;
}

}  // namespace

std::string fit_lines(const Identification& result, const TerminalOptions& options, const Style& style) {
  if (result.fits.empty()) return "";
  std::string text = style.heading("Fits");
  if (text.back() == '\n') text.pop_back();
  bool published = false;
  bool joint = false;
  for (const Fit& fit : result.fits) joint = joint || fit.protocol == Protocol::joint;
  for (const Fit& fit : result.fits) {
    // Beside a joint fit the published values have a table of their own.
    if (fit.protocol == Protocol::published && joint && partner_of(result, fit) != nullptr) {
      published = true;
      continue;
    }
    text += one_fit(result, fit, options, style);
  }
  if (!options.instruments_declared) {
    text +=
        "\n  " +
        wrapped(
            "Intervals are statistical, from cycle to cycle; no instrument uncertainties declared (--instruments), so "
            "no systematic part.",
            style.width, 2) +
        "\n";
  } else {
    text += "\n  " +
            wrapped(
                "Intervals are statistical, from cycle to cycle; systematic is one standard uncertainty from the "
                "declared instruments, not part of them.",
                style.width, 2) +
            "\n";
  }
  const double fastest = result.fits[result.best].fastest;
  if (fastest > 0) {
    text += "  " +
            wrapped(fmt::format("The data reach |v_r| = {} mm/s; beyond that the laws are extrapolated.",
                                significant(fastest / kMillimetre, 3)),
                    style.width, 2) +
            "\n";
  }
  if (published) text += protocol_lines(result, style);
  text += comparison_lines(result, style);
  return text;
}

}  // namespace tribofit
