#include "tribofit/fit/observations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "errors.hpp"
#include "observing.hpp"
#include "points.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/segmentation/strokes.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Of a value without a good sample: nothing beside the others, and nothing divides by zero.
constexpr double kWeightOfSpoilt = 1e-12;

/// Median number of samples of the slips.
std::size_t median_size(const std::vector<Observations::SlipObservation>& slips) {
  std::vector<double> sizes;
  for (const auto& slip : slips) sizes.push_back(static_cast<double>(slip.samples.size()));
  return sizes.empty() ? 0 : static_cast<std::size_t>(std::round(median(std::move(sizes))));
}

/// Means of channels over each value of the observations.
class Reducer {
 public:
  Reducer(const Motion& motion, const std::vector<Observations::SlipObservation>& slips, std::size_t per_value)
      : motion_(motion), slips_(slips), per_value_(per_value) {}

  template <class Write>
  void each(Write&& write) const {
    for (const auto& slip : slips_) {
      for (std::size_t i = slip.samples.begin; i < slip.samples.end; i += per_value_) {
        write(slip, i, std::min(i + per_value_, slip.samples.end));
      }
    }
  }

  /// Appends the means of a slip, of which each sample has a value.
  void append(const Observations::SlipObservation& slip, std::span<const double> values,
              std::vector<double>& out) const {
    if (per_value_ == 1) {
      out.insert(out.end(), values.begin(), values.end());
      return;
    }
    for (std::size_t begin = 0; begin < values.size(); begin += per_value_) {
      const std::size_t end = std::min(begin + per_value_, values.size());
      double sum = 0, good = 0, count = 0;
      for (std::size_t i = begin; i < end; ++i) {
        sum += values[i];
        if (!is_evidence(motion_, slip, slip.samples.begin + i)) continue;
        good += values[i];
        ++count;
      }
      out.push_back(count > 0 ? good / count : sum / static_cast<double>(end - begin));
    }
  }

  std::vector<double> means(const std::vector<double>& channel) const {
    std::vector<double> out;
    if (channel.empty()) return out;
    std::size_t samples = 0;
    for (const auto& slip : slips_) samples += slip.samples.size();
    out.reserve(samples / per_value_ + slips_.size());
    for (const auto& slip : slips_) append(slip, part_of(channel, slip.samples.begin, slip.samples.end), out);
    return out;
  }

 private:
  const Motion& motion_;
  const std::vector<Observations::SlipObservation>& slips_;
  std::size_t per_value_;
};

/// Mean of x over the samples of a window about i.
double mean_about(const std::vector<double>& x, std::size_t i, std::size_t half) {
  const std::size_t begin = i - std::min(i, half), end = std::min(x.size(), i + half + 1);
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += x[k];
  return sum / static_cast<double>(end - begin);
}

/// A slip that does not begin in stick goes on from the one before it (a reversal, the next piece of a record that
/// never sticks): its memory starts in steady state that many values earlier. It does not see what was measured.
void go_on_from(const Observations::SlipObservation& before, Observations::SlipObservation& slip, Observations& out) {
  constexpr std::size_t kValues = 20;  // a memory of the slip's own time has decayed over them
  slip.lead_begin = out.lead_time.size();
  for (std::size_t i = before.end - std::min(kValues, before.end - before.begin); i < before.end; ++i) {
    out.lead_time.push_back(out.time[i]);
    out.lead_velocity.push_back(out.velocity[i]);
  }
  slip.lead_end = out.lead_time.size();
}

