#pragma once

#include <cmath>
#include <type_traits>

#include "tribofit/friction/rotation.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

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

  T at(const Rotation& angle) const { return at(angle.cosine(), angle.sine()); }
  /// The same with cosine and sine of the angle, which may both be scaled.
  T at(double cosine, double sine) const { return along_ * cosine + across_ * sine; }
  /// Its derivative by the angle, at a constant scale.
  double slope(double cosine, double sine) const { return scalar_part(across_) * cosine - scalar_part(along_) * sine; }

 private:
  T along_, across_;
};

/// amplitude exp(-decay t) cos(w t + phase) at one time after the other, with derivatives in all four. decay [1/s];
/// w [rad/s]; t [s].
template <class T>
class WaveOverTime {
 public:
  /// Without decay.
  WaveOverTime(const T& amplitude, const T& w, const T& phase)
      : wave_(amplitude, phase), decays_(false), w_(scalar_part(w)), w_change_(w - w_) {}
  WaveOverTime(const T& amplitude, const T& decay, const T& w, const T& phase)
      : wave_(amplitude, phase),
        decays_(true),
        w_(scalar_part(w)),
        decay_(scalar_part(decay)),
        w_change_(w - w_),
        decay_change_(decay - decay_) {}

  T at(double time) {
    const bool anew = turned_.go_to(w_ * time);
    if (decays_) decay_to(-decay_ * time, anew);
    const double cosine = size_ * turned_.rotation().cosine(), sine = size_ * turned_.rotation().sine();
    const T reading = wave_.at(cosine, sine);
    if constexpr (std::is_same_v<T, double>) {
      return reading;
    } else {
      const T turned = reading + time * wave_.slope(cosine, sine) * w_change_;
      return decays_ ? T(turned - time * scalar_part(reading) * decay_change_) : turned;
    }
  }

 private:
  /// As the angle is followed: the size follows from the one before it.
  void decay_to(double exponent, bool anew) {
    constexpr double kSmall = 0.05;  // below this the next terms of the series are below rounding
    const double x = exponent - exponent_;
    if (anew || !(std::abs(x) < kSmall)) {
      size_ = std::exp(exponent);
    } else {
      size_ *=
          1 + x * (1 + x * (1.0 / 2 +
                            x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x * (1.0 / 720 + x * (1.0 / 5040)))))));
    }
    exponent_ = exponent;
  }

  Wave<T> wave_;
  bool decays_;
  double w_, decay_ = 0;
  T w_change_, decay_change_{};  ///< 0, with the derivatives
  FollowedAngle turned_;
  double size_ = 1, exponent_ = 0;
};

}  // namespace tribofit
