#pragma once

#include <cmath>
#include <cstddef>

namespace tribofit {

/// Derivatives in N directions, two to a register of any 64-bit processor.
template <std::size_t N>
struct Derivatives {
  static_assert(N > 0 && N % 2 == 0);
  static constexpr std::size_t pairs = N / 2;
  using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
  Pair pair[pairs];

  double operator[](std::size_t k) const { return pair[k / 2][k % 2]; }
  double squaredNorm() const {
    Pair sum = {};
    for (const Pair& x : pair) sum += x * x;
    return sum[0] + sum[1];
  }

  [[gnu::always_inline]] friend Derivatives operator+(const Derivatives& x, const Derivatives& y) {
    Derivatives out;
    for (std::size_t k = 0; k < pairs; ++k) out.pair[k] = x.pair[k] + y.pair[k];
    return out;
  }
  [[gnu::always_inline]] friend Derivatives operator-(const Derivatives& x, const Derivatives& y) {
    Derivatives out;
    for (std::size_t k = 0; k < pairs; ++k) out.pair[k] = x.pair[k] - y.pair[k];
    return out;
  }
  [[gnu::always_inline]] friend Derivatives operator-(const Derivatives& x) {
    Derivatives out;
    for (std::size_t k = 0; k < pairs; ++k) out.pair[k] = -x.pair[k];
    return out;
  }
  [[gnu::always_inline]] friend Derivatives operator*(double s, const Derivatives& x) {
    Derivatives out;
    for (std::size_t k = 0; k < pairs; ++k) out.pair[k] = Pair{s, s} * x.pair[k];
    return out;
  }
};

/// A number with its derivatives: the value and every derivative to the last bit those of ceres::Jet<double, N>, by the
/// same formulas, but always inlined and in plain registers. Of Jet the compiler leaves many operators as calls, and
/// what a model leaves then takes half as long again.
template <std::size_t N>
struct Dual {
  double a = 0;
  Derivatives<N> v = {};

  Dual() = default;
  explicit Dual(double value) : a(value) {}
  Dual(double value, const Derivatives<N>& derivatives) : a(value), v(derivatives) {}
  /// The variable of direction k.
  Dual(double value, std::size_t k) : a(value) { v.pair[k / 2][k % 2] = 1; }

  Dual& operator+=(const Dual& y) { return *this = *this + y; }
  Dual& operator-=(const Dual& y) { return *this = *this - y; }
  Dual& operator*=(const Dual& y) { return *this = *this * y; }
  Dual& operator/=(const Dual& y) { return *this = *this / y; }
  Dual& operator+=(double s) { return *this = *this + s; }
  Dual& operator-=(double s) { return *this = *this - s; }
  Dual& operator*=(double s) { return *this = *this * s; }
  Dual& operator/=(double s) { return *this = *this / s; }

  [[gnu::always_inline]] friend Dual operator+(const Dual& x) { return x; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x) { return {-x.a, -x.v}; }
  [[gnu::always_inline]] friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, const Dual& y) {
    return {x.a * y.a, x.a * y.v + y.a * x.v};
  }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, const Dual& y) {
    const double inverse = 1 / y.a, ratio = x.a * inverse;
    return {ratio, inverse * (x.v - ratio * y.v)};
  }
  [[gnu::always_inline]] friend Dual operator+(const Dual& x, double s) { return {x.a + s, x.v}; }
  [[gnu::always_inline]] friend Dual operator+(double s, const Dual& x) { return {x.a + s, x.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, double s) { return {x.a - s, x.v}; }
  [[gnu::always_inline]] friend Dual operator-(double s, const Dual& x) { return {s - x.a, -x.v}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, double s) { return {x.a * s, s * x.v}; }
  [[gnu::always_inline]] friend Dual operator*(double s, const Dual& x) { return {x.a * s, s * x.v}; }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, double s) { return x * (1 / s); }
  [[gnu::always_inline]] friend Dual operator/(double s, const Dual& x) { return {s / x.a, (-s / (x.a * x.a)) * x.v}; }

  friend bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend bool operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend bool operator<(const Dual& x, double s) { return x.a < s; }
  friend bool operator>(const Dual& x, double s) { return x.a > s; }
  friend bool operator<(double s, const Dual& x) { return s < x.a; }
  friend bool operator>(double s, const Dual& x) { return s > x.a; }

  [[gnu::always_inline]] friend Dual abs(const Dual& x) { return {std::abs(x.a), std::copysign(1.0, x.a) * x.v}; }
  [[gnu::always_inline]] friend Dual sqrt(const Dual& x) {
    const double root = std::sqrt(x.a);
    return {root, (1 / (2 * root)) * x.v};
  }
  [[gnu::always_inline]] friend Dual exp(const Dual& x) {
    const double value = std::exp(x.a);
    return {value, value * x.v};
  }
  [[gnu::always_inline]] friend Dual log(const Dual& x) { return {std::log(x.a), (1 / x.a) * x.v}; }
  [[gnu::always_inline]] friend Dual sin(const Dual& x) { return {std::sin(x.a), std::cos(x.a) * x.v}; }
  [[gnu::always_inline]] friend Dual cos(const Dual& x) { return {std::cos(x.a), -std::sin(x.a) * x.v}; }
  [[gnu::always_inline]] friend Dual tanh(const Dual& x) {
    const double value = std::tanh(x.a);
    return {value, (1 - value * value) * x.v};
  }
};

}  // namespace tribofit
