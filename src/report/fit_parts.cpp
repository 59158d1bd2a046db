#include <algorithm>
#include <cmath>

#include "fit/assessment.hpp"
#include "report_parts.hpp"

namespace tribofit {
namespace {

/// How parameters move together: the covariance as correlations.
ReportTable correlation_table(const Fit& fit) {
  const std::size_t n = fit.parameters.size();
  ReportTable table("Correlations of the parameters");
  table.text({""}).folded = true;
  if (n < 2 || fit.covariance.size() != n * n) return table;
  for (std::size_t i = 0; i < n; ++i) {
    table.numbers({full_name(fit.parameters[i])});
    auto& row = table.rows.emplace_back(1, full_name(fit.parameters[i]));
    for (std::size_t j = 0; j < n; ++j) {
      const double correlation = fit.correlation(i, j);
      row.push_back(std::isfinite(correlation) ? fixed(correlation, 2) : "-");
    }
  }
  return table;
}

void add_errors(const Fit& fit, const Motion& motion, ReportSection& section) {
  const auto level = [&](double value) { return significant(value, 3) + unit_behind(friction_unit(motion)); };
  const Floor& floor = fit.floor;
  std::string parts = "from " + (floor.source.empty() && !motion.is_points() ? "the trace" : floor.source);
  if (!motion.is_points()) {
    parts = fmt::format("noise {} {}, break-away scatter {}{}{}", level(floor.noise), parts, level(floor.scatter),
                        floor.level_scatter > 0 ? ", level scatter " + percent(floor.level_scatter) : "",
                        floor.slow_noise > 0 ? ", slow 1/f noise " + level(floor.slow_noise) : "");
  }
  section.soft(fmt::format("RMSE {}, held-out error {}; noise floor {} ({}).", level(fit.error.rmse),
                           level(fit.error.held_out_rmse), level(floor.rmse), parts));
  section.soft(fmt::format("Relative error mean {}, largest {}; explains {} of the error above the noise floor.",
                           percent(fit.error.mean_relative), percent(fit.error.max_relative),
                           share_text(fit.explained)));
  if (fit.model.acts_in_stick() && std::isfinite(fit.stick_rmse)) {
    section.soft(fmt::format("Creep in stick: RMSE {} mm/s.", significant(fit.stick_rmse / kMillimetre, 3)));
  }
}

void add_fit(const Fit& fit, const Motion& motion, bool best, bool instruments_declared, ReportSection& section) {
  section.heading(fmt::format("{}, {}{}", fit.model.name(), protocol_text(fit.protocol), best ? " (best)" : ""));
  section.soft(describe(fit.model.law()).equation);
  for (const Effect& effect : fit.model.effects()) {
    const EffectInfo info = describe(effect);
    section.soft(info.spelled() + ": " + info.equation);
  }
  if (!fit.converged) section.warning("This fit did not converge: do not rely on it.");
  section.add(parameter_table(fit, motion, instruments_declared));
  if (!fit.parameters.empty()) add_errors(fit, motion, section);
  section.add(correlation_table(fit));
  for (const std::string& message : fit.messages) section.item("Note: " + message);
}

/// Per-cycle extremes beside the joint fit, and by how much they differ; nothing where there is no pair.
void add_protocols(std::span<const Fit> fits, const Motion& motion, ReportSection& section) {
  ReportTable table;
  table.text({"law", "parameter"}).numbers({"extremes", "joint fit", "difference"}).text({"unit"}).text({"remarks"}, 1);
  std::vector<std::string> notes;
  bool different = false;
  for (const Fit& fit : fits) {
    const Fit* joint = joint_partner(fits, fit);
    if (joint == nullptr || !joint->converged) continue;
    if (fit.parameters.empty() || !fit.converged) {
      for (const std::string& message : fit.messages) notes.push_back(fit.model.name() + ": " + message);
    }
    for (std::size_t k = 0; k < std::min(fit.parameters.size(), joint->parameters.size()); ++k) {
      const bool outside = is_outside(fit.parameters[k], joint->parameters[k]);
      const ResultParameter a = result_of(fit.parameters[k], motion), b = result_of(joint->parameters[k], motion);
      const int places = places_of(b);
      table.rows.push_back({k == 0 ? fit.model.name() : "", b.name, fixed(a.value, places), fixed(b.value, places),
                            with_sign(100 * (a.value / b.value - 1), 1, " %"), b.unit,
                            outside ? "outside the 95 % interval" : ""});
      different |= outside;
    }
  }
  const bool none = table.rows.empty();
  if (none && notes.empty()) return;
  section.heading("Per-cycle extremes beside the joint fit");
  section.add(std::move(table));
  if (different) {
    section.soft(
        "Per-cycle extremes take mu_s and mu_k from the maximum and minimum of each cycle: noise widens extremes, and "
        "the minimum in slip lies above mu_k where slips end before friction has levelled off. Use the joint fit for "
        "values, the extremes to compare with papers that used them.");
  } else if (!none) {
    section.soft("The extremes agree within the 95 % intervals of the joint fit.");
  }
  for (std::string& note : notes) section.soft(std::move(note));
}

/// Two figures with as many digits as show that they differ.
std::string distinct(double first, double second) {
  constexpr int kFewest = 3, kMost = 6;
  int digits = kFewest;
  while (digits < kMost && significant(first, digits) == significant(second, digits)) ++digits;
  return significant(first, digits) + " against " + significant(second, digits);
}

}  // namespace

Facts model_facts(const char* name, std::span<const Fit> fits, std::size_t best, const Motion& motion) {
  if (best >= fits.size() || fits[best].parameters.empty()) return {};
  Facts facts = {{name, curve_name(fits[best])}};
  for (const FitParameter& p : fits[best].parameters) facts.emplace_back(full_name(p), value_text(p, motion));
  return facts;
}

ReportTable value_table(const char* name, const std::vector<ResultParameter>& values) {
  std::vector<std::string> errors, parts, intervals, units;
  ReportTable table;
  table.text({name}).numbers({"value"});
  for (const ResultParameter& v : values) {
    const bool known = v.determined && std::isfinite(v.std_error) && v.std_error > 0;
    const int places = known ? places_for(v.std_error) : 0;
    const std::string value = known ? fixed(v.value, places) : significant(v.value, 5);
    table.rows.push_back({full_name(v.name, v.effect), v.determined ? value : "not determined"});
    errors.push_back(known ? fixed(v.std_error, places) : "");
    parts.push_back(known && v.value != 0 ? "(" + percent(v.std_error / std::abs(v.value)) + ")" : "");
    intervals.push_back(known && std::isfinite(v.lower95) ? interval_text(v.lower95, v.upper95, places)
                        : v.determined                    ? ""
                                                          : limits_text(v));
    units.push_back(v.unit);
  }
  const auto some_unknown = [](std::vector<std::string> cells) {
    const auto empty = [](const std::string& cell) { return cell.empty(); };
    if (!std::all_of(cells.begin(), cells.end(), empty)) std::replace_if(cells.begin(), cells.end(), empty, "-");
    return cells;
  };
  table.add({"std error", true, 1}, some_unknown(std::move(errors)));
  table.add({"relative", true, 2}, std::move(parts));
  table.add({"95 % interval", true}, some_unknown(std::move(intervals)));
  table.add({"unit"}, std::move(units));
  return table;
}

std::string remarks_on(std::span<const FitParameter> parameters, std::span<const Correlation> correlations,
                       std::size_t index) {
  const bool correlated = std::any_of(correlations.begin(), correlations.end(),
                                      [&](const Correlation& c) { return c.first == index || c.second == index; });
  std::string remarks = parameters[index].at_bound ? "at bound" : "";
  if (correlated) remarks += remarks.empty() ? "correlated" : ", correlated";
  return remarks;
}

ReportTable parameter_table(const Fit& fit, const Motion& motion, bool systematic) {
  const std::vector<ResultParameter> values = results_of(fit.parameters, motion);
  std::vector<std::string> profiles, errors, starts, remarks;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const ResultParameter& p = values[k];
    const int places = places_of(p);
    const bool profile = p.determined && std::isfinite(p.profile_lower95) && p.profile_lower95 < p.profile_upper95;
    profiles.push_back(profile ? interval_text(p.profile_lower95, p.profile_upper95, places) : "");
    // Nothing declared that bears on it is not the same as no uncertainty.
    errors.push_back(std::isnan(p.systematic)           ? "unknown"
                     : p.systematic > 0 && p.determined ? fixed(p.systematic, places)
                     : systematic || p.systematic != 0  ? "-"
                                                        : "");
    starts.push_back(significant(p.start, 3));
    remarks.push_back(remarks_on(fit.parameters, fit.correlations, k));
    if (p.value == p.start && fit.protocol == Protocol::joint)
      remarks.back() += remarks.back().empty() ? "unmoved" : ", unmoved";
  }
  ReportTable table = value_table("parameter", values);
  table.add({"by profile", true}, std::move(profiles));
  table.add({"systematic", true}, std::move(errors));
  table.add({"start", true, 3}, std::move(starts));
  table.add({"remarks"}, std::move(remarks));
  return table;
}

