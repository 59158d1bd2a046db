#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tribofit/friction/rotation.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// cos(n theta + phase) at the samples of a slip, in order. n: waves a revolution; theta: angle of the disc [rad], 0
/// where it is not known.
template <class T>
class WaveAlongSlip {
 public:
  WaveAlongSlip(double n, const Slip& slip, const T& phase) : n_(n), angle_(slip.angle) {
    using std::cos;
    using std::sin;
    if (!angle_.empty()) theta_ = angle_[0];
    const T begin = phase + n * theta_;
    cosine_of_begin_ = cos(begin);
    sine_of_begin_ = sin(begin);
  }

  /// At a sample that is none before the one asked for last.
  T at(std::size_t sample) {
    if (!angle_.empty()) {
      turned_.turn(n_ * (angle_[sample] - theta_));
      theta_ = angle_[sample];
    }
    return cosine_of_begin_ * turned_.cosine() - sine_of_begin_ * turned_.sine();
  }

 private:
  double n_;
  std::span<const double> angle_;
  double theta_ = 0;  ///< where it has turned to
  T cosine_of_begin_, sine_of_begin_;
  Rotation turned_;  ///< by n (theta - first theta)
};

}  // namespace tribofit
