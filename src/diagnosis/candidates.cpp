#include "candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "fit/points.hpp"
#include "fit/spectral_lines.hpp"
#include "fit/starts.hpp"
#include "imitations.hpp"
#include "limits.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/segmentation/strokes.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::diagnosis {

namespace {

/// What the data can excite, found once.
struct Excitation {
  bool both_directions = false;
  std::size_t reversals = 0;       ///< of the record that has most
  double revolutions = 0;          ///< of the record that turns most
  double load_spread = 0;          ///< (95 % - 5 %) / median
  double temperature_spread = 0;   ///< 95 % - 5 % [K]
  double stick_time_ratio = 1;     ///< 95 % / 5 % over cycles
  double longest_stick_ratio = 1;  ///< third longest over the median
  double median_stick_time = 0;
  bool breaks_away = false;
  bool speed_changes = false;  ///< within a record, by more than its noise
  bool force_known = false;    ///< the load is known or friction is a force
};

/// v_r moves within the record by more than its noise. It is compared over values, which may be means of samples.
bool speed_changes(const Record& record, const Observations& observations, std::size_t index) {
  std::vector<double> speeds;
  for (const auto& slip : observations.slips) {
    if (slip.record != index) continue;
    for (std::size_t i = slip.begin; i < slip.end; ++i) speeds.push_back(std::abs(observations.velocity[i]));
  }
  if (speeds.empty()) return false;
  const double spread = quantile(speeds, 0.95) - quantile(speeds, 0.05);
  return spread > limits::kSpeedSigmas * record.motion->velocity_noise &&
         spread > limits::kLeastSpeedSpread * median(std::move(speeds));
}

Excitation excitation_of(std::span<const Record> records, const Observations& observations) {
  Excitation out;
  bool forth = false, back = false;
  std::vector<double> sticks;
  for (const auto& slip : observations.slips) {
    (slip.direction > 0 ? forth : back) = true;
    out.breaks_away |= slip.from_stick;
    if (std::isfinite(slip.stick_time) && slip.stick_time > 0) sticks.push_back(slip.stick_time);
  }
  out.both_directions = forth && back;
  for (const Record& record : records) out.reversals = std::max(out.reversals, reversals_of(*record.segmentation));
  out.speed_changes = out.breaks_away || out.both_directions;
  for (std::size_t r = 0; r < records.size() && !out.speed_changes; ++r) {
    out.speed_changes = speed_changes(records[r], observations, r);
  }
  if (sticks.size() >= limits::kFewestSticks) {
    out.median_stick_time = median(sticks);
    out.stick_time_ratio = quantile(sticks, 0.95) / quantile(sticks, 0.05);
    std::sort(sticks.rbegin(), sticks.rend());
    out.longest_stick_ratio = sticks[2] / out.median_stick_time;
  }
  if (!observations.angle.empty()) {
    std::vector<double> least(records.size(), 1e300), most(records.size(), -1e300);
    for (const auto& slip : observations.slips) {
      least[slip.record] = std::min(least[slip.record], observations.angle[slip.begin]);
      most[slip.record] = std::max(most[slip.record], observations.angle[slip.end - 1]);
    }
    for (std::size_t r = 0; r < records.size(); ++r) {
      out.revolutions = std::max(out.revolutions, (most[r] - least[r]) / (2 * std::numbers::pi));
    }
  }
  if (!observations.load.empty()) {
    out.load_spread = (quantile(observations.load, 0.95) - quantile(observations.load, 0.05)) /
                      std::max(1e-300, std::abs(median(observations.load)));
  }
  if (!observations.temperature.empty()) {
    out.temperature_spread = quantile(observations.temperature, 0.95) - quantile(observations.temperature, 0.05);
  }
  out.force_known = std::all_of(records.begin(), records.end(), [](const Record& record) {
    return record.motion->friction_kind == FrictionKind::force || !record.motion->load.empty() ||
           record.motion->conditions.load.known();
  });
  return out;
}

/// What velocity and friction of a spring slider cannot show, both made from one channel; empty for other records.
std::string obstacle_of_spring(const EffectInfo& info, std::span<const Record> records) {
  const bool spring = std::any_of(records.begin(), records.end(), [](const Record& record) {
    return record.motion->kind == RecordKind::spring_slider;
  });
  if (!spring) return {};
  if (info.declared_by == InstrumentValue::force_bandwidth)
    return "mass and spring of the slider filter friction in the same way, by their natural frequency";
  if (info.declared_by == InstrumentValue::vibrometer_delay)
    return "the velocity was made from the pull: nothing comes later than the other";
  return {};
}

std::string no_strokes(std::size_t reversals) {
  if (reversals < kFewestReversals) return too_few_reversals(reversals);
  return "sliding reverses by no more than the noise of v_r adds up to, or not in every record";
}

/// Why the data cannot show an effect; empty where they can.
std::string obstacle(const EffectInfo& info, std::span<const Record> records, const Observations& observations,
                     const Excitation& seen) {
  const Channels& needs = info.needs;
  if (needs.time && are_points(records)) return "points have no order in time: nothing shows what came before";
  if (std::string of_spring = obstacle_of_spring(info, records); !of_spring.empty()) return of_spring;
  if (needs.temperature && observations.temperature.empty()) return "there is no temperature channel";
  if (needs.load && observations.load.empty()) return "there is no load channel";
  if (needs.angle && observations.angle.empty()) return "the disc angle is not known (give --speed)";
  if (needs.force && !seen.force_known) return "the normal force is not known (give --load)";
  if (seen.revolutions < info.excitation.revolutions) return too_few_revolutions(seen.revolutions, info);
  if (needs.load && seen.load_spread < limits::kLeastLoadSpread) {
    return fmt::format("the load varies by {} % only", fixed(100 * seen.load_spread, 1));
  }
  if (needs.temperature && seen.temperature_spread < limits::kLeastTemperatureSpread) {
    return fmt::format("the temperature varies by {} K only", fixed(seen.temperature_spread, 1));
  }
  if (needs.stick_time && seen.stick_time_ratio < limits::kLeastStickRatio &&
      seen.longest_stick_ratio < limits::kLeastStickRatio) {
    return seen.median_stick_time > 0
               ? fmt::format("the stick times are all about {} s: longer and shorter sticks are not distinguishable",
                             general(seen.median_stick_time, 2))
               : std::string("too few stick times were recorded");
  }
  if (info.excitation.both_directions && !seen.both_directions) return "the block slides in one direction only";
  if (needs.reversal_distance && observations.reversal_distance.empty()) return no_strokes(seen.reversals);
  if (info.excitation.changing_speed && !seen.speed_changes) {
    return "v_r does not change within a record: nothing shows what follows it late";
  }
  const std::string& purpose = info.excitation.break_away;
  if (!purpose.empty() && !seen.breaks_away) return "there is no break-away " + purpose;
  return imitated_by(records, info.sketch.view);
}

/// Values over the bounds from which a search begins, in SI. parameter: see on_scale_of().
std::vector<double> grid_of(const Parameter& parameter, double lower, double upper) {
  if (parameter.start_grid_points < 2) {
    const double neutral = std::isnan(parameter.neutral) ? parameter.start : parameter.neutral;
    const bool inside = neutral > parameter.lower && neutral < parameter.upper;
    return {std::clamp((inside ? neutral : parameter.start) * parameter.si, lower, upper)};
  }
  std::vector<double> values;
  const auto n = static_cast<double>(parameter.start_grid_points);
  if (parameter.periodic) {
    for (int k = 0; k < parameter.start_grid_points; ++k)
      values.push_back(2 * std::numbers::pi * (k / n - 0.5 + 0.5 / n));
    return values;
  }
  if (parameter.neutral == 0 && lower == 0) {  // a size of which nothing is known: octaves about the usual one
    for (int k = 0; k < parameter.start_grid_points; ++k) {
      values.push_back(std::clamp(parameter.start * parameter.si * std::exp2(1 - k), lower, upper));
    }
    return values;
  }
  for (int k = 0; k < parameter.start_grid_points; ++k) {
    const double u = (k + 0.5) / n;
    const bool wide = lower > 0 && upper > 20 * lower;
    values.push_back(wide ? lower * std::pow(upper / lower, u) : lower + u * (upper - lower));
  }
  return values;
}

/// Slips that must lie on either side of a change, of n; of a few slips a quarter.
std::size_t least_beside_change(std::size_t n) {
  return std::min(limits::kCyclesOfBlock, std::max<std::size_t>(1, n / 4));
}

/// Times at which friction may have stepped: about the change point that explains most of the levels of the cycles
/// (likelihood ratio, E. S. Page, Biometrika 41 (1954) 100), between the two cycles and within either of them.
std::vector<double> change_points(const Observations& observations, std::span<const double> residual) {
  const std::size_t n = observations.slips.size();
  std::vector<double> level(n), weight(n);
  double total = 0, weights = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& slip = observations.slips[k];
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      level[k] += slip.direction * observations.weight[i] * residual[i];
      weight[k] += observations.weight[i];
    }
    total += level[k];
    weights += weight[k];
  }
  double before = 0, weight_before = 0, best = -1;
  std::size_t at = 0;
  const std::size_t beside = least_beside_change(n);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    before += level[k];
    weight_before += weight[k];
    if (k + 1 < beside || n - k - 1 < beside) continue;
    const double gap = before / weight_before - (total - before) / (weights - weight_before);
    const double gain = gap * gap * weight_before * (weights - weight_before) / weights;
    if (gain > best) {
      best = gain;
      at = k;
    }
  }
  std::vector<double> times;
  if (n < 2) return times;
  const auto& first = observations.slips[at];
  const auto& second = observations.slips[at + 1];
  times.push_back(0.5 * (observations.time[first.end - 1] + observations.time[second.begin]));
  for (const auto* slip : {&first, &second}) {
    const double begin = observations.time[slip->begin], length = observations.time[slip->end - 1] - begin;
    for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9}) times.push_back(begin + part * length);
  }
  return times;
}

