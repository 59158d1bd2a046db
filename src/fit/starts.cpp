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

FrictionCurve curve_of(const Observations& observations) {
  constexpr std::size_t kBins = 80;
  FrictionCurve curve{.bins = std::vector<FrictionCurve::Bin>(kBins),
                      .break_away = mean_break_away(observations),
                      .fastest = observations.fastest};
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const double v = std::abs(observations.velocity[i]);
      // Finer near v = 0, where laws bend.
      const double place = observations.fastest > 0 ? std::sqrt(v / observations.fastest) : 0;
      FrictionCurve::Bin& bin = curve.bins[std::min(kBins - 1, static_cast<std::size_t>(place * kBins))];
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

/// How far the slips of these data exceed those of a tribometer; pieces of a record that never sticks say nothing.
double growth_of(BoundScaling grows, const Observations& observations) {
  constexpr double kSlipTime = 0.1, kSlipLength = 5e-3;  // [s], [m]
  if (grows != BoundScaling::with_slip_time && grows != BoundScaling::with_slip_length) return 1;
  std::vector<double> sizes;
  for (const auto& slip : observations.slips) {
    if (!slip.from_stick || slip.end - slip.begin < 2) continue;
    const double time = observations.time[slip.end - 1] - observations.time[slip.begin];
    double speed = 0, weight = 0;
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      speed += observations.weight[i] * std::abs(observations.velocity[i]);
      weight += observations.weight[i];
    }
    sizes.push_back(grows == BoundScaling::with_slip_time ? time / kSlipTime : time * speed / weight / kSlipLength);
  }
  return sizes.empty() ? 1 : std::max(1.0, median(std::move(sizes)));
}

}  // namespace

Bounds bounds_of(const FrictionModel& model, const Observations& observations) {
  // A coefficient is of the order of one, a force is of the order of what was recorded.
  const double scale = std::max(1.0, observations.largest_friction);
  Bounds bounds;
  for (const auto& slot : model.parameters()) {
    const Parameter& q = slot.parameter;
    if (sets_steepness(q)) {
      // Beyond these the law is a constant or a jump over all speeds that were recorded.
      const double fastest = std::max(observations.fastest, 1e-12);
      const auto [lower, upper] = as_parameter(q.bound_scaling, {0.01 / fastest, 1000 / fastest});
      bounds.lower.push_back(lower);
      bounds.upper.push_back(upper);
      continue;
    }
    const double unit = q.si * (q.scales_with_friction || q.bounds_scale_with_force ? scale : 1.0);
    const double grown = growth_of(q.bound_scaling, observations);
    bounds.lower.push_back(q.lower * unit * (q.lower < 0 ? grown : 1.0));
    bounds.upper.push_back(q.upper * unit * grown);
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

std::vector<double> start_from_data(const FrictionModel& model, const Observations& observations,
                                    const Bounds& bounds) {
  std::vector<double> p;
  const double scale = std::max(1.0, observations.largest_friction);
  for (const auto& slot : model.parameters()) {
    p.push_back(slot.parameter.start * slot.parameter.si * (slot.parameter.scales_with_friction ? scale : 1.0));
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
    const double scale = std::max(1.0, observations.largest_friction);
    for (std::size_t k = model.base_count(); k < p.size(); ++k) {
      const Parameter& q = model.parameters()[k].parameter;
      const double neutral = std::isnan(q.neutral) ? q.start : q.neutral;
      p[k] = std::clamp(neutral * q.si * (q.scales_with_friction ? scale : 1.0), bounds.lower[k], bounds.upper[k]);
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

}  // namespace tribofit
