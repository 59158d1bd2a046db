#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "console.hpp"
#include "machine_options.hpp"
#include "settings.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/text.hpp"
#include "tribofit/workbench/session.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

/// "15mm", or one radius per step: "6mm,9mm" or "6,9mm", where the last has the unit of all.
std::vector<double> radii_from(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::vector<double> radii;
  for (const std::string& part : parts) {
    const std::string radius = is_bare_number(part) ? part + unit_of(parts.back()) : part;
    radii.push_back(positive_value(radius, Quantity::length, "--radius"));
  }
  return radii;
}

/// "4rpm", or the linear speed under the block at the one friction radius that is stated ("1.1mm/s"): omega = v/r.
double speed_from(const std::string& text, const Condition& radius) {
  if (!is_linear_speed(text)) return positive_value(text, Quantity::angular_velocity, "--speed");
  const double velocity = positive_value(text, Quantity::velocity, "--speed");
  if (radius.known()) return velocity / radius.value;
  throw InputError("--speed: '" + text + "' is a linear speed, which is that of the disc at one radius only",
                   "give --radius as well, as one value, or a rotational speed as in 4rpm");
}

std::optional<RecordKind> kind_from(const Settings& s) {
  const ReadOptions& read = s.identify.read;
  const bool has_stiffness = read.spring.stiffness.known();
  if (read.kind) refuse_unread(s.typed, *read.kind);
  if (names_load_point_speeds(s)) {
    if (read.kind && !is_driven_in_steps(read.kind))
      throw UsageError("--speed by time is that of a load point: --kind velocity-steps or slide-hold-slide");
    return read.kind ? read.kind : RecordKind::velocity_steps;
  }
  const bool is_motion_only = read.spring.damping.known() || read.spring.counterface;
  if (is_motion_only || read.kind == RecordKind::motion_only) return RecordKind::motion_only;
  // With a displacement the other columns show whether it is the motion alone.
  if (!read.columns.contains("x_b") && !read.second_columns.contains("x_b")) {
    if (s.never_sticks && has_stiffness) throw UsageError("--never-sticks and --stiffness contradict each other");
    if (read.spring.mass.known() && !has_stiffness)
      throw UsageError("--mass is that of a spring slider: give --stiffness, too");
    if (has_stiffness) return RecordKind::spring_slider;
  }
  return s.never_sticks ? RecordKind::sliding : read.kind;
}

/// Radius and speed, which is the linear one of its drive for a spring slider.
void read_conditions(const Settings& s, ReadOptions& read) {
  if (!s.radius.empty()) {
    std::vector<double> radii = radii_from(s.radius);
    if (radii.size() == 1) {
      read.conditions.radius = {radii[0], kTyped};
    } else {
      read.step_radii = std::move(radii);
    }
  }
  if (s.speed.empty()) return;
  if (is_driven_in_steps(read.kind)) {
    if (!names_load_point_speeds(s))
      throw UsageError("--speed of a load point is stated by time, 0s:2um/s,60s:10um/s; one speed alone has no steps");
    read.load_point = phases_from(s.speed, "--speed");
  } else if (read.kind == RecordKind::spring_slider) {
    read.spring.velocity = {positive_value(s.speed, Quantity::velocity, "--speed"), kTyped};
  } else {
    read.conditions.speed = {speed_from(s.speed, read.conditions.radius), kTyped};
  }
}

/// Adds the formulas of a file: one a line, # begins a comment line.
void add_formulas_of(const std::string& path, std::vector<Effect>& effects) {
  constexpr std::uint64_t kMost = 1 << 20;
  std::istringstream in(text_of_file(path, kMost, "write it as --formula @FILE, a text with one formula a line"));
  std::size_t number = 0, found = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    ++found;
    try {
      effects.emplace_back(Formula(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first)));
    } catch (const InputError& error) {
      throw InputError(error.problem(), error.advice(), {path, number, ""});
    }
  }
  if (found == 0) {
    throw InputError("holds no formula", "write one a line, as in hump = a*exp(-v/w); a=0.02, w=6mm/s", {path, 0, ""});
  }
}