/// Values of one parameter from which a search begins [SI], and how many independent places were looked at.
struct ParameterStarts {
  std::vector<double> values;
  double places = 1;
};

/// About the distance since a reversal at which friction changes most, so that a search ends at the best.
ParameterStarts distances_of_change(const Observations& observations, std::span<const double> residual,
                                    AllowedRange bounds) {
  const double at = distance_of_change(observations, residual, bounds.lower, bounds.upper);
  std::vector<double> places;
  for (const double beside : {1.0, 0.98, 1.02, 0.95, 1.05, 0.9, 1.1, 0.8, 1.25})
    places.push_back(std::clamp(beside * at, bounds.lower, bounds.upper));
  return {places, limits::kPlacesInStroke};
}

ParameterStarts starts_at_lines(const Parameter& parameter, const SpectralLines& lines) {
  return {lines.frequencies.empty() ? std::vector<double>{parameter.start} : lines.frequencies, lines.places};
}

/// bounds: in SI; longest: the end of the longest record [s].
ParameterStarts starts_of_parameter(const Parameter& parameter, AllowedRange bounds, double longest,
                                    const Record& first, const Observations& observations,
                                    std::span<const double> residual) {
  switch (parameter.search) {
    case ParameterSearch::steady_line:
      return starts_at_lines(
          parameter, strongest_lines(first, observations, residual,
                                     std::max(parameter.lower, lowest_steady_line(observations)), parameter.upper));
    case ParameterSearch::ringing_line:
      return starts_at_lines(parameter, strongest_ringing(observations, residual,
                                                          std::max(parameter.lower, lowest_ringing(observations))));
    case ParameterSearch::moment_of_change:
      return {change_points(observations, residual), static_cast<double>(observations.slips.size())};
    case ParameterSearch::distance_of_change:
      return distances_of_change(observations, residual, bounds);
    case ParameterSearch::jump_at_restick:
    case ParameterSearch::grid:
      break;
  }
  if (parameter.within_record) bounds.upper = std::min(bounds.upper, std::max(2 * longest, bounds.lower * 1.5));
  ParameterStarts out{grid_of(parameter, bounds.lower, bounds.upper)};
  const double jump = first.motion->restick_delay;
  if (parameter.search == ParameterSearch::jump_at_restick && jump != 0)
    out.values.push_back(std::clamp(jump, bounds.lower, bounds.upper));
  return out;
}

}  // namespace

