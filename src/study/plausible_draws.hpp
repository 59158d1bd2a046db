#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {

/// Machines that a record leaves possible.
///
/// The covariance of a fit is no guide to them where a record hardly fixes an effect: of a heating of h = 0.08 +- 0.46
/// over tau = 20 s +- infinity the one that warms nothing is drawn as often as the one that is there, though without
/// one the record is not described. So parameters are drawn as the likelihood allows them, within their bounds, those
/// that are positive uniformly in their logarithm; weakened by kTemper, as the odds between models are.
class PlausibleDraws {
 public:
  PlausibleDraws() = default;
  /// known: of `record`; fit: says to which load and temperature its parameters refer. Cost: several hundred passes
  /// over some values of each slip.
  PlausibleDraws(const IdentifiedMachine& known, const Record& record, const Fit& fit);

  /// One machine; the same for the same seed. Its rig is drawn by the covariance of its fit.
  Machine draw(std::uint64_t seed) const;

 private:
  IdentifiedMachine known_;
  std::shared_ptr<const std::vector<std::vector<double>>> parameters_;  ///< that are possible; none: by covariance
};

}  // namespace tribofit
