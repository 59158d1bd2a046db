#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tribofit {

/// What the error that a model leaves may vary with.
enum class ResidualVariable { velocity, branch, time, angle, stick_time, load, frequency, stick, reversal_distance };

struct ResidualVariableInfo {
  std::string_view name;        ///< in JSON
  std::string_view phrase;      ///< for people: the error varies with it
  std::string_view experiment;  ///< what to measure where no effect explains such an error
};

inline const ResidualVariableInfo& describe(ResidualVariable variable) {
  static constexpr std::string_view kOfLoop =
      "Run at 1, 2, 4 and 8 rpm: a loop that is constant in ms is a lag or a delay, one constant in um a memory.";
  static constexpr std::array<ResidualVariableInfo, 9> infos = {
      {{"velocity", "the sliding speed", "Repeat at another disc speed: what belongs to v_r stays at the same v_r."},
       {"branch", "the branch, speeding up or slowing down", kOfLoop},
       {"time", "time", "Repeat the run: what belongs to the clock or to the surface comes back at another time."},
       {"angle", "the disc angle", "Turn the disc by a quarter on its hub: a pattern of the disc turns with it."},
       {"stick-time", "the stick time before a slip", kOfLoop},
       {"load", "the normal load", "Step the load up and down: what belongs to it comes back at the same load."},
       {"frequency", "a narrow band of frequency",
        "Record with the disc at rest: a line that stays is picked up by the instruments."},
       {"stick", "creep in stick", kOfLoop},
       {"reversal-distance", "the distance since a reversal",
        "Repeat the same stroke at two speeds: what is constant in mm is a play or a hysteresis, in ms a memory."}}};
  return infos[static_cast<std::size_t>(variable)];
}
inline std::string_view to_string(ResidualVariable variable) {
  return describe(variable).name;
}

}  // namespace tribofit
