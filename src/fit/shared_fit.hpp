#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "model_residuals.hpp"
#include "starts.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// One record of several that share parameters, with what its own fit found.
struct SharingRecord {
  static constexpr std::size_t kOwn = static_cast<std::size_t>(-1);
  const Observations* observations = nullptr;
  bool is_points = false;
  std::vector<double> values;       ///< of the fit of this record alone [SI]
  std::vector<std::size_t> common;  ///< for each parameter the common value that it takes; kOwn: one of its own
};

/// A value with its statistical error [SI].
struct SharedEstimate {
  double value = 0;
  double std_error = 0;             ///< infinite where not determined; with what differs between records
  double lower95 = 0, upper95 = 0;  ///< infinite where not determined
  double statistical = 0;           ///< from the blocks of the records alone
  double degrees_of_freedom = 1;
  bool determined = true, at_bound = false;
};

/// Whether records allow what they are made to share.
///
/// Each record pulls at the common values with a score, whose covariance its blocks give: along the directions of which
/// it knows something, the squares of all scores over their variances add up to F of `degrees_of_freedom` where sharing
/// holds.
struct SharingTest {
  double ratio = std::numeric_limits<double>::quiet_NaN();  ///< mean square of the scores over their variance
  double degrees_of_freedom = 0;                            ///< 0: nothing is shared that could differ
  double p_value = 1;
  std::size_t most_different = 0;  ///< index of the record whose scores are largest
  bool is_refused() const;
};

/// Several records fitted together.
struct RecordsFit {
  bool converged = false;
  std::string message;
  std::vector<SharedEstimate> common;
  std::vector<std::vector<SharedEstimate>> records;  ///< every parameter of each record
  SharingTest test;
  /// Held-out squares of these parameters against those of every record by itself, over the cycles of all records.
  Comparison held_out;
  double held_out_rmse_together = 0, held_out_rmse_alone = 0;  ///< over the values [1 or N]
};

/// Fits one model to several records at once: all samples, with values that records share and values of their own.
///
/// Each record leaves what its own fit leaves (ModelResiduals: whitened, with break-away scatter and its own noise),
/// and weighs by the variance that its own fit leaves. The values are found block by block, see minimize(). Errors come
/// from the influence of each cycle on all values: to one record the others are knowledge from elsewhere, which adds to
/// its normal equations, so that influences are those of a single fit. What the records contribute is independent
/// between them. bounds: of the parameters of every record. Cost: linear in values; cubic in common values.
RecordsFit fit_sharing_records(const FrictionModel& model, std::span<const SharingRecord> records, const Bounds& bounds,
                               std::size_t common_count);

namespace sharing {

/// A record as the fit of all sees it.
struct Member {
  Member(const FrictionModel& model, const SharingRecord& given)
      : record(given), residuals(model, *given.observations, all_slips(*given.observations)) {}
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  void whiten_at(const std::vector<double>& p) {
    whitening = residuals.whitening_at(p.data());
    residuals.whiten(whitening, true);  // which forgets what was whitened otherwise
  }

  const SharingRecord& record;
  ModelResiduals residuals;
  ModelResiduals::Whitening whitening;
  double weight = 1;               ///< one over the variance of a row
  std::vector<std::size_t> index;  ///< of each parameter among all values
};

/// All values in one array: the common ones first, then those of each record.
struct Problem {
  const FrictionModel& model;
  std::size_t common_count = 0;
  std::vector<double> lower, upper;  ///< of all values
  std::deque<Member> members;

  std::vector<double> of_member(const Member& member, const std::vector<double>& values) const {
    std::vector<double> p;
    for (const std::size_t k : member.index) p.push_back(values[k]);
    return p;
  }
};

/// Fills `out` with errors, test and held-out comparison at the values that were found.
void add_errors(const Problem& problem, const std::vector<double>& values, RecordsFit& out);

}  // namespace sharing

}  // namespace tribofit
