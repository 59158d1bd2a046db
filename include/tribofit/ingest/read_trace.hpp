#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit {

/// How far the clock of `velocity` lags: its event at t happened at t + offset on the clock of friction, in the middle
/// of the time that both share.
struct ClockOffset {
  double offset = 0;             ///< [s]
  double uncertainty = 0;        ///< standard error [s]
  double drift = 0;              ///< by which the offset grows over the time [1]
  double drift_uncertainty = 0;  ///< standard error
  std::size_t events = 0;        ///< break-aways that both share; fewer than 3: no offset was found
};
/// Finds the offset between the clocks of a file with friction and one with velocity; times in s from the start of
/// each.
using ClockOffsetFinder =
    std::function<ClockOffset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                              const std::vector<double>& velocity_time, const std::vector<double>& velocity)>;

/// How to read a trace; what is not stated is taken from the file.
struct ReadOptions {
  /// Channel (as in channel_names()) -> column as the file names it, optionally with ":UNIT" ("Velocity:mm/s"). Columns
  /// are also named by number ("#3").
  std::map<std::string, std::string> columns;
  /// Channel -> unit, or channel -> sensitivity of a voltage ("v_b" -> "5 mm/s/V").
  std::map<std::string, std::string> units;
  std::optional<RecordKind> kind;          ///< as the user states it
  SpringDrive spring;                      ///< of a spring slider or a motion alone, as the user states it
  std::vector<LoadPointPhase> load_point;  ///< of velocity steps and holds, as the user states it
  std::optional<double> rate;              ///< samples per second [Hz] where there is no time column
  Conditions conditions;                   ///< as given by the user or the manifest; beats the file
  /// One friction radius [m] per step, in the order of the steps, for files whose radius changes.
  std::vector<double> step_radii;
  /// A second file holding the other instrument's channels; joined on time.
  std::string second_file;
  /// As `columns` and `units`, of the second file. Where these name friction, or velocity, in one of the files, it is
  /// not looked for in the other. Empty: `columns` and `units` are for both.
  std::map<std::string, std::string> second_columns, second_units;
  /// Finds the offset between the clocks of the two files: estimate_clock_offset (kinematics/clock_offset.hpp). Empty:
  /// the times are taken as written.
  ClockOffsetFinder clock_offset;
  /// Further files that continue the run, in order.
  std::vector<std::string> continued_in;
  int threads = 0;  ///< 0: as many as there are; the result does not depend on it
};

/// Reads one run from a file, with the reader that recognises its content (src/ingest/reader.hpp lists them).
///
/// Text: columns divided by comma, semicolon, tab or blanks; decimal comma; BOM; LF, CR LF or CR; quotes; preamble,
/// comment lines and footers; units in the header or in a row of their own; Latin-1 and GBK headers; trailing
/// separators; blocks with a time each beside one another; text between data, which may divide steps and state their
/// conditions. MATLAB 5 to 7.3, UFF 58 and 58b, TDMS. Any format: radius, speed and load that the file states with a
/// unit; rows with a cell that is not a number left out as gaps, where they are isolated and one in a thousand at most;
/// a clock that restarts at each step; without a time column the rate of the user, else that of the file; friction as
/// mu, as tangential force with a load channel or a nominal load, or as torque with a radius. A short table of friction
/// and sliding velocity without any time is one of points (RecordKind). Throws InputError with file, line (or value),
/// column, what is wrong and what to do. Cost: linear in bytes.
Trace read_trace(const std::string& path, const ReadOptions& options = {});

}  // namespace tribofit
