#include <fmt/format.h>

#include <string>

#include "rate_state_errors.hpp"

namespace tribofit::fit {

void add_messages(RateStateFit& fit) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    const std::string& name = p.parameter.name;
    const double si = p.parameter.si;
    if (p.at_bound) {
      const bool upper = p.value / si > 0.5 * (p.parameter.lower + p.parameter.upper);
      fit.messages.push_back(
          name == "k" && upper
              ? fmt::format("k is not resolved: the machine is stiffer than the samples behind the steps can show; "
                            "sample faster there, or hold k by --bounds")
              : fmt::format("{} ended at its {} bound, {:.4g} {}", name, upper ? "upper" : "lower", p.value / si,
                            p.parameter.unit));
    } else if (!p.determined) {
      fit.messages.push_back(
          fmt::format("{} is not known from these data: its 95 % interval reaches from {:.3g} to "
                      "{:.3g} {}",
                      name, p.lower95 / si, p.upper95 / si, p.parameter.unit));
    }
  }
  for (const Correlation& c : fit.correlations) {
    fit.messages.push_back(
        fmt::format("{} and {} are correlated by {:.3f}: the data fix a combination of them better "
                    "than either",
                    fit.parameters[c.first].parameter.name, fit.parameters[c.second].parameter.name, c.value));
  }
}

}  // namespace tribofit::fit
