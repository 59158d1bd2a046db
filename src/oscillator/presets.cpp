#include "tribofit/oscillator/presets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

struct Row {
  double radius_mm, mu_s, mu_k, alpha_s_per_mm, beta_s_per_mm, stiffness_n_per_mm, mass_kg;
};
/// [D] Table 4, and our rigs.
constexpr std::array<Row, 4> kRows = {{{9, 0.521, 0.388, 0.03237, 0.05265, 11.0, 0.77},
                                       {12, 0.512, 0.375, 0.04161, 0.07548, 11.7, 0.80},
                                       {15, 0.509, 0.318, 0.05214, 0.09533, 16.2, 0.85},
                                       {18, 0.500, 0.355, 0.05377, 0.10580, 12.3, 0.93}}};
constexpr double kDampingRatio = 0.02;
constexpr double kLoad = 50;  // N
constexpr double kPublishedSpeed = 4 * kRpm;

/// The exponential law of a row as data would show it, up to the speed of a fast slip: three times that of the disc.
FrictionCurve curve_of(const Row& row) {
  constexpr int kBins = 80;
  const double fastest = 3 * 1e-3 * row.radius_mm * kPublishedSpeed;
  const std::array<double, 3> q = {row.mu_s, row.mu_k, 1e3 * row.alpha_s_per_mm};
  FrictionCurve curve{.bins = {}, .break_away = row.mu_s, .fastest = fastest};
  for (int k = 0; k < kBins; ++k) {
    const double v = fastest * (k + 0.5) / kBins;
    curve.bins.push_back({v, ExponentialLaw::friction(q.data(), ExponentialLaw::steepness(q.data()) * v), 1});
  }
  return curve;
}

std::vector<double> friction_of(const Row& row, const Law& law) {
  const std::map<std::string, double> table = {{static_level_name, row.mu_s},
                                               {kinetic_level_name, row.mu_k},
                                               {"alpha", 1e3 * row.alpha_s_per_mm},
                                               {"beta", 1e3 * row.beta_s_per_mm}};
  std::vector<double> q = std::visit([&](const auto& l) { return l.start(curve_of(row)); }, law);
  const std::vector<Parameter> parameters = describe(law).parameters;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const auto known = table.find(parameters[k].name);
    if (known != table.end()) q[k] = known->second;
  }
  return q;
}

}  // namespace

PublishedTest published_test(double radius, const Law& law) {
  const auto distance = [radius](const Row& row) { return std::abs(1e-3 * row.radius_mm - radius); };
  const Row& row = *std::min_element(kRows.begin(), kRows.end(),
                                     [&](const Row& a, const Row& b) { return distance(a) < distance(b); });
  return {.radius = 1e-3 * row.radius_mm,
          .speed = kPublishedSpeed,
          .load = kLoad,
          .rig = rig_with_damping_ratio(row.mass_kg, 1e3 * row.stiffness_n_per_mm, kDampingRatio),
          .friction = friction_of(row, law)};
}

}  // namespace tribofit