/// Keeps the velocity of each stick from where creep stands out of the noise, a third of a slip time before break-away
/// at most, and friction there, from which a memory that acts in stick starts. Creep is smooth, noise is not: fed to a
/// memory that turns with the sign of v_r it would pass for motion, so the velocity is averaged.
void add_leads(const Motion& motion, const Segmentation& segmentation, Observations& out) {
  const double lead = 0.3 * out.scales.slip_time, mean = 0.03 * out.scales.slip_time;
  const std::size_t half = std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * mean / motion.step));
  const std::size_t every = half;
  // Three standard deviations of the mean, twice over for noise that is coloured.
  const double noise = 6 * motion.velocity_noise / std::sqrt(2.0 * static_cast<double>(half) + 1);
  for (auto slip = out.slips.begin(); slip != out.slips.end(); ++slip) {
    const Cycle& cycle = segmentation.cycles[slip->segment];
    slip->lead_friction = std::numeric_limits<double>::quiet_NaN();
    if (!slip->from_stick) {
      const bool first_of_record = slip == out.slips.begin();
      if (!first_of_record && std::prev(slip)->samples.end + 2 >= slip->samples.begin) {
        go_on_from(*std::prev(slip), *slip, out);
      }
      continue;
    }
    const auto longest = static_cast<std::size_t>(lead / motion.step);
    std::size_t first = slip->samples.begin;
    const std::size_t earliest = first - std::min(longest, cycle.stick.size() / 2);
    while (first > earliest && std::abs(mean_about(motion.relative_velocity, first - 1, half)) > noise) --first;
    slip->lead_friction = mean_about(motion.friction, first - std::min(first, half), half);
    slip->lead_begin = out.lead_time.size();
    first -= std::min(first, half);
    // Means of a millisecond hold nothing faster than a few points in each; the last point is just before the slip.
    for (std::size_t i = first + (slip->samples.begin - 1 - first) % every; i < slip->samples.begin; i += every) {
      out.lead_time.push_back(motion.time[i]);
      out.lead_velocity.push_back(mean_about(motion.relative_velocity, i, half));
    }
    slip->lead_end = out.lead_time.size();
    const std::size_t last = slip->samples.begin - 1;
    if (slip->lead_end > slip->lead_begin && !motion.has_fault(last, SampleFault::friction))
      slip->creep_friction = slip->direction * motion.friction[last];
  }
}

/// Which slip came to rest in the stick before each.
void add_earlier_slips(std::vector<Observations::SlipObservation>& slips) {
  for (std::size_t k = 1; k < slips.size(); ++k) {
    const Observations::SlipObservation& before = slips[k - 1];
    const bool next = slips[k].from_stick && slips[k].segment == before.segment + 1;
    if (!next || !std::isfinite(before.restick_time)) continue;
    slips[k].earlier_begin = before.begin;
    slips[k].earlier_end = before.end;
    slips[k].earlier_restick_time = before.restick_time;
  }
}

double mean_of(const std::vector<double>& x, double otherwise) {
  if (x.empty()) return otherwise;
  double sum = 0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

/// How the block moves, each slip smoothed as its noise demands, and the variance of v_r within each value.
void add_motion(const Motion& motion, bool needs_acceleration, const Reducer& reduce, Observations& out) {
  const std::size_t each = out.samples_per_value;
  const bool needs_variance = each > 1 || !motion.velocity_variance.empty();
  for (const auto& slip : out.slips) {
    const SlipMotion moves = slip_motion(motion, slip.samples);
    reduce.append(slip, moves.velocity, out.velocity);
    if (needs_acceleration) reduce.append(slip, moves.acceleration, out.acceleration);
    for (std::size_t i = 0, value = slip.begin; needs_variance && i < moves.velocity.size(); i += each, ++value) {
      const std::size_t end = std::min(i + each, moves.velocity.size());
      double squares = 0;
      for (std::size_t k = i; k < end; ++k) squares += std::pow(moves.velocity[k] - out.velocity[value], 2);
      for (std::size_t k = i; k < end && !motion.velocity_variance.empty(); ++k)
        squares += motion.velocity_variance[slip.samples.begin + k];
      out.velocity_variance.push_back(squares / static_cast<double>(end - i));
    }
  }
}

/// How far each value is from the last reversal, and what each slip remembers of the strokes before it.
void add_strokes(const Motion& motion, const Segmentation& segmentation, const Reducer& reduce, Observations& out) {
  const Strokes strokes = strokes_of(motion, segmentation);
  out.reversal_distance = reduce.means(strokes.distance);
  out.stroke = strokes.length;
  for (auto& slip : out.slips) {
    slip.strokes_begin = slip.strokes_end = out.earlier_strokes.size();
    if (!strokes.known()) continue;
    const std::vector<double>& earlier = strokes.earlier[slip.segment];
    out.earlier_strokes.insert(out.earlier_strokes.end(), earlier.begin(), earlier.end());
    slip.strokes_end = out.earlier_strokes.size();
  }
}

/// The channels that effects need, as far as the record has them.
void add_channels(const Motion& motion, const Segmentation& segmentation, const Channels& needs, const Reducer& reduce,
                  Observations& out) {
  if (needs.angle) out.angle = reduce.means(disc_angle(motion));
  if (needs.distance) out.distance = reduce.means(sliding_distance(motion));
  if (needs.reversal_distance) add_strokes(motion, segmentation, reduce, out);
  if (needs.load || needs.force) {
    // Records that differ in a constant load show together what none shows alone.
    if (motion.load.empty() && motion.conditions.load.known()) {
      out.load.assign(out.time.size(), motion.conditions.load.value);
    } else {
      out.load = reduce.means(motion.load);
    }
  }
  if (needs.temperature) out.temperature = reduce.means(motion.temperature);
  out.mean_load = mean_of(motion.load, motion.conditions.load.known() ? motion.conditions.load.value : 1);
  out.mean_temperature = mean_of(motion.temperature, 0);
}

}  // namespace

