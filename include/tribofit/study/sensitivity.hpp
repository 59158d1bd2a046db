#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tribofit/study/settled.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

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
