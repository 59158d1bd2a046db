#include "tribofit/oscillator/presets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
constexpr double kLoad = 50;                                       // N
constexpr double kPublishedSpeed = 4 * 2 * std::numbers::pi / 60;  // 4 rpm in rad/s

}  // namespace

PublishedTest published_test(double radius, BaseLaw law) {
  const auto distance = [radius](const Row& row) { return std::abs(1e-3 * row.radius_mm - radius); };
  const Row& row = *std::min_element(kRows.begin(), kRows.end(),
                                     [&](const Row& a, const Row& b) { return distance(a) < distance(b); });
  double decay = 0;
  if (law == BaseLaw::exponential) decay = 1e3 * row.alpha_s_per_mm;
  if (law == BaseLaw::fractional) decay = 1e3 * row.beta_s_per_mm;
  return {.radius = 1e-3 * row.radius_mm,
          .speed = kPublishedSpeed,
          .load = kLoad,
          .rig = rig_with_damping_ratio(row.mass_kg, 1e3 * row.stiffness_n_per_mm, kDampingRatio),
          .friction = {row.mu_s, row.mu_k, decay}};
}

}  // namespace tribofit
