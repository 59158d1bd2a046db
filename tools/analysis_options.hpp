#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/terminal.hpp"

/// What is typed, in SI and checked. Throws tribofit::InputError that names the option.
tribofit::IdentifyOptions options_from(const Settings& settings);

/// Files that are read besides the traces.
std::vector<std::string> input_files(const Settings& settings);

/// How to show a result here and now. arguments: what the next command repeats.
tribofit::TerminalOptions terminal_options(const Settings& settings, const std::vector<std::string>& arguments);