void add_fits(std::span<const Fit> fits, std::size_t best, const Motion& motion, bool instruments_declared,
              ReportSection& section) {
  if (fits.empty()) return;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const std::size_t begin = section.items.size();
    add_fit(fits[k], motion, k == best && fits.size() > 1, instruments_declared, section);
    if (joint_partner(fits, fits[k]) == nullptr) continue;  // a text compares its values with the joint fit's only
    for (std::size_t i = begin; i < section.items.size(); ++i) section.items[i].medium = Medium::page;
  }
  section.heading("Intervals and range");
  section.soft(fmt::format(
      "Intervals are statistical, from {}; {}.", motion.is_points() ? "point to point" : "cycle to cycle",
      instruments_declared ? "systematic is one standard uncertainty from the declared instruments, not part of them"
                           : "no instrument uncertainties declared (--instruments), so there is no systematic part"));
  if (fits[best].fastest > 0) {
    section.soft(fmt::format("The data reach |v_r| = {} mm/s; beyond that the laws are extrapolated.",
                             significant(fits[best].fastest / kMillimetre, 3)));
  }
}

void add_comparisons(std::span<const Fit> fits, std::size_t best, const Motion& motion, ReportSection& section) {
  add_protocols(fits, motion, section);
  const std::vector<LawComparison> comparisons = compare_laws(fits, best);
  if (!comparisons.empty()) section.heading("Which law");
  for (const LawComparison& c : comparisons) {
    const Fit *first = &fits[c.first], *second = &fits[c.second];
    const std::string figures = fmt::format("{}, {}", distinct(first->error.held_out_rmse, second->error.held_out_rmse),
                                            p_value_text(c.comparison.p_value));
    if (c.clear && !c.comparison.first_better) std::swap(first, second);
    section.plain(
        fmt::format(fmt::runtime(c.clear ? "{} has the smaller held-out error than {} ({})."
                                         : "{} and {} are not distinguishable with these data (held-out error "
                                           "{})."),
                    first->model.name(), second->model.name(), figures));
  }
}

}  // namespace tribofit
