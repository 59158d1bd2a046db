#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// An effect the user writes: a term added to |mu| in slip, e.g.
///   hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s
/// Variables: v [mm/s] (the speed |v_r|), acceleration [mm/s^2], t [s], angle [rad], distance [mm], stick_time [s],
/// load [N], temperature [degC]. The values behind the semicolon are starts; a unit behind a value converts it to the
/// unit of the variables above. A parameter named f is the frequency of a spectral line. Bounds may follow a start in
/// brackets: v0=25mm/s[5,60] (in the same units). Temperatures are in degC. Parsed by muParser.
class Formula {
 public:
  /// Throws InputError that shows where a formula does not parse, names unknown names (with the nearest known one) and
  /// parameters without a start.
  explicit Formula(std::string_view text);
  Formula(const Formula& other);
  Formula& operator=(const Formula& other);
  Formula(Formula&&) noexcept;
  Formula& operator=(Formula&&) noexcept;
  ~Formula();

  EffectInfo info() const;

  /// Both are the same expression of the same names; name, spaces and starts do not matter.
  bool same_as(const Formula& other) const;

  /// Adds the term to signed friction. Derivatives by central differences of each parameter (and of the speed).
  template <class T>
  void modulate_all(const T* p, const Slip& slip, std::span<const T> velocity, std::span<T> mu) const {
    const std::size_t n = slip.size();
    const std::size_t count = parameter_count();
    std::vector<double> values(count), terms(n), slopes;
    for (std::size_t k = 0; k < count; ++k) values[k] = scalar_part(p[k]);
    std::vector<double> speed(n);
    for (std::size_t i = 0; i < n; ++i) speed[i] = slip.speed(scalar_part(velocity[i]));
    evaluate(values, slip, speed, terms);
    std::vector<T> sum(terms.begin(), terms.end());
    if constexpr (!std::is_arithmetic_v<T>) {
      slopes.resize(n);
      for (std::size_t k = 0; k < count; ++k) {
        if (!varies(p[k])) continue;
        differentiate(k, values, slip, speed, slopes);
        for (std::size_t i = 0; i < n; ++i) sum[i] += slopes[i] * (p[k] - values[k]);
      }
      if (n > 0 && varies(velocity[0])) {
        differentiate(count, values, slip, speed, slopes);
        for (std::size_t i = 0; i < n; ++i) sum[i] += slopes[i] * (slip.speed(velocity[i]) - speed[i]);
      }
    }
    for (std::size_t i = 0; i < n; ++i) mu[i] += slip.direction * sum[i];
  }

  std::size_t parameter_count() const;

 private:
  struct Parsed;

  template <class T>
  static bool varies(const T& x) {
    return x.v.squaredNorm() > 0;
  }

  /// terms[i] of the formula for parameter values (SI) at every sample. Not finite where the expression is not.
  void evaluate(std::span<const double> values, const Slip& slip, std::span<const double> speed,
                std::span<double> terms) const;
  /// d term/d parameter k (k == parameter_count(): d term/d speed), by central differences.
  void differentiate(std::size_t k, std::span<const double> values, const Slip& slip, std::span<const double> speed,
                     std::span<double> slopes) const;

  std::unique_ptr<Parsed> parsed_;
};

}  // namespace tribofit
