#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/study/critical_speed.hpp"
#include "tribofit/study/identified.hpp"
#include "tribofit/study/settled.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

/// Settled motion of a machine over values [SI] of one of its variables. Cost: below 1 ms a value where motion settles
/// at once; on `threads` threads (0: as many as there are), which do not change the result.
/// done: called after each value, from any of them.
std::vector<Settled> sweep(const Machine& machine, std::string_view variable, std::span<const double> values,
                           const SettleOptions& options = {}, int threads = 0, const std::function<void()>& done = {});

/// `count` values from low to high, both included, equally far apart or (logarithmic) in equal ratios.
std::vector<double> evenly_spaced(double low, double high, std::size_t count, bool logarithmic = false);

/// How a machine moves over the speed of its disc.
struct SpeedStudy {
  std::vector<double> velocity;     ///< omega r [m/s]
  std::vector<Settled> up, down;    ///< begun in stick, and in steady sliding
  std::vector<double> growth_rate;  ///< of a small vibration about steady sliding [1/s]
  CriticalSpeed critical;
  Interval linear_interval;                      ///< of the last of critical.linear [m/s]
  Interval vanishes_interval, returns_interval;  ///< of critical.stick_vanishes and stick_returns [m/s]
  Settled own;                                   ///< at the machine's own speed
  std::vector<Interval> own_intervals;           ///< of its measures, in the order of measures()
};

struct SpeedStudyOptions {
  /// omega r [m/s]; empty: `points` from a tenth of the machine's own to beyond the critical.
  std::vector<double> velocity;
  std::size_t points = 40;
  MachineCovariance covariance = {};
  std::size_t draws = 200;
  std::uint64_t seed = 1;
  SettleOptions settle = {};
  int threads = 0;
  std::function<void(double)> progress = {};  ///< called with the part done, from one thread at a time
};

/// Measures over speed, critical speed both ways, and what the uncertainty of the machine makes of them (draws of all
/// its numbers, each studied alike). Throws as settle() and critical_speed() do.
SpeedStudy study_speed(const Machine& machine, const SpeedStudyOptions& options = {});

/// How measures answer to one variable.
struct Sensitivity {
  Variable variable;
  double base = 0;               ///< value of the machine [SI]
  std::vector<double> values;    ///< swept [SI]
  std::vector<Settled> settled;  ///< at those
  /// d ln measure/d ln variable at the machine, by central differences of one per cent, in the order of measures();
  /// NaN where the regime changes within them or the measure is zero.
  std::vector<double> elasticities;
};

struct SensitivityOptions {
  /// Empty: stiffness, mass, damping, load, velocity, ratio, and the other parameters of the law and of every effect.
  std::vector<std::string> variables;
  double factor = 2;       ///< swept from 1/factor to factor times the machine's own value
  std::size_t count = 21;  ///< in equal ratios
  SettleOptions settle = {};
  int threads = 0;
  std::function<void(double)> progress = {};  ///< called with the part done, from one thread at a time
};

/// Sweeps of every variable. Throws as settle() does, and for an unknown variable.
std::vector<Sensitivity> study_sensitivity(const Machine& machine, const SensitivityOptions& options = {});

/// Indices of `all` by the size of the elasticity of a measure (an index in measures()), the largest first; those
/// without one last.
std::vector<std::size_t> ranked(const std::vector<Sensitivity>& all, std::size_t measure);

}  // namespace tribofit
