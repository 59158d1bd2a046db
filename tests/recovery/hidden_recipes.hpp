#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "hidden_effects.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/oscillator/drive.hpp"

/// What is hidden in the benchmark: each effect of the catalogue in the sizes of hidden_sizes.cpp, and pairs.
namespace recovery {

/// Numbers from a seed, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Of deviation 1: the sum of twelve uniform numbers.
  double normal() {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += uniform(0, 1);
    return sum;
  }
  double sign() { return uniform(-1, 1) < 0 ? -1 : 1; }
  double phase() { return uniform(-std::numbers::pi, std::numbers::pi); }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(uniform(0, static_cast<double>(n))));
  }

 private:
  std::mt19937_64 engine_;
};

/// How a parameter is drawn, in its unit.
struct ValueDraw {
  std::vector<double> choices = {};  ///< one of these; empty: anything between the limits
  double lower = 0, upper = 0;
};

/// How large an effect is where people meet it. The first parameter must come back, and those that are decisive.
struct HiddenCases {
  std::vector<double> sizes = {};      ///< of the first parameter, in its unit, the least effect first
  bool either_sign = false;            ///< each size is as likely negative
  std::vector<ValueDraw> others = {};  ///< of the other parameters, in their order
};
/// Throws std::invalid_argument for an effect that has no row.
const HiddenCases& hidden_cases(std::string_view key);

/// An effect and the record in which it is hidden.
struct Recipe {
  tribofit::EffectInfo effect;
  HiddenCases hidden;
  Setting setting;
  Programme programme = Programme::stick_slip;
};

/// Every effect of the catalogue, in its order, in each setting in which the variable of its sketch varies.
const std::vector<Recipe>& recipes();
const Recipe& recipe(std::string_view key);

/// The effect in this size, or in one of its own, its other parameters drawn.
Ingredient ingredient(const Recipe& recipe, double size, Random& random);
Ingredient ingredient(const Recipe& recipe, Random& random);

/// The speed programme of a sliding record that shows the effect; none where only break-away or stick shows it, as its
/// header says.
std::optional<Programme> sliding_programme(const tribofit::EffectInfo& effect);

/// Scales of a record over those of the records for which effects state their sizes.
struct RelativeScales {
  double slip_time = 1, stick_time = 1, slip_length = 1, top_speed = 1, duration = 1, distance = 1, stroke = 1,
         mass = 1;
};
/// By how much a parameter is larger at these scales.
double growth_of(tribofit::BoundScaling scaling, const RelativeScales& scales);

/// Rig, law and noise about those of [D], walking through radii, laws, noise and scatter, so that every group of cases
/// holds all of them.
Case draw_case(std::string group, std::size_t number, Kind kind, Setting setting, std::uint64_t seed, Random& random);

/// A number from a name (FNV-1a).
std::uint64_t hash(std::string_view text, std::uint64_t seed);

/// The speed of the disc about `mean` [rad/s], at t = 0 and later (and constant, or as it goes on, before).
tribofit::SpeedProfile sliding_speed(Programme programme, double mean, Random& random);

/// Steady friction of a model at 60 speeds in equal ratios from 0.5 to 200 mm/s in each direction, with noise of that
/// deviation; p: its parameters [SI].
tribofit::Trace steady_points(const tribofit::FrictionModel& model, const std::vector<double>& p, double noise,
                              Random& random);

/// The case as a record of sliding, what is hidden in it on the scales of that.
void hide_in_sliding(Case& c, Programme programme);

/// The case on a rig that is `slowness` times slower: all times grow by it, all speeds fall.
Case slowed(Case c, double slowness);

/// Friction that wanders with a spectrum as 1/f, from a few times the length of the record to the sampling rate, of
/// deviation 1.
std::vector<double> flicker_noise(std::size_t size, Random& random);

struct Pair {
  const char *a, *b;
  double size_a, size_b;
  Setting setting;
};

extern const std::vector<Pair> kPairs;

/// Three effects hidden together.
struct Triple {
  const char* keys[3];
  double sizes[3];
  Setting setting;
};

extern const std::vector<Triple> kTriples;

}  // namespace recovery
