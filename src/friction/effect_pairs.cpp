#include "tribofit/friction/effect_pairs.hpp"

#include <array>

namespace tribofit {

namespace {

struct Pair {
  std::string_view a, b, test;
};

// Where records can tell, what to record comes first, with speeds, loads and times; all records are then given to the
// diagnosis together. What a hand measures goes into the instruments file, and is corrected from then on.
constexpr std::string_view kTapForDelay =
    "tap the resting block and compare the edges: the shift between them is the delay, for vibrometer.delay of the "
    "instruments file (negative where friction comes late); without sliding there is neither lag nor memory";
constexpr std::string_view kTapForFilter =
    "tap the resting block: without sliding only a filter makes the edge slower; where the edge is sharp, give what it "
    "allows as force_sensor.bandwidth of the instruments file; where it is not, record with a spring four times as "
    "stiff too: slips take half as long, and a lag, a memory and a filter then part";
constexpr std::string_view kJumps =
    "record with a spring four times as stiff too; or plot at re-stick the jump of mu against the jump of the block's "
    "acceleration: a straight line is a mass; or add 100 g below the sensor";
constexpr std::string_view kStopTheDisc =
    "record at half the disc speed too: a plateau that sags for twice as long is the high-pass, a constant gap to "
    "omega r is the radius, a gap in proportion to d mu/dt is the bristle; or stop the disc: only behind a high-pass "
    "the plateau decays";
constexpr std::string_view kTwoRadii =
    "compare 9 mm at 8 rpm with 18 mm at 4 rpm: the sliding speed is the same, the spin is half";
constexpr std::string_view kFreshSurfaces =
    "record 30 s at four times the disc speed on fresh, cool surfaces too: heating keeps its time, run-in its "
    "distance; "
    "or pause ten minutes and restart: heating comes back, run-in does not";
constexpr std::string_view kSlowAndLong =
    "record ten times as long at a quarter of the disc speed on fresh, cool surfaces too: a drift goes on at the same "
    "rate, heating levels off and run-in takes the same distance; or pause ten minutes and restart: heating comes back";

constexpr std::array kPairs = {
    Pair{"asymmetry", "sensor-offset",
         "lift the block off the disc and read the force sensor: what it shows without contact is its zero, for "
         "force_sensor.zero of the instruments file"},
    Pair{"frictional-lag", "channel-delay", kTapForDelay},
    Pair{"frictional-lag", "force-bandwidth", kTapForFilter},
    Pair{"channel-delay", "force-bandwidth",
         "tap the block: an edge that is shifted is a delay, for vibrometer.delay of the instruments file (negative "
         "where friction comes late), one that is slower is a filter"},
    Pair{"frictional-lag", "sensor-inertia", kJumps},
    Pair{"channel-delay", "sensor-inertia", kTapForDelay},
    Pair{"force-bandwidth", "sensor-inertia", kJumps},
    Pair{"rate-state", "sensor-inertia", kJumps},
    Pair{"frictional-lag", "rate-state",
         "run at 1, 2, 4 and 8 rpm: the loop of mu over v_r stays constant in ms for a lag, in um for a memory of "
         "distance"},
    Pair{"rate-state", "channel-delay", kTapForDelay},
    Pair{"rate-state", "force-bandwidth", kTapForFilter},
    Pair{
        "rate-state", "bristle",
        "record at half the disc speed too and look at the stick: with a bristle v_r is not zero there; or reverse the "
        "disc 5 to 50 um below break-away: an elastic return is a bristle"},
    Pair{"bristle", "velocity-highpass", kStopTheDisc},
    Pair{"bristle", "radius-offset", kStopTheDisc},
    Pair{"velocity-highpass", "radius-offset", kStopTheDisc},
    Pair{"bristle", "contact-spin", kTwoRadii},
    Pair{"radius-offset", "velocity-gain",
         "point the laser at what moves at a known speed (the rim of the disc, with an encoder on it): reading over "
         "speed is the gain, for vibrometer.gain of the instruments file; what is left is the radius"},
    Pair{"speed-ripple", "runout",
         "record four revolutions: a ripple moves the plateau of v_b, a runout friction; or point the laser at the "
         "unloaded disc: a ripple of the speed shows there"},
    Pair{"heating", "run-in", kFreshSurfaces},
    Pair{"heating", "drift", kSlowAndLong},
    Pair{"run-in", "drift", kSlowAndLong},
    Pair{"runout", "drift", "record four revolutions (60 s at 4 rpm): a runout comes back, a drift goes on"},
    Pair{"viscous", "stribeck-exponent",
         "run at four times the disc speed, or reach slips faster than 3/alpha: viscous friction keeps rising there"},
    Pair{"ageing", "rate-state",
         "slide, hold, slide with a dozen holds from 0.3 to 6 s, or of 1, 10, 100 and 1000 s: only ageing raises "
         "break-away with the logarithm of the hold"},
    Pair{"load-dependence", "crosstalk",
         "load from 10 to 90 N and slide in both directions: crosstalk keeps its sign when the direction turns"},
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
