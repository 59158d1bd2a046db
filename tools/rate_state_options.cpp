#include <algorithm>
#include <array>

#include "settings.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/text.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

constexpr std::array<StateParameter, 7> kStateParameters = {{{"a", Quantity::dimensionless},
                                                             {"b", Quantity::dimensionless},
                                                             {"D_c", Quantity::length},
                                                             {"b_2", Quantity::dimensionless},
                                                             {"D_c2", Quantity::length},
                                                             {"k", Quantity::inverse_length},
                                                             {"mu_0", Quantity::dimensionless}}};

}  // namespace

std::vector<std::string> state_parameter_names() {
  std::vector<std::string> names;
  for (const StateParameter& parameter : kStateParameters) names.emplace_back(parameter.name);
  return names;
}

const StateParameter* find_state_parameter(std::string_view name) {
  const auto at = std::ranges::find(kStateParameters, name, &StateParameter::name);
  return at == kStateParameters.end() ? nullptr : at;
}

double StateParameter::value(std::string text, const std::string& option, bool in_newtons) const {
  if (quantity == Quantity::inverse_length && unit_of(text).starts_with('/') && text.front() != '/')
    text.insert(text.find('/'), " 1");  // "0.005/um" is 0.005 1/um
  const Quantity own = !in_newtons                            ? quantity
                       : quantity == Quantity::inverse_length ? Quantity::stiffness
                                                              : Quantity::force;
  return stated_value(text, own, option + " " + std::string(name));
}

std::map<std::string, double> rate_state_values(const std::string& text, const std::string& option) {
  const std::string example = "NAME=VALUE of " + enumerated(state_parameter_names(), "or");
  std::map<std::string, double> values;
  for (const auto& [name, value] : named_texts({text}, option, example)) {
    const StateParameter* parameter = find_state_parameter(name);
    if (parameter == nullptr) throw UsageError(option + ": '" + name + "=" + value + "' is not " + example);
    values[name] = parameter->value(value, option);
  }
  return values;
}

bool names_load_point_speeds(const Settings& s) {
  return s.speed.find(':') != std::string::npos;
}

std::vector<LoadPointPhase> phases_from(const std::string& text, const std::string& option) {
  const std::string example = "TIME:SPEED, as in 0s:2um/s,60s:10um/s";
  std::vector<LoadPointPhase> phases;
  for (const std::string& part : split(text, ',')) {
    const auto [time, rest] = as_usage([&] { return two_parts(part, ":", option, example); });
    const double begin = stated_value(time, Quantity::time, option);
    const double value = stated_value(rest, Quantity::velocity, option);
    if (!phases.empty() && !(begin > phases.back().begin))
      throw UsageError(option + ": '" + part + "' does not come after the time before it");
    if (!(value >= 0)) throw UsageError(option + ": '" + part + "' goes backwards; give speeds of at least 0");
    phases.push_back({begin, value});
  }
  return phases;
}
