#include "errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assessment.hpp"
#include "limits.hpp"
#include "observing.hpp"
#include "tribofit/execution/parallel.hpp"
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
  return !is_evidence(*records_[range.record].motion, range, range.samples.begin + i);
}

double FullRecord::weight(const Observations::SlipObservation& range, std::size_t i) const {
  return records_[range.record].motion->is_points() ? observations_.weight[range.begin + i] : 1;
}

Slip FullRecord::slip(const Observations::SlipObservation& range, Made& made) const {
  const auto part = [&](const std::vector<double>& channel) {
    return part_of(channel, range.samples.begin, range.samples.end);
  };
  const Motion& motion = *records_[range.record].motion;
  const Channel& channel = channels_[range.record];
  Slip slip = observations_.slip(range);
  slip.time = part(motion.time);
  made.motion = slip_motion(motion, range.samples);
  slip.velocity = made.motion.velocity;
  slip.velocity_variance = {};
  slip.acceleration = {};
  if (needs_.acceleration) slip.acceleration = made.motion.acceleration;
  // What the observations lack the model was fitted without, though this record may have it.
  const auto as_fitted = [&](const std::vector<double>& fitted, const std::vector<double>& recorded) {
    return fitted.empty() ? std::span<const double>() : part(recorded);
  };
  slip.angle = as_fitted(observations_.angle, channel.angle);
  slip.distance = as_fitted(observations_.distance, channel.distance);
  slip.reversal_distance = as_fitted(observations_.reversal_distance, channel.reversal_distance);
  slip.load = as_fitted(observations_.load, motion.load);
  if (motion.load.empty() && !observations_.load.empty()) {
    made.load.assign(range.samples.size(), observations_.load[range.begin]);
    slip.load = made.load;
  }
  slip.temperature = as_fitted(observations_.temperature, motion.temperature);
  return slip;
}

std::size_t noise_stretch(std::size_t samples) {
  return std::clamp(samples / 4, kShortestNoiseStretch, kLongestNoiseStretch);
}

namespace {

/// What a model leaves on the samples of some slips; the sums of each slip apart, as several may be of one cycle.
struct ErrorsOfSlips {
  std::vector<double> squares, counts;
  double relative = 0, relative_count = 0, max_relative = 0, sum = 0, sum_squares = 0, samples = 0;
};

ErrorsOfSlips errors_of(std::span<const Observations::SlipObservation> slips, const FrictionModel& shared,
                        const std::vector<double>& p, const FullRecord& record) {
  ErrorsOfSlips out;
  const FrictionModel model(shared);  // its formulas must not be shared between threads
  std::vector<double> mu;
  FullRecord::Made made;
  for (const auto& range : slips) {
    const Slip slip = record.slip(range, made);
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
      out.sum += weight * level;
      out.sum_squares += weight * level * level;
      if (const double e = relative_error(measured[i], mu[i]); std::isfinite(e)) {
        out.relative += e;
        out.relative_count += 1;
        out.max_relative = std::max(out.max_relative, e);
      }
    }
    out.samples += good;
    double count = good;
    if (range.from_stick) {
      const double r = range.read_at_break_away(model.acts_in_stick()) - break_away_level(model, p.data(), slip);
      const double weight = range.break_away_root_weight * range.break_away_root_weight;
      squares += weight * r * r;
      count += weight;
    }
    out.squares.push_back(squares);
    out.counts.push_back(count);
  }
  return out;
}

}  // namespace

SampleErrors sample_errors(const FrictionModel& model, const std::vector<double>& p, const FullRecord& record,
                           const Observations& observations, int threads) {
  const std::span<const Observations::SlipObservation> slips(observations.slips);
  std::vector<ErrorsOfSlips> parts((slips.size() + kSlipsOfPart - 1) / kSlipsOfPart);
  run_tasks(parts.size(), threads, [&](std::size_t k) {
    const std::size_t first = k * kSlipsOfPart;
    parts[k] = errors_of(slips.subspan(first, std::min(kSlipsOfPart, slips.size() - first)), model, p, record);
  });
  SampleErrors out;
  out.squares.assign(observations.cycles, 0.0);
  out.counts.assign(observations.cycles, 0.0);
  double relative = 0, relative_count = 0, sum = 0, sum_squares = 0, samples = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const ErrorsOfSlips& part = parts[k];
    relative += part.relative, relative_count += part.relative_count;
    sum += part.sum, sum_squares += part.sum_squares, samples += part.samples;
    out.figures.max_relative = std::max(out.figures.max_relative, part.max_relative);
    for (std::size_t s = 0; s < part.squares.size(); ++s) {
      const std::size_t cycle = slips[k * kSlipsOfPart + s].cycle;
      out.squares[cycle] += part.squares[s];
      out.counts[cycle] += part.counts[s];
    }
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
