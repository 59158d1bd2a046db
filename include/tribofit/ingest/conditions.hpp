#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "tribofit/ingest/units.hpp"

namespace tribofit {

/// A condition of a test and who said it.
struct Condition {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< SI; NaN when not known
  std::string source;  ///< "command line", "manifest", "file", "plateau"; empty when not known

  bool known() const { return value == value; }
};

/// Test conditions of a trace or of one step of it.
struct Conditions {
  Condition radius;  ///< friction radius [m], > 0
  Condition speed;   ///< disc speed [rad/s], positive as the disc's forward direction
  Condition load;    ///< nominal normal force [N], > 0
};

/// A condition as people read and write it.
struct ConditionInfo {
  Condition Conditions::*member;
  std::string_view name, meaning, unit;
  double si;  ///< value of one unit
  Quantity quantity;
  const char* column;      ///< name with its unit, in CSV and JSON
  std::string_view names;  ///< that files give it beside those of the channel of that name, as ChannelInfo::names
  double most;             ///< [SI] beyond which a file states something else
};
inline constexpr std::array<ConditionInfo, 3> condition_infos = {
    {{&Conditions::radius, "radius", "friction radius", "mm", kMillimetre, Quantity::length, "radius_mm",
      "radius r frictionradius reibradius trackradius weartrackradius disctrackradiususedforthisstep", 10},
     {&Conditions::speed, "speed", "speed", "rpm", kRpm, Quantity::angular_velocity, "speed_rpm", "", 1e6},
     {&Conditions::load, "load", "load", "N", 1, Quantity::force, "load_N",
      "setforce setload appliedload appliedforce testload", 1e12}}};

/// A stretch of a record in which the load point, the far end of a machine that is no stiffer than k, moves at one
/// speed.
struct LoadPointPhase {
  double begin = 0;      ///< [s] from the trace's first sample
  double speed = 0;      ///< [m/s], at least 0; 0: a hold
  bool on_ramp = false;  ///< one of the stairs by which a speed that changes steadily was read
};

/// Where the motion of a load point comes from, and so how well the times of its steps are known.
enum class LoadPointSource {
  stated,       ///< as a person noted them: to a second or so
  speed,        ///< recorded speed: to a sample
  displacement  ///< recorded displacement: closer than a sample
};

/// What a mass on a spring rubs on.
enum class Counterface {
  ground,  ///< that stands still
  base,    ///< the other end of the spring
};

/// The spring of a spring-slider or motion-only record, with what hangs on it.
struct SpringDrive {
  Condition velocity;                      ///< of the driven end of the spring [m/s]
  Condition stiffness;                     ///< of the spring [N/m], > 0
  Condition mass;                          ///< that it pulls [kg]; 0 where it is not known
  Condition damping;                       ///< beside the spring [N s/m]
  std::optional<Counterface> counterface;  ///< of a motion-only record; nothing: the motion shows it
};

}  // namespace tribofit
