#include "net_displacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Break-away scatters, and the positions with it.
Estimate slope_of(std::span<const double> time, std::span<const double> position) {
  const StraightLine line = fit_line(time, position);
  double squares = 0;
  for (std::size_t k = 0; k < time.size(); ++k) squares += std::pow(position[k] - line.at(time[k]), 2);
  const auto free = static_cast<double>(time.size()) - 2;
  return {line.slope, line.squares > 0 ? std::sqrt(squares / free / line.squares) : 0, free};
}

/// Both halves of the record say the same: a standstill or a gap moves the block once.
bool is_steady(const BlockPositions& positions, double mean) {
  const std::span<const double> time(positions.time), position(positions.position);
  const std::size_t half = time.size() / 2;
  const Estimate first = slope_of(time.first(half), position.first(half)),
                 second = slope_of(time.subspan(half), position.subspan(half));
  const auto agrees = [&](const Estimate& part) {
    return std::abs(part.value - mean) < kHalvesAgree * std::abs(mean) + kZeroErrors * part.std_error &&
           part.value / mean > kHalfOfMean;
  };
  return agrees(first) && agrees(second);
}

/// Integral of the velocity from one sample to another, by trapezoids; in four sums, which do not wait for each other.
double way_between(std::span<const double> time, std::span<const double> velocity, std::size_t from, std::size_t to) {
  std::array<double, 4> sums{};
  for (std::size_t i = from; i < to; ++i)
    sums[i % 4] += 0.5 * (velocity[i + 1] + velocity[i]) * (time[i + 1] - time[i]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace

BlockPositions positions_in_plateaus(std::span<const double> time, std::span<const double> velocity,
                                     const PlateauSearch& search, int threads) {
  const std::vector<StickPlateau>& runs = search.plateaus.runs;
  BlockPositions out{std::vector<double>(runs.size()), std::vector<double>(runs.size())};
  const auto middle_of = [&](std::size_t k) {
    return std::min((runs[k].begin + runs[k].end) / 2 * search.blocks.length, velocity.size() - 1);
  };
  run_tasks(runs.size(), threads, [&](std::size_t k) {
    out.time[k] = time[middle_of(k)];
    out.position[k] = way_between(time, velocity, k == 0 ? 0 : middle_of(k - 1), middle_of(k));
  });
  std::partial_sum(out.position.begin(), out.position.end(), out.position.begin());
  return out;
}

Estimate mean_velocity(const BlockPositions& positions) {
  return positions.time.size() < kFewestForMedian ? Estimate{} : slope_of(positions.time, positions.position);
}

Estimate find_zero_drift(const Trace& trace, const PlateauSearch& search, const BlockPositions& positions,
                         double step) {
  if (search.plateaus.runs.size() < 2 * kFewestPeriods) return {};
  const std::span<const double> time(positions.time), position(positions.position);
  const std::size_t half = time.size() / 2;
  const Estimate first = slope_of(time.first(half), position.first(half)),
                 second = slope_of(time.subspan(half), position.subspan(half));
  const double apart = 0.5 * (time[time.size() - 1] + time[half] - time[half - 1] - time[0]);
  const Estimate drift{(second.value - first.value) / apart, std::hypot(first.std_error, second.std_error) / apart,
                       first.degrees_of_freedom + second.degrees_of_freedom};
  std::vector<double> level;
  for (const StickPlateau& run : search.plateaus.runs) level.push_back(run.level);
  const Estimate plateaus = slope_of(time, level);
  const double least =
      std::max({kSignificance * plateaus.std_error,
                std::max(kLeastZero * std::abs(search.plateaus.level), 0.5 * step) / trace.duration()});
  const bool agree =
      std::abs(plateaus.value - drift.value) <
      kZeroAgrees * std::abs(plateaus.value) + kZeroErrors * std::hypot(drift.std_error, plateaus.std_error);
  const bool moves = std::abs(drift.value) > kZeroErrors * drift.std_error;
  return agree && moves && std::abs(plateaus.value) > least ? plateaus : Estimate{};
}

BlockZero find_zero(const PlateauSearch& search, const Disc& disc, const BlockPositions& positions, double step) {
  BlockZero zero;
  if (search.plateaus.runs.size() < kFewestPeriods) return zero;
  zero.mean = slope_of(positions.time, positions.position);
  const bool varies = !disc.varying.empty();
  // Where the disc's speed varies plateaus are relative to it.
  const double mean = zero.mean.value, plateau = final_level(search.plateaus);
  const double scale = varies ? disc.largest : std::abs(plateau), gap = varies ? plateau : plateau - disc.constant;
  const double least = std::max({kSignificance * zero.mean.std_error, kLeastZero * scale, 0.5 * step});
  // What follows the disc as a whole is not held by a spring.
  if (std::abs(mean) < least || std::abs(mean) > kLargestZero * scale) return zero;
  const bool shifts =
      disc.known && std::abs(gap - mean) < kZeroAgrees * std::abs(mean) + kZeroErrors * zero.mean.std_error;
  if (shifts) zero.kind = BlockZero::Kind::zero;
  if (!shifts && !varies && is_steady(positions, mean)) zero.kind = BlockZero::Kind::uneven;
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
  std::vector<double> levels;
  for (const StickPlateau& run : plateaus.runs) levels.push_back(run.level);
  zero.mean.std_error =
      kSigmaPerMad * median_absolute_deviation(levels, median(levels)) / std::sqrt(static_cast<double>(levels.size()));
  return zero;
}

void add_zero(const BlockZero& zero, bool speed_was_stated, const UndoneResponse& response, HealthItem& item) {
  if (zero.kind == BlockZero::Kind::none) return;
  const bool is_zero = zero.kind == BlockZero::Kind::zero;
  item.status =
      is_zero || response.any() ? std::max(item.status, HealthItem::Status::warning) : HealthItem::Status::problem;
  item.message += fmt::format("; the block has no net displacement, but its mean velocity is {} mm/s: ",
                              general(1e3 * zero.mean.value, 3));
  const double part = response.response.part;
  item.message +=
      is_zero          ? "the velocity has a zero error; corrected"
      : response.any() ? fmt::format("the velocity channel is nonlinear: its gain is {} % {} {}; corrected",
                                     general(100 * std::abs(part), 3), part > 0 ? "less" : "more",
                                     response.response.form == StaticResponse::Form::one_sided ? "against the disc"
                                                                                               : "at the highest speed")
      : speed_was_stated
          ? "the velocity channel is nonlinear, or samples are missing; mu_k and the law's decay (alpha) are "
            "unreliable"
          : "the velocity has a zero error, or its channel is nonlinear (mu_k and the law's decay (alpha) are then "
            "unreliable); give "
            "--speed to decide";
}

}  // namespace tribofit::kinematics
