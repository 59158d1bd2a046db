#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment.hpp"
#include "fit_steps.hpp"
#include "limits.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

namespace {

/// "alpha", "rate-state D_c".
std::string shown_name(const FitParameter& p) {
  return p.effect.empty() ? p.parameter.name : p.effect + " " + p.parameter.name;
}

void add_correlations(Fit& fit) {
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    for (std::size_t j = i + 1; j < fit.parameters.size(); ++j) {
      const double correlation = fit.correlation(i, j);
      if (std::abs(correlation) >= kStrongCorrelation) fit.correlations.push_back({i, j, correlation});
    }
  }
  std::sort(fit.correlations.begin(), fit.correlations.end(),
            [](const Correlation& a, const Correlation& b) { return std::abs(a.value) > std::abs(b.value); });
}

/// Errors are those of a law that holds.
void add_condition(Fit& fit) {
  if (!is_conditional(fit)) return;
  fit.messages.push_back(
      fmt::format("errors and intervals assume that the law is right, {}: the held-out error is {} the noise floor",
                  is_clearly_above_floor(fit) ? "but it is not" : "and it may not be",
                  is_far_above_floor(fit) ? "far above" : fmt::format("{} times", fixed(over_floor(fit), 1))));
}

void add_undetermined(const std::vector<std::vector<std::size_t>>& groups, Fit& fit) {
  for (const std::vector<std::size_t>& group : groups) {
    std::string names;
    for (const std::size_t k : group) {
      names += (names.empty() ? "" : k == group.back() ? " and " : ", ") + shown_name(fit.parameters[k]);
    }
    fit.messages.push_back(
        names + " are not determined: the data fix only a combination of them, so none has an interval of its own");
  }
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const bool alone = std::none_of(groups.begin(), groups.end(), [k](const std::vector<std::size_t>& group) {
      return std::find(group.begin(), group.end(), k) != group.end();
    });
    if (!fit.parameters[k].determined && alone) {
      fit.messages.push_back(shown_name(fit.parameters[k]) +
                             " is not determined: its 95 % interval holds every value within its bounds");
    }
  }
}

/// Parameters that no sample depends on, and those at a bound.
void add_bounded(const std::vector<bool>& unconstrained, Fit& fit) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    if (unconstrained[k] && fit.protocol == Protocol::joint) {
      fit.messages.push_back(fmt::format("{} is unconstrained: no sample depends on it", shown_name(p)));
    } else if (p.at_bound) {
      const bool low = std::abs(p.value / p.parameter.si - p.parameter.lower) <
                       std::abs(p.value / p.parameter.si - p.parameter.upper);
      fit.messages.push_back(fmt::format("{} is at its {} bound of {}{}", shown_name(p), low ? "lower" : "upper",
                                         general(low ? p.parameter.lower : p.parameter.upper),
                                         p.parameter.unit == "1" ? "" : " " + p.parameter.unit));
    }
  }
}

void add_correlated(Fit& fit) {
  for (const Correlation& c : fit.correlations) {
    fit.messages.push_back(fmt::format("{} and {} are strongly correlated ({}): the data fix a combination of them",
                                       shown_name(fit.parameters[c.first]), shown_name(fit.parameters[c.second]),
                                       with_sign(c.value, 2)));
  }
}

/// Levels of friction that lie beyond the speeds that were recorded.
void add_extrapolated(Fit& fit) {
  const FrictionModel& model = fit.model;
  const std::vector<double> p = fit.values();
  const std::optional<double> at_slowest = remaining_fall(model.law(), p, fit.slowest);
  if (!at_slowest) return;
  const double missing = 1 - *at_slowest;
  if (missing > kExtrapolated) {
    fit.messages.push_back(
        fmt::format("mu_s is extrapolated: nothing was recorded below {} mm/s, where {} % of the drop to mu_k "
                    "has already happened",
                    fixed(fit.slowest * 1e3, 1), fixed(100 * missing, 0)));
  }
  const double reached = remaining_fall(model.law(), p, fit.fastest).value_or(0);
  const double drop = std::abs(fit.parameters[0].value - fit.parameters[1].value);
  if (reached > kExtrapolated && drop > 0) {
    fit.messages.push_back(
        fmt::format("mu_k is extrapolated: at the fastest slip ({} mm/s) {} % of the drop from mu_s is still to come",
                    fixed(fit.fastest * 1e3, 1), fixed(100 * reached, 0)));
  }
}

}  // namespace

void add_messages(const Freedom& freedom, Fit& fit) {
  add_condition(fit);
  add_undetermined(freedom.groups, fit);
  add_correlations(fit);
  add_bounded(freedom.unconstrained, fit);
  add_correlated(fit);
  add_extrapolated(fit);
}

}  // namespace tribofit
