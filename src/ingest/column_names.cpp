#include "column_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "tribofit/ingest/file_names.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

struct Names {
  Channel channel;
  std::vector<std::string_view> names;  // lower case without separators, the most usual first
};

const std::vector<Names>& names_of_the_field() {
  static const std::vector<Names> table = {
      {Channel::time,
       {"time", "t", "timestamp", "elapsedtime", "testtime", "steptime", "xvalue", "zeit", "temps", "\u65f6\u95f4"}},
      {Channel::mu,
       {"mu", "\u03bc", "\u00b5", "cof", "frictioncoefficient", "coefficientoffriction", "coeffriction",
        "coeffoffriction", "friction", "frictioncoeff", "tractioncoeff", "tractioncoefficient", "reibwert",
        "reibungszahl", "reibungskoeffizient", "\u6469\u64e6\u7cfb\u6570", "\u6469\u64e6\u56e0\u6570"}},
      {Channel::v_b,
       {"vb", "blockvelocity", "blockspeed", "vibrometer", "velocity", "vibrometervelocity", "v", "geschwindigkeit",
        "\u901f\u5ea6"}},
      {Channel::v_r,
       {"vr", "slidingvelocity", "relativevelocity", "slidingspeed", "rubbingvelocity", "rubbingspeed", "rubbing",
        "vrel", "slipvelocity", "vslip", "gleitgeschwindigkeit", "\u76f8\u5bf9\u901f\u5ea6",
        "\u6ed1\u52a8\u901f\u5ea6"}},
      {Channel::force,
       {"ft", "frictionforce", "tangentialforce", "fx", "ff", "ffriction", "force", "lateralforce", "tractionforce",
        "kraft", "reibkraft", "shearforce", "shearload", "shearstress", "shrstress", "shstress", "tau", "schubspannung",
        "\u6469\u64e6\u529b"}},
      {Channel::torque,
       {"torque", "frictiontorque", "m", "moment", "drehmoment", "reibmoment", "\u626d\u77e9", "\u8f6c\u77e9"}},
      {Channel::load,
       {"fn", "normalforce", "load", "normalload", "fz", "weight", "wob", "weightonbit", "ballload", "normalkraft",
        "normalstress", "effectivenormalstress", "effnormalstress", "norstress", "sigman", "normalspannung",
        "\u8f7d\u8377", "\u6b63\u538b\u529b", "\u6cd5\u5411\u529b"}},
      {Channel::speed,
       {"discspeed", "diskspeed", "rpm", "speed", "rotationalspeed", "rotaryvelocity", "spindlespeed", "omega",
        "discvelocity", "angularvelocity", "rotaryspeed", "drehzahl", "\u8f6c\u901f"}},
      {Channel::angle,
       {"angle", "discangle", "diskangle", "rotaryposition", "theta", "phi", "position", "winkel", "\u89d2\u5ea6"}},
      {Channel::temperature, {"temperature", "temp", "temperatur", "\u6e29\u5ea6"}},
      {Channel::std_error,
       {"stderror", "standarderror", "stderr", "muerror", "mustderror", "frictionstderror", "uncertainty", "sem",
        "se"}},
      {Channel::spring, {"spring", "springforce", "springpull", "pull", "fspring", "federkraft"}},
      {Channel::x_b,
       {"xb", "blockdisplacement", "blockposition", "sliderdisplacement", "sliderposition", "massdisplacement"}},
      {Channel::x_d,
       {"xd", "drivedisplacement", "driveposition", "basedisplacement", "baseposition", "stagedisplacement",
        "stageposition", "carriagedisplacement", "carriageposition", "lpdisp", "lpdisplacement",
        "loadpointdisplacement", "loadpointdisp", "lpdispl", "loadpointposition", "loadpoint", "xlp", "ramdisplacement",
        "pistondisplacement"}},
      {Channel::v_lp,
       {"vlp", "loadpointvelocity", "loadpointspeed", "loadpointrate", "lpvelocity", "lpspeed", "drivevelocity",
        "drivingvelocity", "ramvelocity"}},
      {Channel::step, {kStepColumn, "recipestep", "stepnumber", "segment"}},
  };
  return table;
}

/// Names that need a unit to be believed: a velocity is as often the carriage's, a position a height.
bool needs_unit(std::string_view base, Channel channel) {
  return (channel == Channel::angle && base == "position") || (channel == Channel::torque && base == "m") ||
         base == "tau";
}

