#pragma once

#include <cmath>

namespace tribofit {

/// A rotation in the plane by an angle, as its cosine and sine.
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(double angle) : Rotation(std::cos(angle), std::sin(angle)) {}

  double cosine() const { return cosine_; }
  double sine() const { return sine_; }

  /// Angles below this need no function: the next terms of the series are below rounding. [rad]
  static constexpr double kSmall = 0.3;

  /// By an angle below kSmall.
  static Rotation small(double angle) {
    constexpr double kTiny = 0.02;  // below this half of the terms do
    const double x = angle * angle;
    if (std::abs(angle) < kTiny) {
      return {1 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720))),
              angle * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040))))};
    }
    return {
        1 - x * (1.0 / 2 -
                 x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x * (1.0 / 3628800 - x * (1.0 / 479001600)))))),
        angle * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880 - x * (1.0 / 39916800))))))};
  }

  /// By the sum of both angles.
  friend Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a.cosine_ * b.cosine_ - a.sine_ * b.sine_, a.cosine_ * b.sine_ + a.sine_ * b.cosine_};
  }

 private:
  Rotation(double cosine, double sine) : cosine_(cosine), sine_(sine) {}

  double cosine_ = 1, sine_ = 0;
};

/// Cosine and sine of an angle that changes by little from one sample to the next: each follows from the one before it
/// by a rotation, which is less work than the functions, and wrong by one rounding more for every turn.
class FollowedAngle {
 public:
  const Rotation& rotation() const { return rotation_; }

  /// True where it began anew, by the functions: after a large turn, and now and then so that roundings do not add up.
  bool go_to(double angle) {
    constexpr int kTurns = 128;
    const double by = angle - angle_;
    const bool anew = turns_ % kTurns == 0 || !(std::abs(by) < Rotation::kSmall);
    rotation_ = anew ? Rotation(angle) : rotation_ * Rotation::small(by);
    turns_ = anew ? 1 : turns_ + 1;
    angle_ = angle;
    return anew;
  }

 private:
  Rotation rotation_;
  double angle_ = 0;
  int turns_ = 0;
};

}  // namespace tribofit
