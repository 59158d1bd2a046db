#include "tribofit/ingest/instruments.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "input_file.hpp"
#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

using Json = nlohmann::ordered_json;

class InstrumentsReader {
 public:
  explicit InstrumentsReader(const std::string& path) : path_(path) {}

  Instruments read() {
    const Json root = parse();
    Instruments result;
    section(
        root, "",
        {{"vibrometer", [&](const Json& json, const std::string&) { read_vibrometer(json, result.vibrometer); }},
         {"force_sensor", [&](const Json& json, const std::string&) { read_force_sensor(json, result.force_sensor); }},
         {"rig", [&](const Json& json, const std::string&) { read_rig(json, result.rig); }}});
    return result;
  }

 private:
  using Handler = std::function<void(const Json&, const std::string&)>;
  using Handlers = std::vector<std::pair<std::string, Handler>>;

  Json parse() {
    const InputFile file(path_);
    if (file.size() > kLongestLine)
      fail("", "is larger than 1 MB", "name the JSON file that describes the instruments");
    std::string text(static_cast<std::size_t>(file.size()), '\0');
    text.resize(file.read(0, text));
    try {
      return Json::parse(
          text, [this](int, Json::parse_event_t event, Json& parsed) { return follow(event, parsed); }, true,
          true);  // comments are allowed
    } catch (const Json::out_of_range&) {
      fail(current_key(), "a number is outside the range of numbers", "correct the number");
    } catch (const Json::parse_error& error) {
      const std::size_t end = std::min(error.byte, text.size());
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
      throw InputError("is not valid JSON", "check commas, quotes and brackets at this line",
                       {path_, static_cast<std::size_t>(line), ""});
    }
  }

  void read_vibrometer(const Json& json, Instruments::Vibrometer& v) const {
    section(json, "vibrometer",
            {{"range", positive(v.range, Quantity::velocity)},
             {"gain", positive(v.gain, Quantity::dimensionless)},
             {"high_pass", positive(v.high_pass, Quantity::frequency)},
             {"low_pass", positive(v.low_pass, Quantity::frequency)},
             {"delay", any(v.delay, Quantity::time)},
             {"sign", [&](const Json& value, const std::string& key) {
                if (!value.is_number_integer() || (value != 1 && value != -1))
                  fail(key, "must be 1 or -1", "give -1 where the vibrometer points the other way");
                v.sign = value.get<int>();
              }}});
  }

  void read_force_sensor(const Json& json, Instruments::ForceSensor& f) const {
    section(json, "force_sensor",
            {{"bandwidth", positive(f.bandwidth, Quantity::frequency)},
             {"bandwidth_at_least", positive(f.bandwidth_at_least, Quantity::frequency)},
             {"zero", [&](const Json& value, const std::string& key) { f.zero = zero(value, key, f.zero_is_force); }},
             {kCrosstalkKey, any(f.crosstalk, Quantity::dimensionless)},
             {"mass_below", not_negative(f.mass_below, Quantity::mass)},
             {"gain", positive(f.gain, Quantity::dimensionless)},
             {"load_measured", [&](const Json& value, const std::string& key) {
                if (!value.is_boolean()) fail(key, "must be true or false", "say whether mu is Ft/Fn measured");
                f.load_measured = value.get<bool>();
              }}});
    if (f.bandwidth && f.bandwidth_at_least)
      fail("force_sensor.bandwidth_at_least", "is given together with force_sensor.bandwidth", "keep one of the two");
  }

  void read_rig(const Json& json, Instruments::Rig& r) const {
    section(json, "rig",
            {{"stiffness", positive(r.stiffness, Quantity::stiffness)},
             {"ping_frequency", positive(r.ping_frequency, Quantity::frequency)},
             {"pad_radius", positive(r.pad_radius, Quantity::length)},
             {"radius", positive(r.radius, Quantity::length)},
             {"speed", any(r.speed, Quantity::angular_velocity)},
             {"load", positive(r.load, Quantity::force)}});
  }