void refuse_contradictions(const Settings& s, const IdentifyOptions& options) {
  const ReadOptions& read = options.read;
  if (read.second_file.empty() && !(read.second_columns.empty() && read.second_units.empty()))
    throw UsageError("--with-columns and --with-units are of the second file; name it with --with");
  if (read.kind && read.kind != RecordKind::stick_slip && options.motion.stick.below)
    throw UsageError("--stick-below is for records that stick and slip, and excludes --never-sticks and other kinds");
  if (!(options.rate_state.from < options.rate_state.to))
    throw UsageError("--from and --to leave nothing between them");
  for (const Law& law : options.laws) {
    if (s.protocol != to_string(Protocol::published) || describe(law).has_per_cycle_extremes()) continue;
    throw UsageError("--protocol published: the law '" + std::string(to_string(law)) +
                     "' cannot be fitted so; it takes laws of mu_s, mu_k and at most one more parameter");
  }
}

using Slot = FrictionModel::Slot;

std::vector<Slot> slots_of(const std::vector<Law>& laws, const std::vector<Effect>& effects) {
  std::vector<Slot> slots;
  for (const Law& law : laws) {
    const FrictionModel model(law, effects);
    for (const Slot& slot : model.parameters()) {
      if (std::ranges::find(slots, slot.full_name(), &Slot::full_name) == slots.end()) slots.push_back(slot);
    }
  }
  return slots;
}

/// What is typed as --start and --bounds: of laws and effects and, where the record is one of velocity steps or the
/// file may yet show that it is, of these.
class GivenReader {
 public:
  GivenReader(const Settings& settings, IdentifyOptions& options)
      : settings_(settings),
        options_(options),
        slots_(slots_of(options.laws, options.effects)),
        is_driven_(names_load_point_speeds(settings) || is_driven_in_steps(settings.identify.read.kind)) {}

  void read() {
    for (const auto& [name, text] :
         named_texts(settings_.start_values, "--start", "NAME=VALUE, as in alpha=0.05s/mm")) {
      for (const Target& target : targets_of(name, "--start")) entry(target).start = target.value(text);
    }
    for (const auto& [name, text] :
         named_texts(settings_.bounds, "--bounds", "NAME=FROM..TO, as in alpha=0.01..0.2s/mm")) {
      for (const Target& target : targets_of(name, "--bounds")) read_bounds(target, text);
    }
    if (const std::string why = contradiction_in(options_.fit.given); !why.empty())
      throw UsageError("--start and --bounds: " + why);
  }

 private:
  struct Target {
    std::string name;
    std::vector<GivenParameter>& given;
    const char* example;  ///< of bounds
    bool is_above_zero;
    std::function<double(const std::string&)> value;
  };

  std::vector<Target> targets_of(const std::string& name, const std::string& option) {
    const bool may_be_driven = !settings_.identify.read.kind || is_driven_;
    const StateParameter* state = may_be_driven && name != "mu_0" ? find_state_parameter(name) : nullptr;
    const bool of_laws = std::ranges::any_of(
        slots_, [&](const Slot& slot) { return slot.parameter.name == name || slot.full_name() == name; });
    std::vector<Target> out;
    if (is_driven_ && state == nullptr) {
      throw UsageError(option + ": velocity steps and holds have no parameter '" + name + "', but " +
                       listed(state_parameter_names()));
    }
    if (!is_driven_ && (state == nullptr || of_laws)) {
      out.push_back({name, options_.fit.given, "alpha=0.01..0.2s/mm", false,
                     [slot = slot_named(name, option), option](const std::string& text) {
                       return slot_value(text, slot, option);
                     }});
    }
    if (state != nullptr && (is_driven_ || !of_laws)) {
      out.push_back({name, options_.rate_state.given, "D_c=2um..50um", state->quantity != Quantity::dimensionless,
                     [this, state, option](const std::string& text) { return state_value(text, *state, option); }});
    }
    return out;
  }

  const Slot& slot_named(const std::string& name, const std::string& option) const {
    const auto found = std::ranges::find(slots_, name, &Slot::full_name);
    if (found != slots_.end()) return *found;
    std::vector<std::string> names;
    for (const Slot& slot : slots_) names.push_back(slot.full_name());
    throw UsageError(option + ": the laws fitted here have no parameter '" + name + "'; did you mean '" +
                     nearest_name(name, names) + "'? They have " + listed(names));
  }

