#include "starts.hpp"

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

double mean_break_away(const Observations& observations) {
  double sum = 0, count = 0;
  for (const auto& slip : observations.slips) {
    if (!slip.from_stick) continue;
    sum += slip.break_away_friction;
    count += 1;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

constexpr std::size_t kBins = 80;

/// Finer near v = 0, where laws are most curved.
std::size_t bin_of(const Observations& observations, std::size_t i) {
  const double place =
      observations.fastest > 0 ? std::sqrt(std::abs(observations.velocity[i]) / observations.fastest) : 0;
  return std::min(kBins - 1, static_cast<std::size_t>(place * kBins));
}

FrictionCurve curve_of(const Observations& observations) {
  FrictionCurve curve{.bins = std::vector<FrictionCurve::Bin>(kBins),
                      .break_away = mean_break_away(observations),
                      .fastest = observations.fastest};
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const double v = std::abs(observations.velocity[i]);
      FrictionCurve::Bin& bin = curve.bins[bin_of(observations, i)];
      bin.speed += observations.weight[i] * v;
      bin.friction += observations.weight[i] * observations.friction[i] * slip.direction;
      bin.weight += observations.weight[i];
    }
  }
  std::erase_if(curve.bins, [](const FrictionCurve::Bin& bin) { return bin.weight == 0; });
  for (FrictionCurve::Bin& bin : curve.bins) {
    bin.speed /= bin.weight;
    bin.friction /= bin.weight;
  }
  return curve;
}

/// A range of steepness as one of the parameter that grows `with` or against it.
std::array<double, 2> as_parameter(BoundScaling with, const std::array<double, 2>& steepness) {
  if (with == BoundScaling::against_speed) return steepness;
  return {1 / steepness[1], 1 / steepness[0]};
}

bool sets_steepness(const Parameter& parameter) {
  return parameter.bound_scaling == BoundScaling::with_speed || parameter.bound_scaling == BoundScaling::against_speed;
}

/// The scale of this record over the one for which the catalogue states its bounds.
double growth_of(BoundScaling scaling, const RecordScales& here) {
  const RecordScales stated;
  const double slip_time = here.slip_time / stated.slip_time, slip_length = here.slip_length / stated.slip_length;
  switch (scaling) {
    case BoundScaling::with_slip_time:
      return slip_time;
    case BoundScaling::against_slip_time:
      return 1 / slip_time;
    case BoundScaling::with_stick_time:
      return here.stick_time / stated.stick_time;
    case BoundScaling::with_slip_length:
      return slip_length;
    case BoundScaling::against_slip_length:
      return 1 / slip_length;
    case BoundScaling::against_top_speed:
      return stated.top_speed / here.top_speed;
    case BoundScaling::with_duration:
      return here.duration / stated.duration;
    case BoundScaling::against_duration:
      return stated.duration / here.duration;
    case BoundScaling::with_distance:
      return here.distance / stated.distance;
    case BoundScaling::with_stroke:
      return here.stroke / stated.stroke;
    case BoundScaling::with_mass:
      return here.mass / stated.mass;
    case BoundScaling::never:
    case BoundScaling::with_speed:
    case BoundScaling::against_speed:
      break;
  }
  return 1;
}

/// Scales that are those of the longest of several records, and no medians over all slips.
bool goes_with_extent(BoundScaling scaling) {
  return scaling == BoundScaling::with_duration || scaling == BoundScaling::against_duration ||
         scaling == BoundScaling::with_distance;
}

}  // namespace

Parameter on_scale_of(Parameter parameter, const Observations& observations) {
  if (sets_steepness(parameter)) {
    // Beyond these the law is a constant or a jump over all speeds that were recorded.
    const double fastest = std::max(observations.fastest, 1e-12);
    const auto [lower, upper] = as_parameter(parameter.bound_scaling, {0.01 / fastest, 1000 / fastest});
    parameter.lower = lower / parameter.si;
    parameter.upper = upper / parameter.si;
    return parameter;
  }
  // A coefficient is of the order of one, a force is of the order of what was recorded.
  const double force = parameter.scales_with_friction ? observations.friction_scale : 1.0;
  const double factor = force * growth_of(parameter.bound_scaling, observations.scales);
  Parameter out = parameter;
  for (double* value : {&out.lower, &out.upper, &out.start, &out.neutral}) *value *= factor;
  for (const RecordScales& scales : observations.scales_of_records) {
    if (!goes_with_extent(parameter.bound_scaling)) break;
    const double own = force * growth_of(parameter.bound_scaling, scales);
    out.lower = std::min(out.lower, own * parameter.lower);
    out.upper = std::max(out.upper, own * parameter.upper);
  }
  if (parameter.neutral == parameter.lower) out.neutral = out.lower;
  if (parameter.neutral == parameter.upper) out.neutral = out.upper;
  return out;
}

Bounds bounds_of(const FrictionModel& model, const Observations& observations) {
  Bounds bounds;
  for (const auto& slot : model.parameters()) {
    const Parameter q = on_scale_of(slot.parameter, observations);
    bounds.lower.push_back(q.lower * q.si);
    bounds.upper.push_back(q.upper * q.si);
  }
  return bounds;
}

