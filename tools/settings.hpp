#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/pictures.hpp"
#include "tribofit/report/terminal.hpp"

/// What a user types after `identify`: read into the options of the library where it means the same whatever else is
/// typed, as a text where it does not (options_from).
struct Settings {
  std::vector<std::string> traces;
  tribofit::IdentifyOptions identify;
  std::string radius, speed, instruments;
  bool never_sticks = false;
  int states = 0;  // of velocity steps; 0: found
  std::string protocol = "both";
  std::vector<std::string> effects, formulas;     // of the user, by name; @FILE
  std::vector<std::string> start_values, bounds;  // of parameters by name
  std::vector<std::string> confirm;               // diagnose: runs held back
  std::string time_limit;                         // diagnose, plan

  std::string json, csv, report, figures;
  std::optional<tribofit::PictureFormat> picture_format;  // SVG where there is none
  std::string out, shard, pattern;                        // a batch
  std::string compare;                                    // table of earlier values
  bool again = false;
  std::vector<std::string> share, vary;  // parameters common to runs
  bool quiet = false;
  std::vector<Command::Typed> typed;  // all of it
};

/// The options that the verbs share, so that each is spelt, explained and read once.

void add_input_options(const Command& app, Settings& settings);
/// What draws a slider of which only the pull was recorded.
void add_spring_options(const Command& app, Settings& settings);
/// Of a contact whose load point is driven in steps.
void add_driven_options(const Command& app, Settings& settings);
/// Laws, effects and how they are fitted.
void add_model_options(const Command& app, Settings& settings);
/// Where parameters begin and between which bounds they lie; which cycles and stretches of time are fitted.
void add_parameter_options(const Command& app, Settings& settings);
void add_threads_option(const Command& app, Settings& settings);
/// The page of charts and the pictures; with all else that results are written to, tables as CSV for some verbs.
void add_output_options(const Command& app, Settings& settings, bool with_tables = false);
void add_report_option(const Command& app, Settings& settings);
/// Usage error: an option is typed that means nothing for a record of this kind.
void refuse_unread(const std::vector<Command::Typed>& typed, tribofit::RecordKind kind);
/// What several runs have in common, and earlier values.
void add_pooling_options(const Command& app, Settings& settings);
void add_compare_option(const Command& app, Settings& settings);
/// --share, --vary and --compare as typed.
std::vector<std::string> pooling_arguments(const Settings& settings);

/// All of it together: what depends on several options is read, and contradictions are refused.
/// Throws UsageError, or tribofit::InputError that names the option.
tribofit::IdentifyOptions options_from(const Settings& settings);

/// Files that are read besides the traces.
std::vector<std::string> input_files(const Settings& settings);

/// How to show a result here and now. arguments: what the next command repeats.
tribofit::TerminalOptions terminal_options(const Settings& settings, const std::vector<std::string>& arguments);

/// The source of conditions that are typed.
inline constexpr const char* kTyped = "command line";

/// The effect of that name. Usage error when there is none, with the nearest known name.
tribofit::Effect effect_named(const std::string& name);
/// Usage error: two effects are the same, cannot act together, or not on one of the laws.
void refuse_clashes(const std::vector<tribofit::Effect>& effects, const std::vector<tribofit::Law>& laws);
/// The keys of all laws, as in "a, b or c".
std::string list_of_laws();

/// A value of a parameter of a law or an effect, in SI.
double parameter_value(const std::string& text, const tribofit::Parameter& parameter, const std::string& option);

/// Whether --speed states those of a load point by time.
bool names_load_point_speeds(const Settings& settings);
/// "0s:2um/s,60s:10um/s": speeds from times on. `option`: for messages.
std::vector<tribofit::LoadPointPhase> phases_from(const std::string& text, const std::string& option);

/// A parameter of friction by rate and state, of its spring, or its base friction mu_0.
struct StateParameter {
  std::string_view name;
  tribofit::Quantity quantity;

  /// In SI. in_newtons: of friction as a force.
  double value(std::string text, const std::string& option, bool in_newtons = false) const;
};
std::vector<std::string> state_parameter_names();
/// Null where there is none.
const StateParameter* find_state_parameter(std::string_view name);
/// "a=0.01,b=0.014,D_c=10um,k=0.002/um" by names, SI. Usage error for others.
std::map<std::string, double> rate_state_values(const std::string& text, const std::string& option);
