#pragma once

#include <cstddef>
#include <span>

#include "tribofit/friction/rotation.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// Where the disc stands at the samples of a slip: rotated by its angle theta, 0 where that is not known. A wave with n
/// periods a revolution takes the n-th power of the rotation.
class TurnAlongSlip {
 public:
  explicit TurnAlongSlip(const Slip& slip) : angle_(slip.angle) {}

  /// Little work for samples in order.
  const Rotation& at(std::size_t sample) {
    if (!angle_.empty()) theta_.go_to(angle_[sample]);
    return theta_.rotation();
  }

 private:
  std::span<const double> angle_;
  FollowedAngle theta_;
};

}  // namespace tribofit