std::string too_few_revolutions(double recorded, const EffectInfo& info) {
  const std::string needed = info.excitation.revolutions == 2 ? "two" : general(info.excitation.revolutions);
  return fmt::format("the record holds {} revolutions of the disc; {} are needed", fixed(recorded, 1), needed);
}

std::vector<Candidate> candidates(std::span<const Record> records, const Observations& observations,
                                  const std::vector<Effect>& own, const Instruments& instruments) {
  const Excitation seen = excitation_of(records, observations);
  std::vector<Candidate> out;
  for (const Effect& effect : effect_catalogue()) {
    if (is_kinematic(effect)) continue;
    EffectInfo info = describe(effect);
    std::string why = obstacle(info, records, observations, seen);
    const Motion& motion = *records[0].motion;
    const auto allowed =
        allowed_beside_declared(instruments, info.declared_by, motion.friction_kind, motion.conditions.load);
    for (const EffectForm& form : info.forms) {
      const Effect other = make_effect(info.key + ":" + form.name);
      if (is_kinematic(other)) continue;
      EffectInfo other_info = describe(other);
      std::string why_not = obstacle(other_info, records, observations, seen);
      out.push_back({other, std::move(other_info), std::move(why_not), allowed});
    }
    out.push_back({effect, std::move(info), std::move(why), allowed});
  }
  for (const Effect& effect : own) out.push_back({effect, describe(effect), {}, {}});
  return out;
}

