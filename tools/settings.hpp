#pragma once

#include <string>
#include <vector>

#include "tribofit/pipeline.hpp"

/// What a user types after `identify`, as typed.
struct Settings {
  std::vector<std::string> traces;
  std::string radius, speed, load, rate, instruments;
  std::vector<std::string> columns, units;
  std::string second_file;
  std::vector<std::string> continued_in;
  bool trim = true;

  std::vector<std::string> laws, effects, formulas;
  std::string protocol = "both", loss = "squares";
  int starts = 5, folds = 5;
  bool profile = false;

  std::string json, csv;
  int threads = 0;
  unsigned long long seed = 1;
  bool quiet = false;
};

/// What is typed, in SI and checked. Throws tribofit::InputError that names the option.
tribofit::IdentifyOptions options_from(const Settings& settings);

/// The traces named, folders replaced by the CSV files in them in order of name. Throws tribofit::InputError for a
/// folder without traces.
std::vector<std::string> traces_from(const std::vector<std::string>& names);
