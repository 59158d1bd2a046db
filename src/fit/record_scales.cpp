#include "observing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

void set_extent(const Motion& motion, Observations& out) {
  const bool sticks = std::any_of(out.slips.begin(), out.slips.end(), [](const auto& slip) { return slip.from_stick; });
  out.slowest = sticks || out.size() == 0 ? 0 : std::abs(out.velocity[0]);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out.slowest = std::min(out.slowest, std::abs(out.velocity[i]));
    out.fastest = std::max(out.fastest, std::abs(out.velocity[i]));
    out.largest_friction = std::max(out.largest_friction, std::abs(out.friction[i]));
  }
  if (out.size() == 0) return;
  if (motion.friction_kind != FrictionKind::force) {
    out.friction_scale = std::max(1.0, out.largest_friction);
    return;
  }
  out.friction_scale = out.largest_friction;
  if (!motion.is_points()) {
    // Not the largest, which may be the inertia of a mass below the sensor, or one bad sample.
    std::vector<double> sizes(out.friction.size());
    std::transform(out.friction.begin(), out.friction.end(), sizes.begin(), [](double f) { return std::abs(f); });
    out.friction_scale = std::max(2 * median(sizes), kLeastScaleOfForce * out.largest_friction);
  }
  if (!(out.friction_scale > 0)) out.friction_scale = 1;
}

RecordScales scales_of(std::span<const Observations> records) {
  std::vector<double> times, lengths, sticks, accelerations;
  double duration = 0, distance = 0, stroke = 0, top_speed = 0, force = 0;
  const bool any_stick = std::any_of(records.begin(), records.end(), [](const Observations& record) {
    return std::any_of(record.slips.begin(), record.slips.end(), [](const auto& slip) { return slip.from_stick; });
  });
  for (const Observations& record : records) {
    double slid = 0;
    for (const auto& slip : record.slips) {
      if (slip.end - slip.begin < 2) continue;
      const double time = record.time[slip.end - 1] - record.time[slip.begin];
      double speed = 0, weight = 0;
      for (std::size_t i = slip.begin; i < slip.end; ++i) {
        speed += record.weight[i] * std::abs(record.velocity[i]);
        weight += record.weight[i];
      }
      slid += time * speed / weight;
      if (any_stick && !slip.from_stick) continue;
      times.push_back(time);
      lengths.push_back(time * speed / weight);
      if (std::isfinite(slip.stick_time) && slip.stick_time > 0) sticks.push_back(slip.stick_time);
    }
    for (const double a : record.acceleration) accelerations.push_back(std::abs(a));
    if (record.size() > 0) duration = std::max(duration, record.time.back() - record.time.front());
    distance = std::max(distance, slid);
    stroke = std::max(stroke, record.stroke);
    top_speed = std::max(top_speed, record.fastest);
    force = std::max(force, record.largest_friction * record.mean_load);
  }
  RecordScales out;
  const auto take = [](double& scale, double value) {
    if (value > 0 && std::isfinite(value)) scale = value;
  };
  constexpr double kSlipOfPiece = 1.0 / 6;
  const double part = any_stick ? 1 : kSlipOfPiece;
  if (!times.empty()) {
    take(out.slip_time, part * median(std::move(times)));
    take(out.slip_length, part * median(std::move(lengths)));
    take(out.stick_time, sticks.empty() ? out.slip_time : median(std::move(sticks)));
  }
  take(out.duration, duration);
  take(out.distance, distance);
  take(out.stroke, stroke);
  take(out.top_speed, top_speed);
  if (!accelerations.empty()) take(out.mass, force / quantile(std::move(accelerations), 0.95));
  return out;
}

}  // namespace tribofit
