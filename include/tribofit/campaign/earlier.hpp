#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// A published value, or one of an earlier campaign, in the unit of the quantity it is compared with.
struct EarlierValue {
  std::string name, unit;     ///< "mu_s", "alpha", "runout.A", "frequency"
  std::string law, protocol;  ///< empty: not said, so of every law and protocol
  Conditions conditions;      ///< what the row says of them [SI]
  std::vector<OtherCondition> others;
  double value = 0;
  double std_error = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not said
  std::string column;                                           ///< as the file gives it
  std::size_t line = 0;                                         ///< of the file, 1-based
};

/// A table of earlier values.
struct EarlierTable {
  std::string path;
  std::vector<EarlierValue> values;  ///< by line, then by column
  std::vector<std::string> notes;    ///< columns that no campaign knows
};

/// Reads a table of earlier values, as data/published/table4.csv, to be compared with `groups`.
///
/// A row a condition: columns radius, speed, load and further conditions of the campaign by their names, as in a
/// manifest (units in the header or in the cell); a value for each column called like a parameter or measure of the
/// groups ("mu_s", "alpha_s_per_mm", "frequency_hz", "alpha [s/mm]"), its standard error in NAME_std_error. The law and
/// the protocol stand before the name ("exponential_joint_mu_s") or in columns of their own (law, protocol).
/// Or a row a value: columns name (or parameter, quantity), value, unit, std_error beside those of the conditions.
/// v_r_amplitude is read as amplitude and fundamental as frequency. Empty cells say nothing; # begins a comment line.
/// Throws InputError with file, line and column: no conditions or no values, an unknown or missing unit or one of
/// another quantity, a cell that is not a number, two columns for one value. Cost: linear in rows.
EarlierTable read_earlier(const std::string& path, std::span<const PooledGroup> groups);

}  // namespace tribofit
