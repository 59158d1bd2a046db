#include "ensemble_sampler.hpp"

#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace tribofit {

namespace {

/// A step goes from half to twice the way to the other walker.
constexpr double kStretch = 2;

double finite_or_none(double log_density) {
  return std::isnan(log_density) ? -std::numeric_limits<double>::infinity() : log_density;
}

}  // namespace

std::vector<std::vector<double>> sample_ensemble(const LogDensity& density, std::vector<std::vector<double>> start,
                                                 std::size_t discarded, std::size_t kept, std::uint64_t seed) {
  std::vector<std::vector<double>> walkers = std::move(start), out;
  if (walkers.empty()) return out;
  const std::size_t half = walkers.size() / 2, dimension = walkers.front().size();
  std::vector<double> heights;
  for (const auto& walker : walkers) heights.push_back(finite_or_none(density(walker)));
  std::mt19937_64 engine(seed);
  boost::random::uniform_real_distribution<double> uniform(0, 1);
  boost::random::uniform_int_distribution<std::size_t> other(0, half - 1);
  for (std::size_t round = 0; round < discarded + kept; ++round) {
    for (std::size_t k = 0; k < 2 * half; ++k) {
      const std::vector<double>& partner = walkers[(k < half ? half : 0) + other(engine)];
      const double root = 1 + (kStretch - 1) * uniform(engine), z = root * root / kStretch;
      std::vector<double> tried(dimension);
      for (std::size_t i = 0; i < dimension; ++i) tried[i] = partner[i] + z * (walkers[k][i] - partner[i]);
      const double height = finite_or_none(density(tried)), chance = uniform(engine);
      const double gained = static_cast<double>(dimension - 1) * std::log(z) + height - heights[k];
      if (!(std::log(chance) < gained)) continue;
      walkers[k] = std::move(tried);
      heights[k] = height;
    }
    if (round >= discarded) out.insert(out.end(), walkers.begin(), walkers.end());
  }
  return out;
}

}  // namespace tribofit
