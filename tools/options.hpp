#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "verbs.hpp"

/// The options that the verbs share, so that each is spelt and explained once.

void add_input_options(CLI::App& app, Settings& settings);
/// Laws, effects and how they are fitted.
void add_model_options(CLI::App& app, Settings& settings);
/// Which cycles and stretches of time are fitted.
void add_selection_options(CLI::App& app, Settings& settings);
/// Where parameters begin and between which bounds they lie.
void add_parameter_options(CLI::App& app, Settings& settings);
/// Where the result goes, for verbs that write no tables.
void add_result_options(CLI::App& app, Settings& settings);
/// The same with tables as CSV.
void add_output_options(CLI::App& app, Settings& settings);
/// The page of charts, for verbs that have one.
void add_report_option(CLI::App& app, Settings& settings);
/// What several runs have in common.
void add_pooling_options(CLI::App& app, Settings& settings);

/// The effect of that name. Wrong usage (CLI::ValidationError) when there is none, with the nearest known name.
tribofit::Effect effect_named(const std::string& name);
/// Wrong usage: two effects are the same, or cannot act together.
void refuse_clashes(const std::vector<tribofit::Effect>& effects);

void add_compare_option(CLI::App& app, Settings& settings);
/// --share, --vary and --compare as typed.
std::vector<std::string> pooling_arguments(const Settings& settings);

/// The options as typed that shape the analysis, for the next command.
std::vector<std::string> own_options(const CLI::App& app);

/// Wrong usage (CLI::ValidationError): an option given an empty value.
void refuse_empty_values(const CLI::App& app);
/// Wrong usage: --seed is not a number that fits.
void check_seed(Settings& settings);
/// Wrong usage: an output that would overwrite one of the inputs.
void refuse_overwriting(const Settings& settings, const std::vector<std::string>& inputs);