  /// Keeps account of where the parser is; a key that is there twice would silently win over the first.
  bool follow(Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      seen_.emplace_back();
      trail_.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      seen_.pop_back();
      trail_.pop_back();
    } else if (event == Json::parse_event_t::key) {
      trail_.back() = parsed.get<std::string>();
      if (!seen_.back().insert(trail_.back()).second) fail(current_key(), "is there twice", "keep one of the two");
    }
    return true;
  }

  std::string current_key() const {
    std::string key;
    for (const std::string& part : trail_) key += (key.empty() || part.empty() ? "" : ".") + part;
    return key;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& problem, const std::string& advice) const {
    throw InputError((key.empty() ? "" : key + ": ") + problem, advice, {path_, 0, ""});
  }

  void section(const Json& json, const std::string& name, const Handlers& handlers) const {
    if (!json.is_object()) fail(name, "must be an object { ... }", "see the documentation of the instruments file");
    std::vector<std::string> known;
    for (const auto& [key, handler] : handlers) known.push_back(key);
    for (const auto& [key, value] : json.items()) {
      const std::string full = name.empty() ? key : name + "." + key;
      const auto at = std::find(known.begin(), known.end(), key);
      if (at == known.end()) fail(full, "unknown key" + did_you_mean(key, known), "known keys are " + listed(known));
      handlers[static_cast<std::size_t>(at - known.begin())].second(value, full);
    }
  }

  double number(const Json& value, Quantity quantity, const std::string& key, bool difference = false) const {
    if (!value.is_string() && !value.is_number()) {
      fail(key, "must be a value with a unit", "write it as \"" + std::string(example_of(quantity)) + "\"");
    }
    if (value.is_number() && quantity != Quantity::dimensionless) {
      fail(key, "has no unit", "write it as a text with a unit, such as \"" + std::string(example_of(quantity)) + "\"");
    }
    try {
      const double result =
          value.is_number() ? value.get<double>() : parse_quantity(value.get<std::string>(), quantity, key);
      if (difference && result < 0)
        fail(key, "the uncertainty is negative", "give a standard uncertainty, zero or above");
      return result;
    } catch (const InputError& error) {
      if (!error.where().file.empty()) throw;
      throw InputError(error.problem(), error.advice(), {path_, 0, ""});
    }
  }

  Declared declared(const Json& value, Quantity quantity, const std::string& key) const {
    if (value.is_array()) {
      if (value.size() != 2) fail(key, "must be [value, uncertainty]", "give two texts with units");
      return {number(value[0], quantity, key), number(value[1], quantity, key, true)};
    }
    if (!value.is_object()) return {number(value, quantity, key), 0};
    Declared result;
    bool has_value = false;
    section(value, key,
            {{"value",
              [&](const Json& v, const std::string& k) {
                result.value = number(v, quantity, k);
                has_value = true;
              }},
             {"uncertainty",
              [&](const Json& v, const std::string& k) { result.uncertainty = number(v, quantity, k, true); }}});
    if (!has_value) fail(key, "has no value", "give {\"value\": ..., \"uncertainty\": ...}");
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

  Handler any(std::optional<Declared>& target, Quantity quantity) const {
    return [this, &target, quantity](const Json& value, const std::string& key) {
      target = declared(value, quantity, key);
    };
  }
  Handler positive(std::optional<Declared>& target, Quantity quantity) const {
    return [this, &target, quantity](const Json& value, const std::string& key) {
      target = declared(value, quantity, key);
      if (!(target->value > 0))
        fail(key, "must be above zero", "write it as \"" + std::string(example_of(quantity)) + "\"");
    };
  }
  Handler not_negative(std::optional<Declared>& target, Quantity quantity) const {
    return [this, &target, quantity](const Json& value, const std::string& key) {
      target = declared(value, quantity, key);
      if (target->value < 0)
        fail(key, "must not be negative", "write it as \"" + std::string(example_of(quantity)) + "\"");
    };
  }

  std::string path_;
  std::vector<std::set<std::string>> seen_;  // keys of the objects that are open
  std::vector<std::string> trail_;           // the last key of each
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
        "give the load with --load 50N, or the zero as a coefficient");
  }
  return Declared{sensor.zero->value / load.value, sensor.zero->uncertainty / load.value};
}

}  // namespace tribofit
