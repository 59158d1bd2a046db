#include "driven_options.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "exit_status.hpp"
#include "stated_value.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

using namespace tribofit;

namespace {

struct Named {
  std::string_view name;
  Quantity quantity;
  const char* example;
};
constexpr std::array<Named, 6> kParameters = {{{"a", Quantity::dimensionless, "a=0.01"},
                                               {"b", Quantity::dimensionless, "b=0.012"},
                                               {"D_c", Quantity::length, "D_c=10um"},
                                               {"b_2", Quantity::dimensionless, "b_2=0.002"},
                                               {"D_c2", Quantity::length, "D_c2=100um"},
                                               {"k", Quantity::inverse_length, "k=0.005/um"}}};

constexpr Named kBaseFriction = {"mu_0", Quantity::dimensionless, "mu_0=0.6"};

bool is_stated(const Settings& s) {
  return names_load_point_speeds(s) || is_driven_in_steps(find_record_kind(s.kind));
}

/// What is stated, or else the file, may say that the load point is driven in steps.
bool may_be_driven(const Settings& s) {
  return s.kind.empty() || is_stated(s);
}

const Named* find_parameter(std::string_view name) {
  const auto at = std::find_if(kParameters.begin(), kParameters.end(), [&](const Named& p) { return p.name == name; });
  return at == kParameters.end() ? nullptr : &*at;
}

/// A bare number would be one of metres: a million times what is meant.
void require_unit(std::string_view text, const std::string& option, const char* example) {
  const std::string_view spelled = trimmed(text);
  if (!spelled.empty() && spelled.find_first_not_of("+-.0123456789eE ") == std::string_view::npos)
    throw UsageError(option + ": '" + std::string(spelled) + "' has no unit; give it, as in " + example);
}

/// "0.005/um" is 0.005 1/um.
double parameter_value(const std::string& text, const Named& parameter, const std::string& option, Quantity quantity) {
  std::string spelled(trimmed(text));
  if (parameter.quantity != Quantity::dimensionless) require_unit(spelled, option, parameter.example);
  const std::size_t slash = spelled.find('/');
  if (parameter.quantity == Quantity::inverse_length && slash != std::string::npos && slash > 0 &&
      spelled.find_first_not_of("+-.0123456789eE ") == slash)
    spelled.insert(slash, " 1");
  return parse_quantity(spelled, quantity, option + " " + std::string(parameter.name));
}

GivenParameter& entry_named(std::string_view name, std::vector<GivenParameter>& given) {
  const auto found = std::find_if(given.begin(), given.end(), [&](const auto& g) { return g.name == name; });
  if (found != given.end()) return *found;
  given.push_back({std::string(name), std::nullopt, std::nullopt});
  return given.back();
}

/// Calls take(parameter, text) for each "NAME=TEXT" that names one of these parameters.
template <class Take>
void for_each_given(const std::vector<std::string>& texts, const std::vector<GivenParameter>& fitted, Take&& take) {
  for (const std::string& text : texts) {
    for (const std::string& part : split(text, ',')) {
      const std::size_t equals = part.find('=');
      if (equals == std::string::npos) continue;
      const Named* parameter = find_parameter(trimmed(std::string_view(part).substr(0, equals)));
      const auto is_its = [&](const GivenParameter& g) {
        return g.name == parameter->name || g.name.ends_with("." + std::string(parameter->name));
      };
      if (parameter == nullptr || std::any_of(fitted.begin(), fitted.end(), is_its)) continue;
      take(*parameter, part.substr(equals + 1));
    }
  }
}

/// A value of a fit: of friction in newtons a and b are forces, and k is a stiffness.
double given_value(const std::string& text, const Named& parameter, const std::string& option,
                   RateStateOptions& options) {
  const bool in_newtons = parameter.quantity != Quantity::length && text.find('N') != std::string::npos;
  options.given_in_newtons = options.given_in_newtons || in_newtons;
  const Quantity quantity = !in_newtons                                      ? parameter.quantity
                            : parameter.quantity == Quantity::inverse_length ? Quantity::stiffness
                                                                             : Quantity::force;
  return parameter_value(text, parameter, option, quantity);
}

/// fitted: what is given of other names.
void read_given(const Settings& s, const std::vector<GivenParameter>& fitted, RateStateOptions& options) {
  std::vector<GivenParameter>& given = options.given;
  for_each_given(s.start_values, fitted, [&](const Named& parameter, const std::string& text) {
    entry_named(parameter.name, given).start = given_value(text, parameter, "--start", options);
  });
  for_each_given(s.bounds, fitted, [&](const Named& parameter, const std::string& text) {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos) throw UsageError("--bounds: '" + text + "' is not FROM..TO, as in D_c=2um..50um");
    std::string low = text.substr(0, dots), high = text.substr(dots + 2);
    const std::size_t unit = high.find_first_not_of("+-.0123456789eE ");
    if (unit != std::string::npos && low.find_first_not_of("+-.0123456789eE ") == std::string::npos)
      low += high.substr(unit);
    const GivenParameter::Bounds bounds = {given_value(low, parameter, "--bounds", options),
                                           given_value(high, parameter, "--bounds", options)};
    const bool positive = parameter.quantity == Quantity::dimensionless || bounds.lower > 0;
    if (bounds.lower > bounds.upper || !positive)
      throw UsageError("--bounds: '" + text + "' of " + std::string(parameter.name) +
                       (positive ? " runs from high to low" : " begins at zero or below"));
    entry_named(parameter.name, given).bounds = bounds;
  });
}

}  // namespace

