#include "net_displacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Slope of the positions at the middles of the plateaus over time. Break-away scatters, and the positions with it.
Estimate mean_velocity(const Trace& trace, const PlateauSearch& search) {
  std::vector<double> time, position;
  double displacement = 0;
  std::size_t i = 1;
  for (const StickPlateau& run : search.plateaus.runs) {
    const std::size_t middle = std::min((run.begin + run.end) / 2 * search.blocks.length, trace.size() - 1);
    for (; i <= middle; ++i) {
      displacement += 0.5 * (trace.velocity[i] + trace.velocity[i - 1]) * (trace.time[i] - trace.time[i - 1]);
    }
    time.push_back(trace.time[middle]);
    position.push_back(displacement);
  }
  const StraightLine line = fit_line(time, position);
  double squares = 0;
  for (std::size_t k = 0; k < time.size(); ++k) squares += std::pow(position[k] - line.at(time[k]), 2);
  const auto free = static_cast<double>(time.size()) - 2;
  return {line.slope, line.squares > 0 ? std::sqrt(squares / free / line.squares) : 0, free};
}

}  // namespace

BlockZero find_zero(const Trace& trace, const PlateauSearch& search, const Disc& disc, double step) {
  BlockZero zero;
  if (search.plateaus.runs.size() < kFewestPeriods) return zero;
  zero.mean = mean_velocity(trace, search);
  const double mean = zero.mean.value, plateau = final_level(search.plateaus);
  const double least = std::max({kSignificance * zero.mean.std_error, kLeastZero * std::abs(plateau), 0.5 * step});
  // What follows the disc as a whole is not held by a spring.
  if (std::abs(mean) < least || std::abs(mean) > kLargestZero * std::abs(plateau)) return zero;
  const bool shifts = disc.known && std::abs(plateau - disc.constant - mean) < kZeroAgrees * std::abs(mean);
  zero.kind = shifts ? BlockZero::Kind::zero : BlockZero::Kind::uneven;
  return zero;
}

BlockZero find_zero_of_relative(const Trace& trace, const PlateauSearch& search, const Disc& disc) {
  BlockZero zero;
  if (!disc.known || disc.constant == 0) return zero;
  double displacement = 0, low = 0, high = 0;  // of the block, were the zero right
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double v = disc.constant - 0.5 * (trace.velocity[i] + trace.velocity[i - 1]);
    displacement += v * (trace.time[i] - trace.time[i - 1]);
    low = std::min(low, displacement);
    high = std::max(high, displacement);
  }
  const double mean = -displacement / trace.duration();
  // Beside its drift the block moves by a slip at most, which is what leaves the mean uncertain.
  const double unknown = std::max(0.0, high - low - std::abs(displacement)) / trace.duration();
  const double width = unknown + kZeroAgrees * std::abs(mean);
  if (std::abs(mean) < kLeastZero * std::abs(disc.constant) || std::abs(mean) > kLargestZero * std::abs(disc.constant))
    return zero;
  const Plateaus plateaus = find_plateaus(search.blocks.mean, LevelRange{mean - width, mean + width});
  if (plateaus.runs.size() < kFewestPeriods) return zero;
  zero.kind = BlockZero::Kind::zero;
  zero.mean.value = plateaus.level;
  return zero;
}

void add_zero(const BlockZero& zero, bool speed_was_stated, HealthItem& item) {
  if (zero.kind == BlockZero::Kind::none) return;
  const bool is_zero = zero.kind == BlockZero::Kind::zero;
  item.status = is_zero ? std::max(item.status, HealthItem::Status::warning) : HealthItem::Status::problem;
  item.message += fmt::format("; the block goes nowhere, yet its velocity is off by {:.3g} mm/s on average: ",
                              1e3 * zero.mean.value);
  item.message +=
      is_zero ? "its zero was off by as much, taken off"
      : speed_was_stated
          ? "slips are not read like sticks (a compressed velocity), or samples are missing; mu_k and alpha are at "
            "stake"
          : "its zero is off, or slips are not read like sticks (a compressed velocity; mu_k and alpha are "
            "then at stake); give --speed to decide";
}

}  // namespace tribofit::kinematics
