#pragma once

#include <string>
#include <vector>

#include "tribofit/friction/effects/all.hpp"

namespace tribofit {

/// What is drawn along one axis: values in SI, shown in `unit` of which one is `si`.
struct FingerprintAxis {
  std::string label;
  std::string unit;
  double si = 1;
};

/// A cloud of points of one name, SI.
struct FingerprintCloud {
  std::string name = {};
  std::vector<double> x = {}, y = {};

  void add(double at, double value) { x.push_back(at), y.push_back(value); }
};

/// Where the absence of an effect shows: a simulated record of the published 15 mm test, without noise, seen over the
/// variable that distinguishes the effect from others.
struct Fingerprint {
  FingerprintAxis x, y;
  std::vector<FingerprintCloud> clouds = {};  ///< one or two
  std::string conditions = {};                ///< what was simulated, e.g. "sigma = 0.001 s/mm"
};

/// The fingerprint of an effect of the catalogue, from a simulation with a clearly visible size of it; an effect
/// without a view of its own is shown by what the bare law leaves over v_r. Cost: below 0.1 s.
Fingerprint fingerprint(const Effect& effect);

}  // namespace tribofit