bool is_amid_slips(const Observations& observations, double time) {
  struct Beside {
    std::size_t before = 0, after = 0, all = 0;
  };
  std::map<std::size_t, Beside> records;
  for (const auto& slip : observations.slips) {
    Beside& beside = records[slip.record];
    ++beside.all;
    if (observations.time[slip.end - 1] <= time) ++beside.before;
    if (observations.time[slip.begin] >= time) ++beside.after;
  }
  return std::any_of(records.begin(), records.end(), [](const auto& record) {
    const Beside& beside = record.second;
    // A slip within which the change lies counts for one of the sides.
    return std::min(beside.before, beside.after) + 1 >= least_beside_change(beside.all);
  });
}

Starts starts_of(const Candidate& candidate, std::span<const Record> records, const Observations& observations,
                 std::span<const double> residual) {
  Starts out;
  out.values.emplace_back();
  const FrictionModel alone(ExponentialLaw{}, {candidate.effect});
  const Bounds bounds = bounds_of(alone, observations);
  const std::size_t first = alone.base_count();
  double last = 0;
  for (const Record& record : records) last = std::max(last, record.motion->time.back());
  const auto& parameters = candidate.info.parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const ParameterStarts own = starts_of_parameter(on_scale_of(parameters[k], observations),
                                                    {bounds.lower[first + k], bounds.upper[first + k]}, last,
                                                    records[0], observations, residual);
    std::vector<std::vector<double>> all;
    for (const auto& start : out.values) {
      for (const double value : own.values) {
        all.push_back(start);
        all.back().push_back(value);
      }
    }
    out.values = std::move(all);
    out.places *= own.places;
  }
  return out;
}

}  // namespace tribofit::diagnosis