Slip Observations::slip(const SlipObservation& range) const {
  const auto part = [&](const std::vector<double>& channel) { return part_of(channel, range.begin, range.end); };
  Slip slip;
  static_cast<SlipFacts&>(slip) = range;
  slip.time = part(time);
  slip.velocity = part(velocity);
  slip.acceleration = part(acceleration);
  slip.angle = part(angle);
  slip.distance = part(distance);
  slip.reversal_distance = part(reversal_distance);
  slip.earlier_strokes = part_of(earlier_strokes, range.strokes_begin, range.strokes_end);
  slip.load = part(load);
  slip.temperature = part(temperature);
  slip.velocity_variance = part(velocity_variance);
  slip.lead_time = part_of(lead_time, range.lead_begin, range.lead_end);
  slip.lead_velocity = part_of(lead_velocity, range.lead_begin, range.lead_end);
  slip.earlier_time = part_of(time, range.earlier_begin, range.earlier_end);
  slip.earlier_velocity = part_of(velocity, range.earlier_begin, range.earlier_end);
  slip.mean_load = mean_load;
  slip.mean_temperature = mean_temperature;
  return slip;
}

void refer_to_conditions_of(const Fit& fit, Observations& observations) {
  observations.mean_load = fit.mean_load;
  observations.mean_temperature = fit.mean_temperature;
}

std::vector<std::size_t> blocks_of(const Observations& observations, std::size_t count) {
  std::vector<std::size_t> record(observations.cycles, 0), cycles, before;
  for (const auto& slip : observations.slips) record[slip.cycle] = slip.record;
  for (const std::size_t r : record) {
    if (r >= cycles.size()) cycles.resize(r + 1, 0);
    ++cycles[r];
  }
  before.resize(cycles.size(), 0);
  std::vector<std::size_t> blocks;
  for (const std::size_t r : record) blocks.push_back(before[r]++ * count / cycles[r]);
  return blocks;
}