bool is_rate_state_parameter(const Settings& s, const std::string& name) {
  return may_be_driven(s) && find_parameter(name) != nullptr;
}

std::map<std::string, double> rate_state_values(const std::string& text, const std::string& option) {
  std::map<std::string, double> values;
  if (text.empty()) return values;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string name(trimmed(std::string_view(part).substr(0, equals)));
    const Named* parameter = name == "mu_0" ? &kBaseFriction : find_parameter(name);
    if (equals == std::string::npos || parameter == nullptr)
      throw UsageError(option + ": '" + part + "' is not NAME=VALUE of a, b, D_c, k, mu_0, b_2 or D_c2");
    values[name] = parameter_value(part.substr(equals + 1), *parameter, option, parameter->quantity);
  }
  return values;
}

bool names_load_point_speeds(const Settings& s) {
  return s.speed.find(':') != std::string::npos;
}

std::vector<LoadPointPhase> phases_from(const std::string& text, const std::string& option) {
  std::vector<LoadPointPhase> phases;
  for (const std::string& part : split(text, ',')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos)
      throw UsageError(option + ": '" + part + "' is not TIME:SPEED, as in 0s:2um/s,60s:10um/s");
    const double begin = stated_value(part.substr(0, colon), Quantity::time, option, "s");
    const std::string speed(trimmed(part.substr(colon + 1)));
    const bool rests = !speed.empty() && speed.find_first_not_of("0.") == std::string::npos;
    if (!rests) require_unit(speed, option, "0s:2um/s,60s:10um/s");
    const double value = rests ? 0 : stated_value(speed, Quantity::velocity, option);
    if (!phases.empty() && !(begin > phases.back().begin))
      throw UsageError(option + ": '" + part + "' does not come after the time before it");
    if (!(value >= 0)) throw UsageError(option + ": '" + part + "' goes backwards; give speeds of at least 0");
    phases.push_back({begin, value});
  }
  return phases;
}

std::vector<LoadPointPhase> load_point_from(const Settings& s, std::optional<RecordKind> kind) {
  if (s.speed.empty() || !is_driven_in_steps(kind)) return {};
  if (!names_load_point_speeds(s))
    throw UsageError("--speed of a load point is stated by time, 0s:2um/s,60s:10um/s; one speed alone has no steps");
  return phases_from(s.speed, "--speed");
}

double reference_speed_from(const std::string& text) {
  require_unit(text, "--reference-speed", "1um/s");
  const double speed = stated_value(text, Quantity::velocity, "--reference-speed");
  if (!(speed > 0)) throw UsageError("--reference-speed is not above zero");
  return speed;
}

RateStateOptions driven_options_from(const Settings& s, const std::vector<GivenParameter>& fitted) {
  RateStateOptions options;
  if (!s.evolutions.empty()) options.evolutions.clear();
  for (const std::string& name : s.evolutions) {
    const auto found = find_state_evolution(name);
    const auto& known = options.evolutions;
    if (found && std::find(known.begin(), known.end(), *found) == known.end()) options.evolutions.push_back(*found);
  }
  options.states = static_cast<std::size_t>(s.states);
  options.detrend = find_detrend(s.detrend).value_or(Detrend::automatic);
  if (!s.reference_speed.empty()) {
    options.reference_speed = reference_speed_from(s.reference_speed);
  }
  if (!s.from.empty()) options.from = stated_value(s.from, Quantity::time, "--from", "s");
  if (!s.to.empty()) options.to = stated_value(s.to, Quantity::time, "--to", "s");
  if (!(options.from < options.to)) throw UsageError("--from and --to leave nothing between them");
  if (may_be_driven(s)) read_given(s, is_stated(s) ? std::vector<GivenParameter>() : fitted, options);
  return options;
}
