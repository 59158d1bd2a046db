#include "tribofit/friction/effect_pairs.hpp"

#include <array>

namespace tribofit {

namespace {

struct Pair {
  std::string_view a, b, test;
};

constexpr std::string_view kTap = "tap the resting block and compare the edges: without sliding there is no lag";
constexpr std::string_view kStopTheDisc =
    "stop the disc: a plateau that decays is the high-pass, a constant gap to omega r is the radius, a gap in "
    "proportion to d mu/dt is the bristle";
constexpr std::string_view kTwoRadii =
    "compare 9 mm at 8 rpm with 18 mm at 4 rpm: the sliding speed is the same, the spin is half";
constexpr std::string_view kJumps =
    "at re-stick plot the jump of mu against the jump of the block's acceleration: a straight line is a mass; or add "
    "100 g below the sensor";
constexpr std::string_view kPause = "pause ten minutes and restart: heating comes back, run-in does not";

constexpr std::array kPairs = {
    Pair{"asymmetry", "sensor-offset",
         "lift the block off the disc and read the force sensor: what it shows without contact is its zero"},
    Pair{"frictional-lag", "channel-delay",
         "double the disc speed: a delay of the channel stays the same in ms, also at re-stick; or tap the block and "
         "align the edges"},
    Pair{"frictional-lag", "force-bandwidth", kTap},
    Pair{"channel-delay", "force-bandwidth",
         "tap the block: an edge that is shifted is a delay, one that is slower is a filter"},
    Pair{"frictional-lag", "sensor-inertia", kJumps},
    Pair{"channel-delay", "sensor-inertia", kJumps},
    Pair{"force-bandwidth", "sensor-inertia", kJumps},
    Pair{"rate-state", "sensor-inertia", kJumps},
    Pair{"frictional-lag", "rate-state",
         "run at 1, 2, 4 and 8 rpm: the loop of mu over v_r stays constant in ms for a lag, in um for a memory of "
         "distance"},
    Pair{"rate-state", "channel-delay",
         "tap the block and align the edges: only a delay of the channel shows without sliding"},
    Pair{"rate-state", "force-bandwidth", kTap},
    Pair{"rate-state", "bristle",
         "look at the stick: with a bristle v_r is not zero there; or reverse the disc 5 to 50 um below break-away: an "
         "elastic return is a bristle"},
    Pair{"bristle", "velocity-highpass", kStopTheDisc},
    Pair{"bristle", "radius-offset", kStopTheDisc},
    Pair{"velocity-highpass", "radius-offset", kStopTheDisc},
    Pair{"bristle", "contact-spin", kTwoRadii},
    Pair{"radius-offset", "velocity-gain",
         "put an encoder on the disc, or tilt the laser by 10 degrees: only the gain changes with the tilt"},
    Pair{"speed-ripple", "runout",
         "point the laser at the unloaded disc: a ripple of the speed shows there, a runout does not"},
    Pair{"heating", "run-in", kPause},
    Pair{"heating", "drift", kPause},
    Pair{"run-in", "drift", kPause},
    Pair{"runout", "drift", "record at least three revolutions (45 s at 4 rpm): a runout comes back, a drift goes on"},
    Pair{"viscous", "stribeck-exponent",
         "run at four times the disc speed, or reach slips faster than 3/alpha: viscous friction keeps rising there"},
    Pair{"ageing", "rate-state",
         "slide, hold, slide with holds of 1, 10, 100 and 1000 s: only ageing raises break-away with the logarithm of "
         "the hold"},
    Pair{"load-dependence", "crosstalk",
         "load from 10 to 100 N and slide in both directions: crosstalk keeps its sign when the direction turns"},
};

}  // namespace

std::string telling_test(std::string_view key_a, std::string_view key_b) {
  for (const Pair& pair : kPairs) {
    if ((pair.a == key_a && pair.b == key_b) || (pair.a == key_b && pair.b == key_a)) return std::string(pair.test);
  }
  return "";
}

std::vector<LookAlike> look_alikes(std::string_view key) {
  std::vector<LookAlike> found;
  for (const Pair& pair : kPairs) {
    if (pair.a == key) found.push_back({std::string(pair.b), std::string(pair.test)});
    if (pair.b == key) found.push_back({std::string(pair.a), std::string(pair.test)});
  }
  return found;
}

}  // namespace tribofit