/// The longest end of "a_b_c" that is a unit when '_' is read as '/': {"v_b", "mm/s"} of "v_b_mm_s".
std::optional<std::pair<std::string, std::string>> split_unit_at_end(const std::string& name) {
  for (std::size_t at = name.find('_', 1); at != std::string::npos; at = name.find('_', at + 1)) {
    const std::string end = name.substr(at + 1);
    if (end.empty() || end == "1" || end == "-" || end == "t" || end == "h" || end == "g") continue;
    std::string quotient = replaced(replaced(end, "_per_", "/"), "_", "/");
    for (const auto& [from, to] : {std::pair{"/s2", "/s^2"}, std::pair{"/s/2", "/s^2"}})
      quotient = replaced(quotient, from, to);
    if (find_unit(quotient)) return std::pair{name.substr(0, at), quotient};
  }
  return std::nullopt;
}

std::string base_of(std::string_view text) {
  std::string_view name = text;
  if (const std::size_t dot = name.rfind('.'); dot != std::string_view::npos && dot + 1 < name.size()) {
    name = name.substr(dot + 1);
  }
  name = name.substr(0, name.find_first_of(",(", 1));  // "v_b, laser", "Velocity (laser)"
  std::string base;
  for (const char c : lower_case(name)) {
    if (std::string_view(" _-.\"'").find(c) == std::string_view::npos) base += c;
  }
  return base;
}

/// Quantity in the numerator of a sensitivity, as the channel's own.
std::optional<double> value_in(std::string_view number, std::string_view unit, Channel channel) {
  for (const Quantity quantity : quantities(channel)) {
    if (find_unit(unit, quantity)) {
      return parse_quantity(std::string(number) + std::string(unit), quantity, to_string(channel));
    }
  }
  return std::nullopt;
}

}  // namespace

std::string lists_columns(const std::string& path) {
  return fmt::format("'identify columns {}' lists what it holds", path);
}

std::string_view to_string(Channel channel) {
  return kChannelNames[index_of(channel)];
}

const Column* Columns::find(Channel channel) const {
  const auto at = std::find_if(used.begin(), used.end(), [&](const Column& c) { return c.channel == channel; });
  return at != used.end() ? &*at : nullptr;
}

bool is_field_name(std::string_view base) {
  const auto& table = names_of_the_field();
  return std::any_of(table.begin(), table.end(), [&](const Names& names) {
    return std::find(names.names.begin(), names.names.end(), base) != names.names.end();
  });
}

std::size_t name_rank(std::string_view base, Channel channel, std::optional<Quantity> quantity) {
  const auto& table = names_of_the_field();
  const auto allowed = quantities(channel);
  const bool rotates = quantity == Quantity::angular_velocity;
  const bool fits = !quantity || allowed.empty() ||
                    std::find(allowed.begin(), allowed.end(), *quantity) != allowed.end() ||
                    *quantity == Quantity::voltage;
  if (needs_unit(base, channel) && !(quantity && fits)) return no_rank;
  // A "velocity" in rpm is the disc's unless the user says otherwise; "speed" in mm/s is a velocity.
  const bool just_velocity = base == "velocity" || base == "v" || base == "geschwindigkeit" || base == "\u901f\u5ea6";
  if (rotates && just_velocity && channel == Channel::v_b) return no_rank;
  if (rotates && just_velocity && channel == Channel::speed) return 100;
  if (channel == Channel::v_r && base == "speed" && quantity == Quantity::velocity) return 100;
  if ((channel == Channel::speed || channel == Channel::angle) && !fits) return no_rank;
  if (channel == Channel::force && base == "friction" && quantity == Quantity::force) return 100;
  if (channel == Channel::mu && base == "friction" && quantity == Quantity::force) return no_rank;
  const auto& names = table[index_of(channel)].names;
  const auto at = std::find(names.begin(), names.end(), base);
  return at == names.end() ? no_rank : static_cast<std::size_t>(at - names.begin());
}

