#include "analysis_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "console.hpp"
#include "driven_options.hpp"
#include "exit_status.hpp"
#include "machine_options.hpp"
#include "parameter_options.hpp"
#include "stated_value.hpp"
#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/ingest/units.hpp"

using namespace tribofit;

namespace {

const std::vector<std::string> kChannels = channel_names();

double positive(const std::string& text, Quantity quantity, const std::string& option,
                const std::string& bare_unit = "") {
  const double value = stated_value(text, quantity, option, bare_unit);
  if (!(value > 0)) {
    throw InputError(option + ": '" + text + "' is not greater than zero",
                     "give a " + std::string(to_string(quantity)) + " such as " + std::string(example_of(quantity)));
  }
  return value;
}

/// "15mm", or one radius per step: "6mm,9mm" or "6,9mm", where a bare number has the unit of the last.
std::vector<double> radii_from(const std::string& text) {
  constexpr double kLargest = 10;  // m; more is a forgotten unit
  const std::vector<std::string> parts = split(text, ',');
  const std::size_t unit_at = parts.back().find_first_not_of("+-.0123456789 ");
  const std::string unit = unit_at == std::string::npos ? "" : parts.back().substr(unit_at);
  std::vector<double> radii;
  for (const std::string& part : parts) {
    radii.push_back(positive(part, Quantity::length, "--radius", unit));
    if (radii.back() > kLargest) {
      throw InputError("--radius: '" + part + "' would be more than 10 m",
                       "give the unit, as in 15mm (a bare number is in m)");
    }
  }
  return radii;
}

/// "time=t,mu=COF": a comma separates only where a channel and "=" follow, so that columns may hold commas themselves.
void add_pairs(const std::string& text, const std::string& option, std::map<std::string, std::string>& pairs) {
  std::vector<std::string> items;
  for (const std::string& part : split(text, ',')) {
    if (part.find('=') != std::string::npos || items.empty()) {
      items.push_back(part);
    } else {
      items.back() += "," + part;
    }
  }
  for (const std::string& item : items) {
    const std::size_t equals = item.find('=');
    const std::string channel = item.substr(0, equals);
    if (equals == std::string::npos || equals + 1 == item.size()) {
      throw InputError(
          option + ": '" + item + "' is not " + (option.ends_with("units") ? "NAME=UNIT" : "CHANNEL=COLUMN"),
          option.ends_with("units") ? "write it as v_b=mm/s, or by the column's name as Velocity=mm/s"
                                    : "write it as v_b=Velocity or v_b=Velocity:mm/s");
    }
    const bool of_column = option.ends_with("units");  // by its name in the file, where it is no channel
    if (!of_column && std::find(kChannels.begin(), kChannels.end(), channel) == kChannels.end()) {
      std::string known;
      for (const std::string& name : kChannels) known += (known.empty() ? "" : ", ") + name;
      throw InputError(option + ": there is no channel '" + channel + "'",
                       "did you mean '" + nearest_name(channel, kChannels) + "'? The channels are " + known);
    }
    if (!pairs.emplace(channel, item.substr(equals + 1)).second) {
      throw InputError(option + ": '" + channel + "' is given twice", "give it once");
    }
  }
}

/// "4rpm", or the linear speed under the block at the one friction radius that is stated ("1.1mm/s"): omega = v/r.
double speed_from(const std::string& text, const Condition& radius) {
  if (text.find_first_not_of("+-.0123456789eE ") == std::string::npos)
    throw InputError("--speed: '" + text + "' has no unit",
                     "write " + text + "rpm, " + text + "rad/s or " + text + "mm/s");
  if (!is_linear_speed(text)) return positive(text, Quantity::angular_velocity, "--speed");
  const double velocity = positive(text, Quantity::velocity, "--speed");
  if (radius.known()) return velocity / radius.value;
  throw InputError("--speed: '" + text + "' is a linear speed, which is that of the disc at one radius only",
                   "give --radius as well, as one value, or a rotational speed as in 4rpm");
}

/// Whether --columns, of either file, names the displacement of a block.
bool names_position(const Settings& s) {
  const auto names = [](const std::vector<std::string>& columns) {
    return std::any_of(columns.begin(), columns.end(), [](const std::string& text) {
      return text.starts_with("x_b=") || text.find(",x_b=") != std::string::npos;
    });
  };
  return names(s.columns) || names(s.second_columns);
}

std::optional<RecordKind> kind_from(const Settings& s) {
  const auto refuse_beside = [&](const char* option, RecordKind kind) {
    if (s.kind.empty() || s.kind == to_string(kind)) return;
    throw UsageError(fmt::format("{} says --kind {}, and --kind {} another", option, to_string(kind), s.kind));
  };
  if (s.never_sticks) refuse_beside("--never-sticks", RecordKind::sliding);
  if (names_load_point_speeds(s)) {
    const auto stated = find_record_kind(s.kind);
    if (stated && !is_driven_in_steps(stated))
      throw UsageError("--speed by time is that of a load point: --kind velocity-steps or slide-hold-slide");
    return stated ? stated : RecordKind::velocity_steps;
  }
  const bool is_motion_only = !s.damping.empty() || !s.rubs_on.empty();
  if (is_motion_only) refuse_beside("--damping or --rubs-on", RecordKind::motion_only);
  if (is_motion_only || s.kind == to_string(RecordKind::motion_only)) return RecordKind::motion_only;
  // With a displacement the other columns show whether it is the motion alone.
  if (names_position(s)) return s.never_sticks ? RecordKind::sliding : find_record_kind(s.kind);
  if (!s.stiffness.empty()) refuse_beside("--stiffness", RecordKind::spring_slider);
  if (s.never_sticks && !s.stiffness.empty()) throw UsageError("--never-sticks and --stiffness contradict each other");
  if (s.mass.empty() != s.stiffness.empty() && s.stiffness.empty())
    throw UsageError("--mass is that of a spring slider: give --stiffness, too");
  if (!s.stiffness.empty()) return RecordKind::spring_slider;
  return s.never_sticks ? RecordKind::sliding : find_record_kind(s.kind);
}

/// The spring and what hangs on it; the speed of the drive of a spring slider is a linear one.
SpringDrive spring_from(const Settings& s) {
  const std::string source = "command line";
  SpringDrive spring;
  if (!s.speed.empty() && kind_from(s) == RecordKind::spring_slider)
    spring.velocity = {positive(s.speed, Quantity::velocity, "--speed"), source};
  if (!s.stiffness.empty()) spring.stiffness = {positive(s.stiffness, Quantity::stiffness, "--stiffness"), source};
  if (!s.mass.empty()) spring.mass = {positive(s.mass, Quantity::mass, "--mass"), source};
  if (!s.damping.empty()) spring.damping = {positive(s.damping, Quantity::damping, "--damping"), source};
  if (!s.rubs_on.empty()) spring.counterface = s.rubs_on == "base" ? Counterface::base : Counterface::ground;
  return spring;
}

void read_conditions(const Settings& s, Conditions& conditions, std::vector<double>& step_radii) {
  const std::string source = "command line";
  if (!s.radius.empty()) {
    const std::vector<double> radii = radii_from(s.radius);
    if (radii.size() == 1) {
      conditions.radius = {radii[0], source};
    } else {
      step_radii = radii;
    }
  }
  const bool of_spring = kind_from(s) == RecordKind::spring_slider || is_driven_in_steps(kind_from(s));
  if (!s.speed.empty() && !of_spring) conditions.speed = {speed_from(s.speed, conditions.radius), source};
  if (!s.load.empty()) conditions.load = {positive(s.load, Quantity::force, "--load"), source};
}

Loss loss_from(const std::string& name) {
  if (name == "huber") return Loss::huber;
  return name == "soft-l1" ? Loss::soft_l1 : Loss::squares;
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

void read_reading(const Settings& s, ReadOptions& read) {
  read_conditions(s, read.conditions, read.step_radii);
  for (const std::string& text : s.columns) add_pairs(text, "--columns", read.columns);
  for (const std::string& text : s.units) add_pairs(text, "--units", read.units);
  if (s.second_file.empty() && !(s.second_columns.empty() && s.second_units.empty())) {
    throw UsageError("--with-columns and --with-units are of the second file; name it with --with");
  }
  for (const std::string& text : s.second_columns) add_pairs(text, "--with-columns", read.second_columns);
  for (const std::string& text : s.second_units) add_pairs(text, "--with-units", read.second_units);
  if (!s.rate.empty()) read.rate = positive(s.rate, Quantity::frequency, "--rate");
  read.second_file = s.second_file;
  read.continued_in = s.continued_in;
  read.threads = s.threads;
}

void read_laws(const std::vector<std::string>& names, std::vector<Law>& laws) {
  if (!names.empty()) laws.clear();
  for (const std::string& name : names) {
    const auto found = find_law(name);
    const bool again = found && std::find(laws.begin(), laws.end(), *found) != laws.end();
    if (found && !again) laws.push_back(*found);
  }
}

void read_effects(const Settings& s, const std::vector<Law>& laws, std::vector<Effect>& effects) {
  for (const std::string& key : s.effects) effects.push_back(effect_named(key));
  for (const std::string& formula : s.formulas) {
    if (formula.front() == '@') {
      add_formulas_of(formula.substr(1), effects);
    } else {
      effects.emplace_back(Formula(formula));
    }
  }
  refuse_clashes(effects, laws);
}

}  // namespace

namespace {

void refuse_extremes(const IdentifyOptions& options) {
  for (const Law& law : options.laws) {
    if (options.fit.protocol == Protocol::joint || describe(law).has_per_cycle_extremes()) continue;
    throw UsageError("--protocol published: the law '" + std::string(to_string(law)) +
                     "' cannot be fitted so; it takes laws of mu_s, mu_k and at most one more parameter");
  }
}

}  // namespace

IdentifyOptions options_from(const Settings& s) {
  IdentifyOptions options;
  options.threads = s.threads;
  read_reading(s, options.read);
  options.motion.trim = s.trim;
  options.read.kind = kind_from(s);
  options.read.spring = spring_from(s);
  options.read.load_point = load_point_from(s, options.read.kind);
  if (!s.stick_below.empty()) options.motion.stick.below = positive(s.stick_below, Quantity::velocity, "--stick-below");
  if (options.read.kind && options.read.kind != RecordKind::stick_slip && !s.stick_below.empty())
    throw UsageError("--stick-below is for records that stick and slip, and excludes --never-sticks and other kinds");
  if (!s.instruments.empty()) options.instruments = read_instruments(s.instruments);
  read_laws(s.laws, options.laws);
  read_effects(s, options.laws, options.effects);
  options.fit.given = given_from(s, options.laws, options.effects);
  options.rate_state = driven_options_from(s, options.fit.given);
  options.selection = selection_from(s);

  options.published_protocol = s.protocol == "both";
  options.fit.protocol = s.protocol == to_string(Protocol::published) ? Protocol::published : Protocol::joint;
  refuse_extremes(options);
  options.fit.loss = loss_from(s.loss);
  options.fit.starts = s.starts;
  options.fit.folds = s.folds;
  options.fit.profile = s.profile;
  options.fit.seed = s.seed;
  return options;
}

std::vector<std::string> input_files(const Settings& s) {
  std::vector<std::string> files = s.continued_in;
  files.insert(files.end(), s.confirm.begin(), s.confirm.end());
  files.push_back(s.second_file);
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