Observations join(std::vector<Observations> records) {
  const RecordScales scales = scales_of(records);
  std::vector<RecordScales> of_records;
  for (const Observations& record : records) of_records.push_back(record.scales);
  Observations out = std::move(records.at(0));
  out.scales = scales;
  if (of_records.size() > 1) out.scales_of_records = std::move(of_records);
  double values = static_cast<double>(out.size());
  for (std::size_t r = 1; r < records.size(); ++r) {
    Observations& next = records[r];
    const double more = static_cast<double>(next.size());
    out.mean_load += (next.mean_load - out.mean_load) * more / (values + more);
    out.mean_temperature += (next.mean_temperature - out.mean_temperature) * more / (values + more);
    values += more;
    for (Observations::SlipObservation slip : next.slips) {
      slip.begin += out.time.size();
      slip.end += out.time.size();
      slip.earlier_begin += out.time.size();
      slip.earlier_end += out.time.size();
      slip.cycle += out.cycles;
      slip.lead_begin += out.lead_time.size();
      slip.lead_end += out.lead_time.size();
      slip.strokes_begin += out.earlier_strokes.size();
      slip.strokes_end += out.earlier_strokes.size();
      if (slip.stick != Observations::npos) slip.stick += out.sticks.size();
      slip.record = r;
      out.slips.push_back(slip);
    }
    out.cycles += next.cycles;
    out.sticks.insert(out.sticks.end(), next.sticks.begin(), next.sticks.end());
    out.noise.insert(out.noise.end(), next.noise.begin(), next.noise.end());
    out.stick_noise.insert(out.stick_noise.end(), next.stick_noise.begin(), next.stick_noise.end());
    // Channels missing on one side cannot be used by an effect of all.
    const auto append = [&](std::vector<double>& to, const std::vector<double>& from) {
      if (to.empty() || from.empty()) {
        to.clear();
      } else {
        to.insert(to.end(), from.begin(), from.end());
      }
    };
    for (auto* side : {&out, &next}) {
      if (side->velocity_variance.empty()) side->velocity_variance.assign(side->size(), 0.0);
    }
    for (const auto channel :
         {&Observations::acceleration, &Observations::angle, &Observations::distance, &Observations::reversal_distance,
          &Observations::load, &Observations::temperature, &Observations::velocity_variance}) {
      append(out.*channel, next.*channel);
    }
    for (const auto channel : {&Observations::time, &Observations::velocity, &Observations::friction,
                               &Observations::weight, &Observations::root_weight, &Observations::lead_time,
                               &Observations::lead_velocity, &Observations::earlier_strokes}) {
      (out.*channel).insert((out.*channel).end(), (next.*channel).begin(), (next.*channel).end());
    }
    out.fastest = std::max(out.fastest, next.fastest);
    out.slowest = std::min(out.slowest, next.slowest);
    out.largest_friction = std::max(out.largest_friction, next.largest_friction);
    out.friction_scale = std::max(out.friction_scale, next.friction_scale);
  }
  return out;
}

Observations observe_motion(const Motion& motion, const Segmentation& segmentation, const SensorNoise& noise,
                            const Channels& needs, std::size_t values_per_slip) {
  Observations out;
  out.slips = slip_ranges(motion, segmentation, noise);
  out.cycles = out.slips.size();
  if (values_per_slip > 0)
    out.samples_per_value = std::max<std::size_t>(1, (median_size(out.slips) + values_per_slip / 2) / values_per_slip);
  std::size_t values = 0;
  for (auto& slip : out.slips) {
    slip.begin = values;
    values += (slip.samples.size() + out.samples_per_value - 1) / out.samples_per_value;
    slip.end = values;
  }
  add_earlier_slips(out.slips);
  stop_point();
  const Reducer reduce(motion, out.slips, out.samples_per_value);
  out.time = reduce.means(motion.time);
  add_motion(motion, needs.acceleration, reduce, out);
  out.friction = reduce.means(motion.friction);
  out.weight.reserve(values);
  out.root_weight.reserve(values);
  reduce.each([&](const Observations::SlipObservation& slip, std::size_t begin, std::size_t end) {
    std::size_t good = 0;
    for (std::size_t i = begin; i < end; ++i) good += is_evidence(motion, slip, i) ? 1U : 0U;
    out.weight.push_back(good > 0 ? static_cast<double>(good) : kWeightOfSpoilt);
    out.root_weight.push_back(std::sqrt(out.weight.back()));
  });
  weigh_points(motion, out);
  stop_point();
  add_channels(motion, segmentation, needs, reduce, out);
  stop_point();
  set_extent(motion, out);
  out.scales = scales_of({&out, 1});
  if (needs.lead) add_leads(motion, segmentation, out);
  return out;
}

Observations observe(const Motion& motion, const Segmentation& segmentation, const Channels& needs,
                     std::size_t values_per_slip) {
  return observe(motion, segmentation, noise_of(motion, segmentation), needs, values_per_slip);
}

Observations observe(const Motion& motion, const Segmentation& segmentation, const RecordNoise& noise,
                     const Channels& needs, std::size_t values_per_slip) {
  Observations out = observe_motion(motion, segmentation, noise.sensor, needs, values_per_slip);
  add_noise(noise, out);
  return out;
}

}  // namespace tribofit
