#pragma once

#include <cmath>

#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// Cosine and sine of an angle that turns by little from one sample to the next: each follows from the one before it by
/// a rotation, which is less work than the functions, and wrong by one rounding more for every turn.
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(double angle) : cosine_(std::cos(angle)), sine_(std::sin(angle)) {}

  double cosine() const { return cosine_; }
  double sine() const { return sine_; }

  /// Turns up to here need no function: the next terms are below rounding.
  static constexpr double kSmall = 0.3;

  void turn(double by) {
    const double x = by * by;
    double c =
        1 - x * (1.0 / 2 -
                 x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x * (1.0 / 3628800 - x * (1.0 / 479001600))))));
    double s =
        by * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880 - x * (1.0 / 39916800))))));
    if (!(std::abs(by) < kSmall)) c = std::cos(by), s = std::sin(by);
    const double before = cosine_;
    cosine_ = before * c - sine_ * s;
    sine_ = before * s + sine_ * c;
  }

 private:
  double cosine_ = 1, sine_ = 0;
};

/// cos(w t + phase) at one time after the other, with derivatives in w and phase. w [rad/s]; t [s].
template <class T>
class WaveOverTime {
 public:
  WaveOverTime(const T& w, const T& phase) : w_(w), phase_(phase) {}

  T at(double time) {
    const T angle = w_ * time + phase_;
    const double by = scalar_part(w_) * (time - time_);
    // Now and then by the functions: roundings of a long record do not add up.
    constexpr int kTurns = 128;
    if (turns_ % kTurns == 0 || !(std::abs(by) < Rotation::kSmall)) {
      rotation_ = Rotation(scalar_part(angle));
    } else {
      rotation_.turn(by);
    }
    ++turns_;
    time_ = time;
    return T(rotation_.cosine() - rotation_.sine() * (angle - scalar_part(angle)));
  }

 private:
  T w_, phase_;
  Rotation rotation_;
  double time_ = 0;
  int turns_ = 0;
};

}  // namespace tribofit
