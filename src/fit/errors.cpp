#include "errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assessment.hpp"
#include "limits.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/segmentation/strokes.hpp"

namespace tribofit {

FullRecord::FullRecord(std::span<const Record> records, const Observations& observations, const Channels& needs)
    : records_(records), observations_(observations), needs_(needs), channels_(records.size()) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (needs.angle) channels_[r].angle = disc_angle(*records[r].motion);
    if (needs.distance) channels_[r].distance = sliding_distance(*records[r].motion);
    if (needs.reversal_distance)
      channels_[r].reversal_distance = strokes_of(*records[r].motion, *records[r].segmentation).distance;
  }
}

std::span<const double> FullRecord::friction(const Observations::SlipObservation& range) const {
  return std::span(records_[range.record].motion->friction).subspan(range.samples.begin, range.samples.size());
}

bool FullRecord::is_spoilt(const Observations::SlipObservation& range, std::size_t i) const {
  return records_[range.record].motion->has_fault(range.samples.begin + i, SampleFault::any);
}

double FullRecord::weight(const Observations::SlipObservation& range, std::size_t i) const {
  return records_[range.record].motion->is_points() ? observations_.weight[range.begin + i] : 1;
}

Slip FullRecord::slip(const Observations::SlipObservation& range) const {
  const auto part = [&](const std::vector<double>& channel) {
    return part_of(channel, range.samples.begin, range.samples.end);
  };
  const Motion& motion = *records_[range.record].motion;
  const Channel& channel = channels_[range.record];
  Slip slip = observations_.slip(range);
  slip.time = part(motion.time);
  slip.velocity = part(motion.relative_velocity);
  slip.velocity_variance = {};
  slip.acceleration = {};
  if (needs_.acceleration) {
    acceleration_ = slip_acceleration(motion, range.samples);
    slip.acceleration = acceleration_;
  }
  // What the observations lack the model was fitted without, though this record may have it.
  const auto as_fitted = [&](const std::vector<double>& fitted, const std::vector<double>& recorded) {
    return fitted.empty() ? std::span<const double>() : part(recorded);
  };
  slip.angle = as_fitted(observations_.angle, channel.angle);
  slip.distance = as_fitted(observations_.distance, channel.distance);
  slip.reversal_distance = as_fitted(observations_.reversal_distance, channel.reversal_distance);
  slip.load = as_fitted(observations_.load, motion.load);
  if (motion.load.empty() && !observations_.load.empty()) {
    load_.assign(range.samples.size(), observations_.load[range.begin]);
    slip.load = load_;
  }
  slip.temperature = as_fitted(observations_.temperature, motion.temperature);
  return slip;
}

std::size_t noise_stretch(std::size_t samples) {
  return std::clamp(samples / 4, kShortestNoiseStretch, kLongestNoiseStretch);
}

SampleErrors sample_errors(const FrictionModel& model, const std::vector<double>& p, const FullRecord& record,
                           const Observations& observations) {
  SampleErrors out;
  out.squares.assign(observations.cycles, 0.0);
  out.counts.assign(observations.cycles, 0.0);
  double relative = 0, relative_count = 0, sum = 0, sum_squares = 0, samples = 0;
  std::vector<double> mu;
  for (const auto& range : observations.slips) {
    const Slip slip = record.slip(range);
    mu.resize(slip.size());
    evaluate<double>(model, p.data(), slip, slip.velocity, mu);
    const std::span<const double> measured = record.friction(range);
    double squares = 0, good = 0;
    for (std::size_t i = 0; i < mu.size(); ++i) {
      if (record.is_spoilt(range, i)) continue;
      good += 1;
      const double r = measured[i] - mu[i];
      const double weight = record.weight(range, i);
      squares += weight * r * r;
      const double level = measured[i] * range.direction;
      sum += weight * level;
      sum_squares += weight * level * level;
      if (const double e = relative_error(measured[i], mu[i]); std::isfinite(e)) {
        relative += e;
        relative_count += 1;
        out.figures.max_relative = std::max(out.figures.max_relative, e);
      }
    }
    samples += good;
    double count = good;
    if (range.from_stick) {
      const double r = range.break_away_friction - break_away_level(model, p.data(), slip);
      const double weight = range.break_away_root_weight * range.break_away_root_weight;
      squares += weight * r * r;
      count += weight;
    }
    out.squares[range.cycle] += squares;
    out.counts[range.cycle] += count;
  }
  double total = 0, count = 0;
  for (std::size_t c = 0; c < out.squares.size(); ++c) {
    total += out.squares[c];
    count += out.counts[c];
  }
  if (count > 0) out.figures.rmse = std::sqrt(total / count);
  if (relative_count > 0) out.figures.mean_relative = relative / relative_count;
  if (samples > 0) out.constant_rmse = std::sqrt(std::max(0.0, sum_squares / samples - std::pow(sum / samples, 2)));
  return out;
}

}  // namespace tribofit
