#include "parameter_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "measures.hpp"
#include "numbers.hpp"
#include "tribofit/fit/identification.hpp"

namespace tribofit {

std::string_view equation(BaseLaw law) {
  switch (law) {
    case BaseLaw::exponential:
      return "mu = mu_k + (mu_s - mu_k) exp(-alpha v)";
    case BaseLaw::fractional:
      return "mu = mu_k + (mu_s - mu_k) / (1 + beta v)";
    case BaseLaw::coulomb:
      break;
  }
  return "mu = mu_k in slip, mu_s at break-away";
}

std::string flags_of(const Fit& fit, std::size_t index) {
  const FitParameter& p = fit.parameters[index];
  std::string flags;
  const auto add = [&](std::string_view flag) { flags += (flags.empty() ? "" : ", ") + std::string(flag); };
  if (p.at_bound) add("at bound");
  if (p.value == p.start && fit.protocol == Protocol::joint) add("unmoved");
  const bool correlated = std::any_of(fit.correlations.begin(), fit.correlations.end(),
                                      [&](const Correlation& c) { return c.first == index || c.second == index; });
  if (correlated) add("correlated");
  if (!p.determined) add("not determined");
  return flags;
}

std::string bracket(double lower, double upper, int places) {
  if (!std::isfinite(lower) && !std::isfinite(upper)) return "-";
  return "[" + fixed(lower, places) + ", " + fixed(upper, places) + "]";
}

int places_of(const FitParameter& p) {
  const double error = shown(p, p.std_error);
  if (std::isfinite(error) && error > 0) return places_for(error);
  const double value = std::abs(shown(p, p.value));
  return value > 0 && std::isfinite(value) ? std::max(0, 4 - static_cast<int>(std::floor(std::log10(value)))) : 4;
}

const Fit* partner_of(const Identification& r, const Fit& fit) {
  for (const Fit& other : r.fits) {
    if (other.protocol == Protocol::joint && other.model.law() == fit.model.law()) return &other;
  }
  return nullptr;
}

std::vector<ProtocolRow> protocol_rows(const Identification& r) {
  std::vector<ProtocolRow> rows;
  for (const Fit& fit : r.fits) {
    if (fit.protocol != Protocol::published) continue;
    const Fit* joint = partner_of(r, fit);
    if (joint == nullptr || !joint->converged) continue;
    for (std::size_t k = 0; k < std::min(fit.parameters.size(), joint->parameters.size()); ++k) {
      const FitParameter& a = fit.parameters[k];
      const FitParameter& b = joint->parameters[k];
      const int places = places_of(b);
      rows.push_back(
          {{k == 0 ? fit.model.name() : "", b.parameter.name, fixed(shown(a, a.value), places),
            fixed(shown(b, b.value), places),
            b.value != 0 ? fmt::format("{:+.1f} %", 100 * (a.value / b.value - 1)) : "-", shown_unit(b, r.motion)},
           a.value < b.lower95 || a.value > b.upper95});
    }
  }
  return rows;
}

std::vector<std::string> comparison_sentences(const Identification& r) {
  std::vector<std::string> sentences;
  for (const LawComparison& c : compare_laws(r.fits, r.best)) {
    const std::string first = r.fits[c.first].model.name(), second = r.fits[c.second].model.name();
    const std::string figures =
        fmt::format("held-out RMSE {} against {}, p {}", significant(r.fits[c.first].error.held_out_rmse, 3),
                    significant(r.fits[c.second].error.held_out_rmse, 3),
                    c.comparison.p_value < 1e-4 ? "< 0.0001" : "= " + significant(c.comparison.p_value, 2));
    const bool clear = c.comparison.p_value < 0.05;
    sentences.push_back(
        clear ? fmt::format("{} predicts data it has not seen better than {} ({})",
                            c.comparison.first_better ? first : second, c.comparison.first_better ? second : first,
                            figures)
              : fmt::format("{} and {} cannot be told apart with these data ({})", first, second, figures));
  }
  return sentences;
}

}  // namespace tribofit
