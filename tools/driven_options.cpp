#include <algorithm>
#include <array>
#include <string_view>

#include "exit_status.hpp"
#include "settings.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "typed_values.hpp"

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
  return names_load_point_speeds(s) || is_driven_in_steps(s.identify.read.kind);
}

/// What is stated, or else the file, may say that the load point is driven in steps.
bool may_be_driven(const Settings& s) {
  return !s.identify.read.kind || is_stated(s);
}

const Named* find_parameter(std::string_view name) {
  const auto at = std::find_if(kParameters.begin(), kParameters.end(), [&](const Named& p) { return p.name == name; });
  return at == kParameters.end() ? nullptr : &*at;
}

/// A bare number would be one of metres: a million times what is meant.
void require_unit(std::string_view text, const std::string& option, const char* example) {
  if (is_bare_number(text))
    throw UsageError(option + ": '" + std::string(trimmed(text)) + "' has no unit; give it, as in " + example);
}

/// "0.005/um" is 0.005 1/um.
double value_of(std::string spelled, const Named& parameter, const std::string& option, Quantity quantity) {
  if (parameter.quantity != Quantity::dimensionless) require_unit(spelled, option, parameter.example);
  if (parameter.quantity == Quantity::inverse_length && unit_of(spelled).starts_with('/') && spelled.front() != '/')
    spelled.insert(spelled.find('/'), " 1");
  return parse_quantity(spelled, quantity, option + " " + std::string(parameter.name));
}

/// A value of a fit: of friction in newtons a and b are forces, and k is a stiffness.
double given_value(const std::string& text, const Named& parameter, const std::string& option,
                   RateStateOptions& options) {
  const bool in_newtons = parameter.quantity != Quantity::length && text.find('N') != std::string::npos;
  options.given_in_newtons = options.given_in_newtons || in_newtons;
  const Quantity quantity = !in_newtons                                      ? parameter.quantity
                            : parameter.quantity == Quantity::inverse_length ? Quantity::stiffness
                                                                             : Quantity::force;
  return value_of(text, parameter, option, quantity);
}

}  // namespace

bool is_rate_state_parameter(const Settings& s, const std::string& name) {
  return may_be_driven(s) && find_parameter(name) != nullptr;
}

void read_driven(const Settings& s, const std::vector<GivenParameter>& of_laws, RateStateOptions& options) {
  if (!may_be_driven(s)) return;
  /// Those that name one of these parameters.
  const auto own = [&](const std::vector<std::string>& texts, const std::string& option, const char* example) {
    NamedTexts found = named_texts(texts, option, example);
    std::erase_if(found, [&](const auto& named) {
      const auto is_its = [&](const GivenParameter& g) { return g.name == named.first; };
      return find_parameter(named.first) == nullptr ||
             (!is_stated(s) && std::any_of(of_laws.begin(), of_laws.end(), is_its));
    });
    return found;
  };
  for (const auto& [name, text] : own(s.start_values, "--start", kStartExample))
    given_entry(name, options.given).start = given_value(text, *find_parameter(name), "--start", options);
  for (const auto& [name, text] : own(s.bounds, "--bounds", kBoundsExample)) {
    const Named& parameter = *find_parameter(name);
    const auto [low, high] = as_usage([&, &typed = text] { return range_ends(typed, "--bounds", "D_c=2um..50um"); });
    const GivenParameter::Bounds bounds = {given_value(low, parameter, "--bounds", options),
                                           given_value(high, parameter, "--bounds", options)};
    const bool positive = parameter.quantity == Quantity::dimensionless || bounds.lower > 0;
    if (bounds.lower > bounds.upper || !positive)
      throw UsageError("--bounds: '" + text + "' of " + name +
                       (positive ? " runs from high to low" : " begins at zero or below"));
    given_entry(name, options.given).bounds = bounds;
  }
}

std::map<std::string, double> rate_state_values(const std::string& text, const std::string& option) {
  const std::string example = "NAME=VALUE of a, b, D_c, k, mu_0, b_2 or D_c2";
  std::map<std::string, double> values;
  if (text.empty()) return values;
  for (const auto& [name, value] : named_texts({text}, option, example)) {
    const Named* parameter = name == kBaseFriction.name ? &kBaseFriction : find_parameter(name);
    if (parameter == nullptr) throw UsageError(option + ": '" + name + "=" + value + "' is not " + example);
    values[name] = value_of(value, *parameter, option, parameter->quantity);
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
    const double begin = stated_value(time, Quantity::time, option, "s");
    const std::string speed(trimmed(rest));
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
  return positive_value(text, Quantity::velocity, "--reference-speed");
}
