#pragma once

#include <cmath>
#include <type_traits>

#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// Cosine and sine of an angle that turns by little from one sample to the next: each follows from the one before it by
/// a rotation, which is less work than the functions, and wrong by one rounding more for every turn.
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(double angle) : Rotation(std::cos(angle), std::sin(angle)) {}

  double cosine() const { return cosine_; }
  double sine() const { return sine_; }

  /// Turns up to here need no function: the next terms are below rounding.
  static constexpr double kSmall = 0.3;

  void turn(double by) {
    constexpr double kTiny = 0.02;  // up to here fewer terms do
    const double x = by * by;
    double c = 0, s = 0;
    if (std::abs(by) < kTiny) {
      c = 1 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720)));
      s = by * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040))));
    } else if (std::abs(by) < kSmall) {
      c = 1 - x * (1.0 / 2 -
                   x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x * (1.0 / 3628800 - x * (1.0 / 479001600))))));
      s = by * (1 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880 - x * (1.0 / 39916800))))));
    } else {
      c = std::cos(by), s = std::sin(by);
    }
    *this = *this * Rotation(c, s);
  }

  /// By the sum of both angles.
  friend Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a.cosine_ * b.cosine_ - a.sine_ * b.sine_, a.cosine_ * b.sine_ + a.sine_ * b.cosine_};
  }

 private:
  Rotation(double cosine, double sine) : cosine_(cosine), sine_(sine) {}

  double cosine_ = 1, sine_ = 0;
};

/// amplitude cos(angle + phase) at one angle after the other, with derivatives in amplitude and phase.
template <class T>
class Wave {
 public:
  Wave(const T& amplitude, const T& phase) {
    using std::cos;
    using std::sin;
    along_ = amplitude * cos(phase);
    across_ = -(amplitude * sin(phase));
  }

  T at(double cosine, double sine) const { return along_ * cosine + across_ * sine; }
  T at(const Rotation& angle) const { return at(angle.cosine(), angle.sine()); }
  /// Its slope over the angle.
  double slope(double cosine, double sine) const { return scalar_part(across_) * cosine - scalar_part(along_) * sine; }

 private:
  T along_, across_;
};

/// amplitude exp(-decay t) cos(w t + phase) at one time after the other, with derivatives in all four. decay [1/s];
/// w [rad/s]; t [s].
template <class T>
class WaveOverTime {
 public:
  WaveOverTime(const T& amplitude, const T& decay, const T& w, const T& phase)
      : wave_(amplitude, phase), decay_(scalar_part(decay)), w_(scalar_part(w)) {
    decay_change_ = decay - decay_;
    w_change_ = w - w_;
  }

  T at(double time) {
    go_to(time);
    const double cosine = size_ * turned_.cosine(), sine = size_ * turned_.sine();
    const T reading = wave_.at(cosine, sine);
    if constexpr (std::is_same_v<T, double>) {
      return reading;
    } else {
      return reading + (time * wave_.slope(cosine, sine) * w_change_ - time * scalar_part(reading) * decay_change_);
    }
  }

 private:
  void go_to(double time) {
    constexpr double kShort = 0.05;  // decays up to here need no function
    constexpr int kTurns = 128;      // now and then by the functions: roundings of a long record do not add up
    const double by = w_ * (time - time_), x = -decay_ * (time - time_);
    if (turns_ % kTurns == 0 || !(std::abs(by) < Rotation::kSmall) || !(std::abs(x) < kShort)) {
      turned_ = Rotation(w_ * time);
      size_ = decay_ == 0 ? 1 : std::exp(-decay_ * time);
    } else {
      turned_.turn(by);
      if (x != 0)
        size_ *=
            1 + x * (1 + x * (1.0 / 2 +
                              x * (1.0 / 6 +
                                   x * (1.0 / 24 + x * (1.0 / 120 + x * (1.0 / 720 + x * (1.0 / 5040 + x / 40320)))))));
    }
    ++turns_;
    time_ = time;
  }

  Wave<T> wave_;
  double decay_, w_;
  T decay_change_, w_change_;  ///< 0, with the derivatives
  Rotation turned_;
  double size_ = 1, time_ = 0;
  int turns_ = 0;
};

}  // namespace tribofit
