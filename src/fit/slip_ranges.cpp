#include "observing.hpp"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "errors.hpp"
#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

std::size_t good_samples(const Motion& motion, const SampleRange& samples) {
  std::size_t good = 0;
  for (std::size_t i = samples.begin; i < samples.end; ++i) good += motion.has_fault(i, SampleFault::any) ? 0U : 1U;
  return good;
}

/// Mean friction over the beginning of the stick after a slip; NaN where no stick follows.
double friction_after(const Motion& motion, const Segmentation& segmentation, std::size_t segment) {
  const Cycle& cycle = segmentation.cycles[segment];
  if (!cycle.slip_complete) return std::numeric_limits<double>::quiet_NaN();
  // The stick after the last slip belongs to no cycle: it has no slip.
  const bool last = segment + 1 >= segmentation.cycles.size();
  const SampleRange stick = last ? SampleRange{cycle.slip.end, motion.size()} : segmentation.cycles[segment + 1].stick;
  const std::size_t begin =
      stick.begin + static_cast<std::size_t>(kAfterRestick * static_cast<double>(cycle.slip.size()));
  const std::size_t end = std::min(
      stick.end, begin + std::max<std::size_t>(
                             2, static_cast<std::size_t>(kMeanAfterRestick * static_cast<double>(cycle.slip.size()))));
  if (stick.begin < cycle.slip.end || begin + 2 > end) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += motion.friction[i];
  return sum / static_cast<double>(end - begin);
}

/// A stick that began before the record is taken to be as long as the others were. is_selected: which slips are known.
void fill_stick_times(std::vector<Observations::SlipObservation>& slips, const std::vector<bool>& is_selected) {
  std::vector<double> known;
  for (std::size_t k = 0; k < slips.size(); ++k) {
    if (is_selected[k] && std::isfinite(slips[k].stick_time)) known.push_back(slips[k].stick_time);
  }
  if (known.empty()) return;
  const double usual = median(std::move(known));
  for (auto& slip : slips) {
    if (slip.from_stick && !std::isfinite(slip.stick_time)) slip.stick_time = usual;
  }
}

/// Leaves out the last samples of a slip that coloured noise kept above the threshold of stick: there friction is the
/// spring's, far from the law's. A slip ends so steeply that hardly one sample of it is as slow as that.
void trim_rest(const Motion& motion, SampleRange& samples) {
  const std::size_t least = samples.begin + samples.size() / 2;
  while (samples.end > least &&
         std::abs(motion.relative_velocity[samples.end - 1]) < kSlowEnd * motion.velocity_noise) {
    --samples.end;
  }
}

/// End of the samples of a complete slip at which friction is the law's: a velocity that is late shows a slip after
/// friction has jumped. One that was made of another channel has a window and no delay.
std::size_t law_end(const Motion& motion, const SampleRange& samples) {
  const double early = std::ceil(-motion.restick_delay / motion.step - 0.5);  // sampling makes half of one
  if (!(early > 0) || !motion.velocity_std_error.empty()) return samples.end;
  return samples.end - std::min(samples.size() / 2, static_cast<std::size_t>(early));
}

/// Takes out of each stick time what the levels of its own re-stick and break-away made of it. A break-away that is
/// high by chance is reached later: left in, its scatter would pass for ageing. What stays is how long the disc took.
void free_stick_times_of_their_own_level(std::vector<Observations::SlipObservation>& slips,
                                         const std::vector<bool>& is_selected) {
  std::vector<double> pulled(slips.size(), std::numeric_limits<double>::quiet_NaN());
  double sum = 0, count = 0;
  for (std::size_t k = 1; k < slips.size(); ++k) {
    if (!slips[k].from_stick || !is_selected[k] || !is_selected[k - 1]) continue;
    pulled[k] = slips[k].break_away_friction - slips[k].direction * slips[k - 1].tail_friction;
    if (!std::isfinite(pulled[k])) continue;
    sum += pulled[k];
    count += 1;
  }
  for (std::size_t k = 1; k < slips.size(); ++k) {
    const double late = (pulled[k] - sum / count) / std::abs(slips[k].stick_slope);
    if (!std::isfinite(late)) continue;
    slips[k].stick_time = std::max(kLeastStickTime * slips[k].stick_time, slips[k].stick_time - late);
  }
}

/// The spring pulls in a stick of which too little was recorded to see how fast as it did in the others: a reading that
/// is late looks back along that line.
void fill_stick_slopes(std::vector<Observations::SlipObservation>& slips) {
  std::vector<double> known;
  for (const auto& slip : slips) {
    if (slip.from_stick && std::isfinite(slip.stick_slope)) known.push_back(slip.direction * slip.stick_slope);
  }
  const double usual = known.empty() ? 0 : median(std::move(known));
  for (auto& slip : slips) {
    if (slip.from_stick && !std::isfinite(slip.stick_slope)) slip.stick_slope = slip.direction * usual;
  }
}

