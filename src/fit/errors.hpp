#pragma once

#include <cstddef>
#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// The slips of a record, sample by sample, with the channels a model needs. Slips point into the Motion.
class FullRecord {
 public:
  FullRecord(const Motion& motion, const Observations& observations, const Channels& needs);
  Slip slip(const Observations::Range& range) const;
  const Motion& motion() const { return motion_; }

 private:
  const Motion& motion_;
  const Observations& observations_;
  std::vector<double> acceleration_, angle_, distance_;
};

/// What a model leaves on every sample.
struct SampleErrors {
  ErrorFigures figures;         ///< held_out_rmse not set
  std::vector<double> squares;  ///< sum of squares of each cycle, break-away included
  std::vector<double> counts;   ///< residuals of each cycle
  double constant_rmse = 0;     ///< what a constant |friction| would leave
};
SampleErrors sample_errors(const FrictionModel& model, const std::vector<double>& p, const FullRecord& record,
                           const Observations& observations);

}  // namespace tribofit