  /// Where friction is in newtons, so is a parameter that has no unit elsewhere.
  static double slot_value(const std::string& text, const Slot& slot, const std::string& option) {
    const bool in_newtons = slot.parameter.unit == "1" && unit_of(text) == "N";
    return as_usage([&] {
      return parameter_value(in_newtons ? text.substr(0, text.find('N')) : text, slot.parameter,
                             option + ": " + slot.full_name());
    });
  }

  /// Of friction in newtons a and b are forces, and k is a stiffness.
  double state_value(const std::string& text, const StateParameter& parameter, const std::string& option) {
    const bool in_newtons = parameter.quantity != Quantity::length && text.find('N') != std::string::npos;
    options_.rate_state.given_in_newtons = options_.rate_state.given_in_newtons || in_newtons;
    return parameter.value(text, option, in_newtons);
  }

  static GivenParameter& entry(const Target& target) {
    const auto found = std::ranges::find(target.given, target.name, &GivenParameter::name);
    return found != target.given.end() ? *found : target.given.emplace_back(GivenParameter{target.name, {}, {}});
  }

  static void read_bounds(const Target& target, const std::string& text) {
    const auto [low, high] = as_usage([&] { return range_ends(text, "--bounds", target.example); });
    const GivenParameter::Bounds bounds = {target.value(low), target.value(high)};
    const bool positive = !target.is_above_zero || bounds.lower > 0;
    if (bounds.lower > bounds.upper || !positive)
      throw UsageError("--bounds: '" + text + "' of " + target.name +
                       (positive ? " runs from high to low" : " begins at zero or below"));
    entry(target).bounds = bounds;
  }

  const Settings& settings_;
  IdentifyOptions& options_;
  std::vector<Slot> slots_;
  bool is_driven_;  ///< the record is stated to be one of velocity steps or holds
};

}  // namespace

double parameter_value(const std::string& text, const Parameter& parameter, const std::string& option) {
  const Unit unit = find_unit(parameter.unit).value_or(Unit{});
  return stated_value(text, unit.quantity, option);
}

Effect effect_named(const std::string& name) {
  return as_usage([&] { return make_effect(name); });
}

std::string list_of_laws() {
  return enumerated(law_keys(), "or");
}

void refuse_clashes(const std::vector<Effect>& effects, const std::vector<Law>& laws) {
  as_usage([&] {
    for (const Law& law : laws) FrictionModel(law, effects);
  });
}

IdentifyOptions options_from(const Settings& s) {
  IdentifyOptions options = s.identify;
  options.read.threads = options.threads;
  options.read.kind = kind_from(s);
  if (options.read.kind) refuse_unread(s.typed, *options.read.kind);
  options.check_kind = [typed = s.typed](RecordKind kind) { refuse_unread(typed, kind); };
  read_conditions(s, options.read);
  refuse_contradictions(s, options);
  if (!s.instruments.empty()) options.instruments = read_instruments(s.instruments);
  for (const std::string& key : s.effects) options.effects.push_back(effect_named(key));
  for (const std::string& formula : s.formulas) {
    if (formula.front() == '@') {
      add_formulas_of(formula.substr(1), options.effects);
    } else {
      options.effects.emplace_back(Formula(formula));
    }
  }
  refuse_clashes(options.effects, options.laws);
  GivenReader(s, options).read();
  options.rate_state.states = static_cast<std::size_t>(s.states);
  options.published_protocol = s.protocol == "both";
  if (s.protocol == to_string(Protocol::published)) options.fit.protocol = Protocol::published;
  return options;
}

std::vector<std::string> input_files(const Settings& s) {
  std::vector<std::string> files = s.identify.read.continued_in;
  files.insert(files.end(), s.confirm.begin(), s.confirm.end());
  files.push_back(s.identify.read.second_file);
  files.push_back(s.instruments);
  for (const std::string& formula : s.formulas) {
    if (formula.front() == '@') files.push_back(formula.substr(1));
  }
  return files;
}

TerminalOptions terminal_options(const Settings& s, const std::vector<std::string>& arguments) {
  TerminalOptions options;
  options.colour = wants_colour();
  options.unicode = wants_unicode();
  options.width = terminal_width();
  options.instruments_declared = !s.instruments.empty();
  options.csv_written = !s.csv.empty();
  options.report_written = !s.report.empty();
  options.charts = !s.report.empty() || !s.figures.empty();
  options.arguments = arguments;
  return options;
}
