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

/// An earlier value beside that of a campaign.
struct ComparedValue {
  std::size_t group = 0;      ///< index of the conditions
  std::string law, protocol;  ///< of our value; empty for measures
  EarlierValue earlier;
  PooledValue ours;
  double percent = 0;        ///< (ours - earlier)/|earlier|; NaN where the earlier value is 0
  double in_std_errors = 0;  ///< (ours - earlier) over std_error and systematic of ours and std_error of the earlier
                             ///< value, as far as stated, added in squares; NaN where ours has none
  bool inside95 = false;     ///< the earlier value lies in our 95 % interval

  /// Both are ours beside the same earlier value, by another protocol.
  bool is_beside_same(const ComparedValue& other) const {
    return group == other.group && law == other.law && earlier.line == other.earlier.line &&
           earlier.column == other.earlier.column && earlier.name == other.earlier.name;
  }
};

/// A campaign beside a table of earlier values.
struct EarlierComparison {
  std::string path;                    ///< of the table
  std::vector<ComparedValue> values;   ///< in the order of the table; of one value by law, the joint protocol first
  std::vector<std::string> unmatched;  ///< rows and columns of the table, and conditions of ours, without a partner

  /// Earlier values beside the joint fit or a measure, and how many of them lie in our 95 % interval.
  struct Agreement {
    std::size_t values = 0, inside = 0;
  };
  Agreement agreement() const;
};

/// "9 mm, 4 rpm, 50 N, lot L": what is known of the conditions.
std::string conditions_text(const Conditions& conditions, const std::vector<OtherCondition>& others);
inline std::string conditions_text(const PooledGroup& group) {
  return conditions_text(group.conditions, group.others);
}

/// Puts each earlier value beside the pooled values of the same name, law and protocol under the same conditions.
/// Conditions are the same where all that the row states is (a speed that was read off the plateau to 1 %); alpha is
/// of the exponential and beta of the fractional law by their names, mu_s and mu_k of every law unless the table says.
EarlierComparison compare_with(const EarlierTable& table, std::span<const PooledGroup> groups);

}  // namespace tribofit
