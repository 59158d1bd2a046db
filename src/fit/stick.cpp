#include "stick.hpp"

#include <cmath>
#include <limits>

#include "tribofit/friction/evaluate.hpp"
#include "tribofit/segmentation/stick_motion.hpp"

namespace tribofit {

double stick_creep_rmse(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                        const Segmentation& segmentation) {
  double squares = 0, count = 0;
  for (const StickCreep& stick : stick_motion(motion, segmentation)) {
    for (const StickPart& part : stick.parts) {
      double predicted = 0;
      for_each_effect(model, p.data(), [&]<class E>(const E& effect, const double* q) {
        if constexpr (requires { effect.creep(q, p[0], part.friction, part.friction_rate); })
          predicted += effect.creep(q, p[0], part.friction, part.friction_rate);
      });
      if (part.friction >= p[0] || !std::isfinite(predicted)) continue;
      squares += std::pow(part.relative_velocity - predicted, 2);
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tribofit
