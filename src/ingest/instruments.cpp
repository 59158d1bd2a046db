#include "tribofit/ingest/instruments.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

using Json = nlohmann::ordered_json;

enum class Sign { any, positive, not_negative };

/// A key of the file, and where its value goes; nullptr: it is no quantity.
struct Entry {
  std::string section, key;
  std::optional<Declared>* target = nullptr;
  Quantity quantity = Quantity::dimensionless;
  Sign sign = Sign::positive;
};

std::vector<Entry> entries_of(Instruments& lab) {
  auto& [v, f, r] = lab;
  return {{"vibrometer", "range", &v.range, Quantity::velocity},
          {"vibrometer", "gain", &v.gain},
          {"vibrometer", "high_pass", &v.high_pass, Quantity::frequency},
          {"vibrometer", "low_pass", &v.low_pass, Quantity::frequency},
          {"vibrometer", "delay", &v.delay, Quantity::time, Sign::any},
          {"vibrometer", "sign"},
          {"force_sensor", "bandwidth", &f.bandwidth, Quantity::frequency},
          {"force_sensor", "bandwidth_at_least", &f.bandwidth_at_least, Quantity::frequency},
          {"force_sensor", "zero"},
          {"force_sensor", kCrosstalkKey, &f.crosstalk, Quantity::dimensionless, Sign::any},
          {"force_sensor", "mass_below", &f.mass_below, Quantity::mass, Sign::not_negative},
          {"force_sensor", "gain", &f.gain},
          {"force_sensor", "load_measured"},
          {"rig", "stiffness", &r.stiffness, Quantity::stiffness},
          {"rig", "ping_frequency", &r.ping_frequency, Quantity::frequency},
          {"rig", "pad_radius", &r.pad_radius, Quantity::length},
          {"rig", "radius", &r.radius, Quantity::length},
          {"rig", "speed", &r.speed, Quantity::angular_velocity, Sign::any},
          {"rig", "load", &r.load, Quantity::force}};
}

std::string as_text(Quantity quantity) {
  return "\"" + std::string(example_of(quantity)) + "\"";
}

class InstrumentsReader {
 public:
  explicit InstrumentsReader(const std::string& path) : path_(path) {}

  Instruments read() {
    const Json root = parse();
    Instruments lab;
    const std::vector<Entry> entries = entries_of(lab);
    check_keys(root, "", {"vibrometer", "force_sensor", "rig"});
    for (const auto& [section, json] : root.items()) {
      std::vector<std::string> known;
      for (const Entry& entry : entries) {
        if (entry.section == section) known.push_back(entry.key);
      }
      check_keys(json, section, known);
      for (const Entry& entry : entries) {
        const auto given = entry.section == section ? json.find(entry.key) : json.end();
        if (given != json.end()) take(entry, *given, section + "." + std::string(entry.key), lab);
      }
    }
    if (lab.force_sensor.bandwidth && lab.force_sensor.bandwidth_at_least)
      fail("force_sensor.bandwidth_at_least", "is given together with force_sensor.bandwidth", "keep one of the two");
    return lab;
  }

