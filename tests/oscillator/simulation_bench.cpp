// Times of simulations, events only: one hour at the 15 mm rig of [D] by each law, and the smoothed law of [U].
// One line each: what, events, seconds (the best of five).

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>

#include "rigs.hpp"
#include "tribofit/study/smoothed.hpp"

namespace tribofit {
namespace {

void time_it(std::string_view what, const std::function<std::size_t()>& simulation) {
  double best = 1e300;
  std::size_t slips = 0;
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    slips = simulation();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  fmt::print("{:<60} {:>6} slips {:>8.3f} s\n", what, slips, best);
}

void run() {
  for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{}), Law(CoulombLaw{})}) {
    const Case c = published_case(0.015, law);
    time_it(fmt::format("one hour at the 15 mm rig of [D], {}", to_string(law)),
            [&] { return simulate(c, {.duration = 3600, .rate = 0}).slips.size(); });
  }
  Case lag = published_case(0.015, ExponentialLaw{});
  lag.model = FrictionModel(ExponentialLaw{}, {FrictionalLag{}});
  lag.p.push_back(2e-3);
  time_it("one hour at the 15 mm rig of [D], exponential + lag",
          [&] { return simulate(lag, {.duration = 3600, .rate = 0}).slips.size(); });
  const SmoothedLaw law{.mu_brk = 0.6, .mu_c = 0.1, .decay = 330, .sharpness = 5e5};
  const Drive drive{.speed = constant_speed(0.5e-3), .radius = 1, .mean_load = 10};
  time_it("one hour of [U] Fig 2, smoothed law, s = 500 s/mm", [&] {
    return simulate_smoothed({1000, 200, 5000}, drive, law, {.duration = 3600, .rate = 0}).slips.size();
  });
}

}  // namespace
}  // namespace tribofit

int main() {
  tribofit::run();
}
