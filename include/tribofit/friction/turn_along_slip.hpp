#pragma once

#include <cstddef>
#include <span>

#include "tribofit/friction/rotation.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// Where the disc stands at the samples of a slip, in order: its angle theta [rad], 0 where it is not known. Its waves,
/// n to a revolution, are those of the n-th power of what it has turned.
class TurnAlongSlip {
 public:
  explicit TurnAlongSlip(const Slip& slip) : angle_(slip.angle) {
    if (angle_.empty()) return;
    theta_ = angle_[0];
    turned_ = Rotation(theta_);
  }

  /// At a sample that is none before the one asked for last.
  const Rotation& at(std::size_t sample) {
    if (!angle_.empty()) {
      turned_.turn(angle_[sample] - theta_);
      theta_ = angle_[sample];
    }
    return turned_;
  }

 private:
  std::span<const double> angle_;
  double theta_ = 0;  ///< where it has turned to
  Rotation turned_;
};

}  // namespace tribofit
