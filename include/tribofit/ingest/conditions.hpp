#pragma once

#include <limits>
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

/// What draws the slider of a spring-slider record.
struct SpringDrive {
  Condition velocity;   ///< of the driven end of the spring [m/s]
  Condition stiffness;  ///< of the spring [N/m], > 0
  Condition mass;       ///< that it pulls [kg]; 0 where it is not known
};

}  // namespace tribofit