/// Drops the slips that are not selected; those that are left are the units of evidence.
void keep(const std::vector<bool>& is_selected, std::vector<Observations::SlipObservation>& slips) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < slips.size(); ++k) {
    if (!is_selected[k]) continue;
    slips[kept] = slips[k];
    slips[kept].cycle = kept;
    ++kept;
  }
  slips.resize(kept);
}

/// One part of a slip, or all of it, with what is known of the stick before it where it begins there. noise: of
/// friction.
Observations::SlipObservation slip_range(const Motion& motion, const Segmentation& segmentation, const Cycle& cycle,
                                         const SampleRange& samples, bool from_stick, const SensorNoise& noise) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Observations::SlipObservation range;
  range.samples = samples;
  range.law_end = samples.end;
  range.segment = static_cast<std::size_t>(&cycle - segmentation.cycles.data());
  range.direction = cycle.direction;
  const double speed = motion.conditions.speed.known() ? motion.conditions.speed.value : 0;
  range.disc_speed = motion.disc_speed.empty() ? speed : motion.disc_speed[samples.begin];
  range.from_stick = from_stick;
  range.break_away_time = motion.time[samples.begin];
  range.break_away_friction = range.stick_time = kNaN;
  range.tail_friction = friction_after(motion, segmentation, range.segment);
  range.restick_time = cycle.restick_time;
  range.friction_low_pass = motion.friction_low_pass.value;
  if (!from_stick) return range;
  range.break_away_time = std::min(cycle.break_away_time, range.break_away_time);
  range.stick_time = cycle.stick_time;
  range.stick_slope = cycle.stick_slope;
  range.break_away_friction = cycle.break_away_friction;
  // An onset that shows is known to a sample, though the rate of the growth may not be.
  const double time = cycle.break_away_time_std_error;
  const double late =
      std::abs(cycle.stick_slope) * (cycle.is_sharp ? time : std::min(time, motion.step / std::sqrt(12)));
  if ((cycle.is_sharp || noise.between > noise.rmse) && late > noise.any())
    range.break_away_root_weight = std::max(kLeastWeight, noise.any() / late);
  return range;
}

/// Every point is evidence of its own. They come in an order that goes with nothing, so that a block of them is one at
/// random, and neighbours have no more in common than others.
std::vector<Observations::SlipObservation> each_point(const Motion& motion, const Segmentation& segmentation) {
  std::vector<Observations::SlipObservation> points;
  for (const Cycle& cycle : segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i)
      points.push_back(slip_range(motion, segmentation, cycle, {i, i + 1}, false, {}));
  }
  boost::random::mt19937_64 engine(1);
  for (std::size_t k = points.size(); k > 1; --k) std::swap(points[k - 1], points[engine() % k]);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].cycle = k;
  return points;
}

}  // namespace

std::vector<Observations::SlipObservation> slip_ranges(const Motion& motion, const Segmentation& segmentation,
                                                       const SensorNoise& noise) {
  if (motion.is_points()) return each_point(motion, segmentation);
  std::vector<Observations::SlipObservation> ranges;
  std::vector<bool> is_selected;
  std::size_t slipping = 0;
  for (const Cycle& cycle : segmentation.cycles) slipping += cycle.slip.size();
  const bool pieces = segmentation.kind == MotionKind::always_slipping;
  const std::size_t piece = std::max<std::size_t>(kShortestSlip, slipping / kPiecesWithoutStick + 1);
  for (const Cycle& cycle : segmentation.cycles) {
    const SampleRange& slip = cycle.slip;
    if (slip.size() < kShortestSlip) continue;
    const bool from_stick = cycle.stick.size() > 0 && std::isfinite(cycle.break_away_friction);
    const std::size_t parts = pieces ? (slip.size() + piece - 1) / piece : 1;
    for (std::size_t k = 0; k < parts; ++k) {
      SampleRange samples{slip.begin + k * slip.size() / parts, slip.begin + (k + 1) * slip.size() / parts};
      if (!pieces && cycle.slip_complete) trim_rest(motion, samples);
      if (samples.size() == 0) continue;
      ranges.push_back(slip_range(motion, segmentation, cycle, samples, from_stick && k == 0, noise));
      if (!pieces && cycle.slip_complete) ranges.back().law_end = law_end(motion, samples);
      const bool selected = pieces ? segmentation.is_selected(samples) : segmentation.is_selected(cycle);
      is_selected.push_back(selected && good_samples(motion, samples) >= kShortestSlip);
    }
  }
  fill_stick_times(ranges, is_selected);
  free_stick_times_of_their_own_level(ranges, is_selected);
  fill_stick_slopes(ranges);
  keep(is_selected, ranges);
  return ranges;
}

}  // namespace tribofit