 private:
  Json parse() {
    const std::string text = text_of_file(path_, kLongestLine, "name the JSON file that describes the instruments");
    if (is_nested_deeper(text))
      throw InputError("is nested too deeply", "describe the instruments by sections with values in them",
                       {path_, 0, ""});
    const auto follow_parser = [this](int, Json::parse_event_t event, Json& parsed) { return follow(event, parsed); };
    try {
      return Json::parse(text, follow_parser, true, true);  // comments are allowed
    } catch (const Json::out_of_range&) {
      fail(current_key(), "a number is outside the range of numbers", "correct the number");
    } catch (const Json::parse_error& error) {
      const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
      throw InputError("is not valid JSON", "check commas, quotes and brackets at this line",
                       {path_, 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n')), ""});
    }
  }

  /// Keeps account of where the parser is; a key that is there twice would silently win over the first.
  bool follow(Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      open_.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      open_.pop_back();
    } else if (event == Json::parse_event_t::key) {
      open_.back().last = parsed.get<std::string>();
      if (!open_.back().keys.insert(open_.back().last).second)
        fail(current_key(), "is there twice", "keep one of the two");
    }
    return true;
  }

  std::string current_key() const {
    std::string key;
    for (const Open& object : open_) key += (key.empty() || object.last.empty() ? "" : ".") + object.last;
    return key;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& problem, const std::string& advice) const {
    throw InputError((key.empty() ? "" : key + ": ") + problem, advice, {path_, 0, ""});
  }

  void check_keys(const Json& json, const std::string& name, const std::vector<std::string>& known) const {
    if (!json.is_object()) fail(name, "must be an object { ... }", "see the documentation of the instruments file");
    for (const auto& [key, value] : json.items()) {
      if (std::ranges::find(known, key) != known.end()) continue;
      fail(name.empty() ? key : name + "." + key, "unknown key" + did_you_mean(key, known),
           "known keys are " + listed(known));
    }
  }

  void take(const Entry& entry, const Json& value, const std::string& key, Instruments& lab) const {
    auto& force_sensor = lab.force_sensor;
    if (entry.target != nullptr) {
      take_quantity(entry, value, key);
    } else if (entry.key == "zero") {
      force_sensor.zero = zero(value, key, force_sensor.zero_is_force);
    } else if (entry.key == "sign") {
      if (!value.is_number_integer() || (value != 1 && value != -1))
        fail(key, "must be 1 or -1", "give -1 where the vibrometer points the other way");
      lab.vibrometer.sign = value.get<int>();
    } else {
      if (!value.is_boolean()) fail(key, "must be true or false", "say whether mu is Ft/Fn measured");
      force_sensor.load_measured = value.get<bool>();
    }
  }

  void take_quantity(const Entry& entry, const Json& value, const std::string& key) const {
    const Declared result = declared(value, entry.quantity, key);
    const bool below = entry.sign != Sign::any && result.value < 0;
    if (below || (entry.sign == Sign::positive && result.value == 0))
      fail(key, entry.sign == Sign::positive ? "must be above zero" : "must not be negative",
           "write it as " + as_text(entry.quantity));
    *entry.target = result;
  }

  double number(const Json& value, Quantity quantity, const std::string& key) const {
    if (!value.is_string() && !value.is_number())
      fail(key, "must be a value with a unit", "write it as " + as_text(quantity));
    if (value.is_number() && quantity != Quantity::dimensionless)
      fail(key, "has no unit", "write it as a text with a unit, such as " + as_text(quantity));
    try {
      return value.is_number() ? value.get<double>() : parse_quantity(value.get<std::string>(), quantity, key);
    } catch (const InputError& error) {
      throw InputError(error.problem(), error.advice(), {path_, 0, ""});
    }
  }

  double uncertainty(const Json& value, Quantity quantity, const std::string& key) const {
    const double result = number(value, quantity, key);
    if (result < 0) fail(key, "the uncertainty is negative", "give a standard uncertainty, zero or above");
    return result;
  }

  Declared declared(const Json& value, Quantity quantity, const std::string& key) const {
    if (value.is_array()) {
      if (value.size() != 2) fail(key, "must be [value, uncertainty]", "give two texts with units");
      return {number(value[0], quantity, key), uncertainty(value[1], quantity, key)};
    }
    if (!value.is_object()) return {number(value, quantity, key), 0};
    check_keys(value, key, {"value", "uncertainty"});
    if (!value.contains("value")) fail(key, "has no value", "give {\"value\": ..., \"uncertainty\": ...}");
    Declared result{number(value["value"], quantity, key + ".value"), 0};
    if (value.contains("uncertainty"))
      result.uncertainty = uncertainty(value["uncertainty"], quantity, key + ".uncertainty");
    return result;
  }

  /// The zero of a force sensor is of mu, or of the force where that is what is recorded.
  Declared zero(const Json& value, const std::string& key, bool& is_force) const {
    try {
      return declared(value, Quantity::dimensionless, key);
    } catch (const InputError&) {
      is_force = true;
      return declared(value, Quantity::force, key);
    }
  }

  struct Open {
    std::set<std::string> keys;
    std::string last;
  };

  std::string path_;
  std::vector<Open> open_;  // objects that the parser is in
};

}  // namespace

Instruments read_instruments(const std::string& path) {
  return InstrumentsReader(path).read();
}

std::optional<Declared> zero_of_friction(const Instruments::ForceSensor& sensor, FrictionKind kind,
                                         const Condition& load) {
  if (!sensor.zero || !sensor.zero_is_force || kind == FrictionKind::force) return sensor.zero;
  if (!(load.value > 0)) {
    throw InputError(
        "the zero of the force sensor is declared in N, but friction is a coefficient and no load is known",
        "give the load with " + setting("load", "50N") + ", or the zero as a coefficient");
  }
  return Declared{sensor.zero->value / load.value, sensor.zero->uncertainty / load.value};
}

}  // namespace tribofit
