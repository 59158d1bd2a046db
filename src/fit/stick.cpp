#include "stick.hpp"

#include <cmath>
#include <limits>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

namespace {

double mean(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += x[i];
  return sum / static_cast<double>(end - begin);
}

}  // namespace

double stick_creep_rmse(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                        const Segmentation& segmentation) {
  constexpr std::size_t kParts = 10;
  double squares = 0, count = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t part = cycle.stick.size() / kParts;
    if (part < 5) continue;
    const double span = static_cast<double>(part) * motion.step;
    // The first tenth holds the transient of re-stick, the last the break-away itself.
    for (std::size_t k = 2; k + 2 < kParts; ++k) {
      const std::size_t begin = cycle.stick.begin + k * part;
      const double before = mean(motion.friction, begin - part, begin);
      const double level = cycle.direction * mean(motion.friction, begin, begin + part);
      const double after = mean(motion.friction, begin + part, begin + 2 * part);
      const double slope = cycle.direction * (after - before) / (2 * span);
      const double measured = cycle.direction * mean(motion.relative_velocity, begin, begin + part);
      double predicted = 0;
      for_each_effect(model, p.data(), [&]<class E>(const E& effect, const double* q) {
        if constexpr (requires { effect.creep(q, p[0], level, slope); })
          predicted += effect.creep(q, p[0], level, slope);
      });
      if (level >= p[0] || !std::isfinite(predicted)) continue;
      squares += std::pow(measured - predicted, 2);
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tribofit
