#pragma once

#include <limits>
#include <optional>
#include <string>

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
