#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/earlier.hpp"
#include "tribofit/campaign/pool.hpp"

namespace tribofit {

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
