#pragma once

#include <string>
#include <vector>

/// What a user types after `identify`, as typed.
struct Settings {
  std::vector<std::string> traces;
  std::string radius, speed, load, rate, instruments;
  std::vector<std::string> columns, units;
  std::string second_file;
  std::vector<std::string> second_columns, second_units;
  std::vector<std::string> continued_in;
  std::vector<std::string> confirm;     // diagnose: runs held back
  std::string time_limit;               // diagnose
  std::string kind;                     // of the record; empty: found
  std::vector<std::string> evolutions;  // of velocity steps and holds
  std::string detrend, reference_speed, from, to;
  int states = 0;
  std::string stiffness, mass, damping, rubs_on;  // of a mass on a spring
  bool trim = true;
  bool never_sticks = false;
  std::string stick_below;
  bool keep_high_pass = false;  // rig: do not undo one found on the velocity

  std::vector<std::string> laws, effects, formulas;
  std::string protocol = "both", loss = "squares";
  int starts = 5, folds = 5;
  bool profile = false;
  std::vector<std::string> start_values, bounds;  // of parameters by name
  std::string cycles;                             // to fit
  std::vector<std::string> excluded;              // stretches of time

  std::string json, csv, report;
  std::string figures, picture_format;  // folder, and "svg" where the other is empty
  std::string out, shard, pattern;      // a batch
  std::string compare;                  // table of earlier values
  bool again = false;
  std::vector<std::string> share, vary;  // parameters common to runs
  int threads = 0;
  std::string seed_text;
  unsigned long long seed = 1;
  bool quiet = false;
};