void apply_given(const FrictionModel& model, const std::vector<GivenParameter>& given, Bounds& bounds) {
  for (std::size_t k = 0; k < model.parameters().size(); ++k) {
    for (const GivenParameter& known : given) {
      if (!known.bounds || known.name != model.parameters()[k].full_name()) continue;
      bounds.lower[k] = known.bounds->lower;
      bounds.upper[k] = known.bounds->upper;
    }
  }
}

void apply_given(const FrictionModel& model, const std::vector<GivenParameter>& given, const Bounds& bounds,
                 std::vector<double>& start) {
  for (std::size_t k = 0; k < start.size(); ++k) {
    for (const GivenParameter& known : given) {
      if (known.start && known.name == model.parameters()[k].full_name()) start[k] = *known.start;
    }
    start[k] = std::clamp(start[k], bounds.lower[k], bounds.upper[k]);
  }
}

double distance_of_change(const Observations& observations, std::span<const double> residual, double lower,
                          double upper) {
  struct Value {
    double distance, level, weight;
  };
  std::vector<Value> values;
  double total = 0, weights = 0;
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end && !observations.reversal_distance.empty(); ++i) {
      const double weight = observations.weight[i];
      values.push_back({observations.reversal_distance[i], slip.direction * weight * residual[i], weight});
      total += values.back().level;
      weights += weight;
    }
  }
  std::sort(values.begin(), values.end(), [](const Value& a, const Value& b) { return a.distance < b.distance; });
  double level = 0, weight = 0, best = -1, at = lower;
  for (const Value& value : values) {
    level += value.level;
    weight += value.weight;
    const bool inside = value.distance > lower && value.distance < upper && weight < weights;
    if (!inside) continue;
    const double gap = level / weight - (total - level) / (weights - weight);
    const double gain = gap * gap * weight * (weights - weight);
    if (gain > best) {
      best = gain;
      at = value.distance;
    }
  }
  return at;
}

std::vector<double> start_from_data(const FrictionModel& model, const Observations& observations,
                                    const Bounds& bounds) {
  std::vector<double> p;
  for (const auto& slot : model.parameters()) {
    const Parameter q = on_scale_of(slot.parameter, observations);
    p.push_back(q.start * q.si);
    if (q.search == ParameterSearch::distance_of_change)
      p.back() = distance_of_change(observations, about_mean_curve(observations), q.lower * q.si, q.upper * q.si);
  }
  const FrictionCurve curve = curve_of(observations);
  const std::vector<double> of_law = std::visit([&](const auto& law) { return law.start(curve); }, model.law());
  std::copy(of_law.begin(), of_law.end(), p.begin());
  for (std::size_t k = 0; k < p.size(); ++k) p[k] = std::clamp(p[k], bounds.lower[k], bounds.upper[k]);
  return p;
}

std::vector<std::vector<double>> make_starts(const FrictionModel& model, const Observations& observations,
                                             const Bounds& bounds, int count, std::uint64_t seed) {
  std::vector<std::vector<double>> starts = {start_from_data(model, observations, bounds)};
  if (!model.effects().empty()) {
    // The bare law, with effects that hardly act: a richer model must not end above the poorer one.
    std::vector<double> p = starts[0];
    for (std::size_t k = model.base_count(); k < p.size(); ++k) {
      const Parameter q = on_scale_of(model.parameters()[k].parameter, observations);
      p[k] = std::clamp((std::isnan(q.neutral) ? q.start : q.neutral) * q.si, bounds.lower[k], bounds.upper[k]);
    }
    starts.push_back(p);
  }
  boost::random::mt19937_64 engine(seed);
  boost::random::uniform_01<double> uniform;
  for (int s = static_cast<int>(starts.size()); s < count; ++s) {
    std::vector<double> p = starts[0];
    for (std::size_t k = 0; k < p.size(); ++k) {
      const double u = uniform(engine);
      const double low = bounds.lower[k], high = bounds.upper[k];
      const Parameter& q = model.parameters()[k].parameter;
      if (sets_steepness(q)) {
        const auto [least, most] =
            as_parameter(q.bound_scaling, FrictionCurve::resolved_steepness(observations.fastest));
        p[k] = least * std::pow(most / least, u);
      } else if (k < model.base_count()) {
        p[k] *= 0.8 + 0.4 * u;
      } else if (low > 0 && high > 20 * low) {
        p[k] = low * std::pow(high / low, u);
      } else {
        p[k] = low + u * (high - low);
      }
      p[k] = std::clamp(p[k], low, high);
    }
    starts.push_back(p);
  }
  return starts;
}

std::vector<double> about_mean_curve(const Observations& observations) {
  std::vector<double> sum(kBins, 0.0), weight(kBins, 0.0), out(observations.size(), 0.0);
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      sum[bin_of(observations, i)] += observations.weight[i] * slip.direction * observations.friction[i];
      weight[bin_of(observations, i)] += observations.weight[i];
    }
  }
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const std::size_t bin = bin_of(observations, i);
      out[i] = observations.friction[i] - slip.direction * sum[bin] / weight[bin];
    }
  }
  return out;
}

}  // namespace tribofit
