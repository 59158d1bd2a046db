#include "compression.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "net_displacement.hpp"

namespace tribofit::kinematics {

double decompressed(double reading, double part, double fastest) {
  constexpr int kSteps = 4;  // of Newton's method, from the reading: each squares what is left
  double v = reading;
  for (int k = 0; k < kSteps; ++k) {
    const double square = part * std::pow(v / fastest, 2);
    v -= (v * (1 - square) - reading) / std::max(0.1, 1 - 3 * square);
  }
  return v;
}

Compression find_compression(const Trace& trace, const PlateauSearch& search, const Estimate& mean) {
  Compression found;
  for (const double v : trace.velocity) found.fastest = std::max(found.fastest, std::abs(v));
  if (!(found.fastest > 0)) return found;
  std::vector<double> velocity(trace.size());
  const auto mean_at = [&](double part) {
    std::transform(trace.velocity.begin(), trace.velocity.end(), velocity.begin(),
                   [&](double v) { return decompressed(v, part, found.fastest); });
    return mean_velocity(trace.time, velocity, search).value;
  };
  // Secants: the mean is nearly a straight line of the part.
  double before = 0, mean_before = mean.value, part = 0.01;
  constexpr int kSecants = 6;
  double slope = 0;
  for (int k = 0; k < kSecants && std::abs(part) < 2 * kMostCompressed; ++k) {
    const double here = mean_at(part);
    if (here == mean_before || part == before) break;
    slope = (here - mean_before) / (part - before);
    before = part, mean_before = here;
    part -= here / slope;
  }
  if (!(std::abs(part) <= kMostCompressed) || slope == 0) return found;
  // From the largest reading to what it stands for.
  const double true_fastest = decompressed(found.fastest, part, found.fastest);
  const double scale = std::pow(true_fastest / found.fastest, 2);
  found.fastest = true_fastest;
  // Another characteristic would lose as much elsewhere in the slip.
  found.part = {scale * part, scale * std::hypot(mean.std_error / slope, kOtherCharacteristic * part)};
  return found;
}

}  // namespace tribofit::kinematics
