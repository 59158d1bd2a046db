#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// cos(n theta + phase) at the samples of a slip, in order. The disc turns by little from one to the next, so each
/// follows from the one before it by a rotation: less work than the function, and wrong by one rounding more for
/// every sample. n: waves a revolution; theta: angle of the disc [rad], 0 where it is not known.
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
      turn(n_ * (angle_[sample] - theta_));
      theta_ = angle_[sample];
    }
    return cosine_of_begin_ * cosine_ - sine_of_begin_ * sine_;
  }

 private:
  void turn(double by) {
    constexpr double kSmall = 0.1;  // the next terms are below rounding
    const double x = by * by;
    double c = 1 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x / 40320)));
    double s = by * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x / 362880))));
    if (!(std::abs(by) < kSmall)) c = std::cos(by), s = std::sin(by);
    const double before = cosine_;
    cosine_ = before * c - sine_ * s;
    sine_ = before * s + sine_ * c;
  }

  double n_;
  std::span<const double> angle_;
  double theta_ = 0;  ///< where it has turned to
  T cosine_of_begin_, sine_of_begin_;
  double cosine_ = 1, sine_ = 0;  ///< of n (theta - first theta)
};

}  // namespace tribofit
