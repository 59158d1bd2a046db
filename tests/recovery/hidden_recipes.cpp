#include "hidden_recipes.hpp"

#include <algorithm>

namespace recovery {

namespace {

std::vector<double> just(double size, Random&) {
  return {size};
}
std::vector<double> either_sign(double size, Random& r) {
  return {r.sign() * size};
}
std::vector<double> ageing(double size, Random& r) {
  return {size, r.uniform(0.05, 0.2)};
}

}  // namespace

const std::vector<Recipe> kRecipes = {
    {"viscous", Setting::fast, {0.0008, 0.0011, 0.0015}, just},
    {"stribeck-exponent", Setting::fast, {0.6, 1.4, 1.8}, just},
    {"frictional-lag", Setting::fast, {0.5, 1, 2}, just},
    {"rate-state",
     Setting::fast,
     {20, 50, 90},
     [](double s, Random&) {
       return std::vector{s, 0.0};
     }},
    {"bristle",
     Setting::fast,
     {100, 60, 30},
     [](double s, Random&) {
       return std::vector{s, 0.001};
     }},
    {"contact-spin", Setting::fast, {0.5, 1, 2}, just},
    {"ageing", Setting::four_speeds, {0.01, 0.015, 0.02}, ageing},
    {"ageing", Setting::pauses, {0.01, 0.015, 0.02}, ageing},
    {"asymmetry", Setting::both_directions, {0.93, 1.07, 1.15}, just},
    {"heating",
     Setting::slow,
     {0.05, 0.1},
     [](double s, Random& r) {
       return std::vector{r.sign() * s, r.uniform(8, 15)};
     }},
    {"run-in",
     Setting::slow,
     {0.05, 0.08},
     [](double s, Random& r) {
       return std::vector{r.sign() * s, r.uniform(30, 80)};
     }},
    {"drift", Setting::slow, {0.0006, 0.0009, 0.0012}, either_sign},
    {"step",
     Setting::slow,
     {0.015, 0.03},
     [](double s, Random& r) {
       return std::vector{r.sign() * s, r.uniform(8, 32)};
     },
     {0, 1}},
    {"load-dependence", Setting::load_swings, {0.1, 0.2, 0.3}, just},
    {"temperature-dependence", Setting::temperature_swings, {0.003, 0.006}, either_sign},
    {"runout",
     Setting::slow,
     {0.02, 0.04, 0.06},
     [](double s, Random& r) {
       return std::vector{s, r.phase()};
     }},
    {"disc-pattern",
     Setting::slow,
     {0.02, 0.04},
     [](double s, Random& r) {
       return std::vector{s, r.phase(), r.sign() < 0 ? 0 : 0.02, r.phase()};
     }},
    {"speed-ripple",
     Setting::slow,
     {0.03, 0.07},
     [](double s, Random& r) {
       return std::vector{s, 1.0 + static_cast<double>(r.below(3)), r.phase()};
     }},
    {"load-coupling", Setting::fast, {0.1, 0.2}, either_sign},
    {"ringing",
     Setting::fast,
     {0.008, 0.014},
     [](double s, Random& r) {
       return std::vector{s, r.uniform(150, 400), r.uniform(0.02, 0.06), r.phase()};
     },
     {0, 1}},
    {"sensor-inertia", Setting::fast, {0.1, 0.2}, just},
    {"sensor-offset", Setting::both_directions, {0.01, 0.02}, either_sign},
    {"crosstalk", Setting::load_swings, {0.01, 0.02}, either_sign},
    {"force-bandwidth",
     Setting::fast,
     {300, 200, 100},
     [](double s, Random& r) {
       return std::vector{s, r.uniform(0.5, 0.9)};
     }},
    {"channel-delay", Setting::fast, {0.5, 1, 2}, either_sign},
    {"radius-offset", Setting::fast, {0.94, 1.05}, just},
    {"velocity-gain", Setting::fast, {0.93, 1.08}, just},
    {"velocity-highpass", Setting::fast, {0.1, 0.3}, just},
    {"interference",
     Setting::fast,
     {0.005, 0.012},
     [](double s, Random& r) {
       constexpr double kLines[] = {50, 60, 133};
       return std::vector{s, kLines[r.below(3)], r.phase()};
     },
     {0, 1}},
};

const std::vector<Pair> kPairs = {
    {"frictional-lag", "runout", 1, 0.04, Setting::slow},
    {"viscous", "drift", 0.0011, 0.0012, Setting::slow},
    {"stribeck-exponent", "channel-delay", 1.4, 1, Setting::fast},
    {"sensor-inertia", "heating", 0.2, 0.1, Setting::slow},
    {"bristle", "interference", 60, 0.005, Setting::fast},
    {"rate-state", "runout", 90, 0.04, Setting::slow},
    {"viscous", "frictional-lag", 0.0015, 2, Setting::fast},
    {"force-bandwidth", "interference", 100, 0.012, Setting::fast},
    {"asymmetry", "sensor-offset", 1.15, 0.02, Setting::both_directions},
    {"load-dependence", "frictional-lag", 0.2, 1, Setting::load_swings},
    {"temperature-dependence", "viscous", 0.006, 0.0011, Setting::temperature_swings},
    {"radius-offset", "channel-delay", 1.05, 1, Setting::fast},
    {"velocity-highpass", "runout", 0.3, 0.04, Setting::slow},
    {"speed-ripple", "drift", 0.07, 0.0012, Setting::slow},
    {"step", "disc-pattern", 0.03, 0.04, Setting::slow},
    {"ringing", "runout", 0.014, 0.06, Setting::slow},
    {"run-in", "sensor-inertia", 0.08, 0.2, Setting::slow},
    {"drift", "runout", 0.0012, 0.04, Setting::slow},
};

const Recipe& recipe(std::string_view key) {
  return *std::find_if(kRecipes.begin(), kRecipes.end(), [&](const Recipe& r) { return key == r.key; });
}

}  // namespace recovery
