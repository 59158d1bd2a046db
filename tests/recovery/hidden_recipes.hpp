#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "hidden_effects.hpp"

/// What is hidden in the benchmark: each effect with its sizes, and pairs of effects.
namespace recovery {

using namespace tribofit;

/// Numbers from a seed, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double sign() { return uniform(-1, 1) < 0 ? -1 : 1; }
  double phase() { return uniform(-std::numbers::pi, std::numbers::pi); }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(uniform(0, static_cast<double>(n))));
  }

 private:
  std::mt19937_64 engine_;
};

using Values = std::vector<double> (*)(double size, Random&);

/// An effect, the sizes in which a user meets it, and how it is recorded. Units of the catalogue.
struct Recipe {
  const char* key;
  Setting setting;
  std::vector<double> sizes;
  Values values;
  std::vector<std::size_t> main_parameters = {0};
};

/// Every effect that a simulated record can hold.
extern const std::vector<Recipe> kRecipes;
const Recipe& recipe(std::string_view key);

struct Pair {
  const char *a, *b;
  double size_a, size_b;
  Setting setting;
};

extern const std::vector<Pair> kPairs;

}  // namespace recovery
