#pragma once

#include <cstdint>
#include <memory>

#include "tribofit/fit/fit.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {

/// Machines that a record leaves possible.
///
/// The covariance of a fit knows the curvature at its minimum. Where a record hardly fixes an effect (a run-in of w =
/// -0.09 +- 0.11 over L = 74 +- 160 mm), some of what is drawn with it contradicts the record: of six such draws one
/// has no run-in at all, though without one the record is not described. So a draw whose squares rise by far more than
/// the covariance promises is taken back towards the minimum.
class PlausibleDraws {
 public:
  PlausibleDraws() = default;
  /// known: of `record`, which must outlive this object.
  PlausibleDraws(const IdentifiedMachine& known, const Record& record);

  /// One machine; the same for the same seed. Cost: a few passes over some values of each slip.
  Machine draw(std::uint64_t seed) const;

 private:
  struct Squares;
  IdentifiedMachine known_;
  std::shared_ptr<const Squares> squares_;
};

}  // namespace tribofit
