#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit {

/// How to read a trace; everything not said is found out from the file.
struct ReadOptions {
  /// Channel (time, mu, v_b, v_r, force, torque, load, speed, angle, temperature, step) -> column as the file
  /// names it, optionally with ":UNIT" ("Velocity:mm/s"). Columns are also named by number ("#3").
  std::map<std::string, std::string> columns;
  /// Channel -> unit, or channel -> sensitivity of a voltage ("v_b" -> "5 mm/s/V").
  std::map<std::string, std::string> units;
  std::optional<double> rate;  ///< samples per second [Hz] where there is no time column
  Conditions conditions;       ///< as given by the user or the manifest; beats the file
  /// One friction radius [m] per step, in the order of the steps, for files whose radius changes.
  std::vector<double> step_radii;
  /// A second file holding the other instrument's channels; joined on time, clock offset estimated from break-away.
  std::string second_file;
  /// Further files that continue the run, in order.
  std::vector<std::string> continued_in;
  int threads = 0;  ///< 0: as many as there are; the result does not depend on it
};

/// Reads one run from the file of an instrument, of any format that src/ingest/reader.hpp lists; the content tells
/// which.
///
/// CSV: comma, semicolon, tab; decimal comma; BOM; CR LF; quotes; preamble and comment lines; units in the
/// header or in a row of their own; Latin-1 and GBK headers; trailing separators; text rows between data; a clock that
/// restarts at each step. Friction as mu, as tangential force with a load channel or a nominal load, or as torque with
/// a radius. Throws InputError with file, line, column, what is wrong and what to do. Cost: linear in bytes.
Trace read_trace(const std::string& path, const ReadOptions& options = {});

}  // namespace tribofit
