#pragma once

#include <Eigen/Dense>
#include <vector>

#include "cycle_evidence.hpp"
#include "shared_fit.hpp"

// Records that share values, at one set of values: what each of them knows of the common ones.

namespace tribofit::sharing {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

inline std::size_t at(Index k) {
  return static_cast<std::size_t>(k);
}

/// One record at one set of values: its normal evidence, weighted, and which of its parameters are whose.
struct Part {
  const Member* member = nullptr;
  std::vector<double> p;
  CycleEvidence evidence;
  std::vector<bool> free;          ///< estimated: of its own and common ones
  std::vector<bool> own_free;      ///< those of its own
  std::vector<bool> open;          ///< of its own, of which only combinations are determined
  std::vector<Index> own, common;  ///< free parameters of either kind
  std::vector<Index> values;       ///< the common values that `common` take

  /// Inverse of the curvature of the record's own values.
  MatrixXd own_inverse() const { return inverse_over(evidence.total, own_free)(own, own); }
  /// What the record knows of the common values, beside its own ones, and how it pulls at them.
  MatrixXd knows() const;
  VectorXd pull(const VectorXd& gradient) const;
};

Part part_at(const Problem& problem, const Member& member, std::vector<double> p);

/// What all records know of the common values, and what follows from it.
struct Common {
  MatrixXd information, inverse;
  std::vector<bool> free, open;
};

Common common_of(const Problem& problem, const std::vector<Part>& parts, const std::vector<double>& values);

/// Leaves out of a record the common values that no record determines.
void drop_open(const Common& common, Part& part);

/// Slow noise of the level, where the record shows it without any model or shares nothing, as a fit of it alone has it:
/// what else differs between records that share is tested.
SlowLevels slow_levels_of(const Part& part, const CycleEvidence& evidence);

/// Whether the records allow what they share.
SharingTest test_of(const std::vector<Part>& parts, const Common& common);

/// Held-out squares of each cycle of all records, over the variance of its record, and the error of all of them: of the
/// records together, and of each by itself where its own fit ended.
Fit held_out_together(const Problem& problem, const std::vector<Part>& parts, const Common& common);
Fit held_out_alone(const Problem& problem);

}  // namespace tribofit::sharing
