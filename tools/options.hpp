#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "settings.hpp"

/// The options that the verbs share, so that each is spelt and explained once.

void add_input_options(const Command& app, Settings& settings);
/// What draws a slider of which only the pull was recorded.
void add_spring_options(const Command& app, Settings& settings);
/// Laws, effects and how they are fitted.
/// Of a contact whose load point is driven in steps.
void add_driven_options(const Command& app, Settings& s);
void add_model_options(const Command& app, Settings& settings);
/// Which cycles and stretches of time are fitted.
void add_selection_options(const Command& app, Settings& settings);
/// Where parameters begin and between which bounds they lie.
void add_parameter_options(const Command& app, Settings& settings);
/// Where the result goes, for verbs that write no tables.
void add_result_options(const Command& app, Settings& settings);
/// The same with tables as CSV.
void add_output_options(const Command& app, Settings& settings);
/// The page of charts, for verbs that have one.
void add_report_option(const Command& app, Settings& settings);
/// What several runs have in common.
void add_pooling_options(const Command& app, Settings& settings);

void add_compare_option(const Command& app, Settings& settings);
/// --share, --vary and --compare as typed.
std::vector<std::string> pooling_arguments(const Settings& settings);

/// Usage error: --seed is not a number that fits.
void check_seed(Settings& settings);