std::span<const Quantity> quantities(Channel channel) {
  static constexpr std::array velocity = {Quantity::velocity, Quantity::angular_velocity};
  static constexpr std::array<Quantity, 1> time = {Quantity::time}, mu = {Quantity::dimensionless},
                                           torque = {Quantity::torque}, speed = {Quantity::angular_velocity},
                                           angle = {Quantity::angle}, temperature = {Quantity::temperature},
                                           length = {Quantity::length}, load_point = {Quantity::velocity};
  static constexpr std::array force_or_stress = {Quantity::force, Quantity::pressure};
  static constexpr std::array friction = {Quantity::dimensionless, Quantity::force, Quantity::torque};
  static constexpr std::array pull = {Quantity::force, Quantity::dimensionless};
  switch (channel) {
    case Channel::time:
      return time;
    case Channel::mu:
      return mu;
    case Channel::v_b:
    case Channel::v_r:
      return velocity;
    case Channel::force:
    case Channel::load:
      return force_or_stress;
    case Channel::torque:
      return torque;
    case Channel::speed:
      return speed;
    case Channel::angle:
      return angle;
    case Channel::temperature:
      return temperature;
    case Channel::std_error:
      return friction;
    case Channel::spring:
      return pull;
    case Channel::x_b:
    case Channel::x_d:
      return length;
    case Channel::v_lp:
      return load_point;
    case Channel::step:
      break;
  }
  return {};
}

std::string_view usual_unit(Channel channel) {
  static constexpr std::array<std::string_view, channel_count> units = {
      "s", "1", "mm/s", "mm/s", "N", "Nm", "N", "rpm", "deg", "degC", "1", "N", "mm", "mm", "um/s", ""};
  return units[index_of(channel)];
}

std::string_view si_unit(Channel channel) {
  static constexpr std::array<std::string_view, channel_count> units = {
      "s", "1", "m/s", "m/s", "N", "N m", "N", "rad/s", "rad", "degC", "1", "N", "m", "m", "m/s", ""};
  return units[index_of(channel)];
}

bool names_rpm(std::string_view base) {
  return base == "rpm" || base == "drehzahl";
}

std::optional<double> find_sensitivity(std::string_view text, Channel channel) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  const std::size_t digits = static_cast<std::size_t>(end - text.data());
  const std::string_view unit = trimmed(text.substr(digits));
  struct Volt {
    std::string_view below, above;
    double factor;
  };
  for (const auto& [below, above, factor] : {Volt{"/V", "V/", 1}, Volt{"/mV", "mV/", 1e-3}}) {
    if (unit.ends_with(below)) {
      const auto value = value_in(text.substr(0, digits), unit.substr(0, unit.size() - below.size()), channel);
      if (value) return *value / factor;
    }
    if (unit.starts_with(above)) {
      const auto value = value_in("1", strip_brackets(unit.substr(above.size())), channel);
      if (value && number != 0) return *value / (number * factor);
    }
  }
  return std::nullopt;
}

std::string strip_brackets(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 &&
      ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'))) {
    text = trimmed(text.substr(1, text.size() - 2));
  }
  return std::string(text);
}

ColumnName parse_column_name(std::string_view text) {
  std::string name(trimmed(text));
  for (const auto& [from, to] : {std::pair{"\uff08", "("}, std::pair{"\uff09", ")"}}) name = replaced(name, from, to);
  const auto unbracketed = [&](char open, char close) -> std::optional<ColumnName> {
    const std::size_t at = name.find(open);
    if (name.empty() || name.back() != close || at == std::string::npos || at == 0) return std::nullopt;
    if (name[at + 1] == ':' || name.ends_with(",:)")) return std::nullopt;  // "a(:,1)" of a matrix
    return ColumnName{base_of(trimmed(std::string_view(name).substr(0, at))), strip_brackets(name.substr(at))};
  };
  if (const auto split = unbracketed('[', ']')) return *split;
  if (const auto split = unbracketed('(', ')')) return *split;
  for (const std::string_view mark : {" / ", " in ", ", ", "/"}) {  // "v_b / mm/s", "Zeit in s", "Time, s"
    const std::size_t at = name.find(mark);
    if (at != std::string::npos && at > 0 && find_unit(std::string_view(name).substr(at + mark.size()))) {
      return {base_of(std::string_view(name).substr(0, at)),
              std::string(trimmed(std::string_view(name).substr(at + mark.size())))};
    }
  }
  if (is_field_name(base_of(name))) return {base_of(name), std::nullopt};  // "F_N" is a force, not a farad
  if (const auto split = split_unit_at_end(name)) return {base_of(split->first), split->second};
  return {base_of(name), std::nullopt};
}

}  // namespace tribofit
