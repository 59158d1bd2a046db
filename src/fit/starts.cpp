#include "starts.hpp"

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Mean |friction| in bins of |v_r|, with the samples behind each.
struct SpeedBin {
  double speed = 0, friction = 0, weight = 0;
};

std::vector<SpeedBin> bin_by_speed(const Observations& observations) {
  constexpr std::size_t kBins = 80;
  std::vector<SpeedBin> bins(kBins);
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const double v = std::abs(observations.velocity[i]);
      // Finer near v = 0, where the law bends.
      const double place = observations.fastest > 0 ? std::sqrt(v / observations.fastest) : 0;
      SpeedBin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(place * kBins))];
      bin.speed += observations.weight[i] * v;
      bin.friction += observations.weight[i] * observations.friction[i] * slip.direction;
      bin.weight += observations.weight[i];
    }
  }
  std::erase_if(bins, [](const SpeedBin& bin) { return bin.weight == 0; });
  for (SpeedBin& bin : bins) {
    bin.speed /= bin.weight;
    bin.friction /= bin.weight;
  }
  return bins;
}

/// Least squares of friction = mu_k + drop * shape(decay v) with the decay factor given, mu_k not below zero.
struct Levels {
  double mu_k = 0, drop = 0, cost = 0;
};

Levels fit_levels(BaseLaw law, double decay, const std::vector<SpeedBin>& bins) {
  double w = 0, s = 0, ss = 0, y = 0, ys = 0, yy = 0;
  for (const SpeedBin& bin : bins) {
    const double shape = stribeck_shape(law, decay * bin.speed);
    w += bin.weight;
    s += bin.weight * shape;
    ss += bin.weight * shape * shape;
    y += bin.weight * bin.friction;
    ys += bin.weight * bin.friction * shape;
    yy += bin.weight * bin.friction * bin.friction;
  }
  Levels levels;
  const double determinant = w * ss - s * s;
  if (determinant > 1e-12 * w * ss) {
    levels.drop = (w * ys - s * y) / determinant;
    levels.mu_k = (y - levels.drop * s) / w;
  } else if (w > 0) {
    levels.mu_k = y / w;
  }
  if (levels.mu_k < 0 && ss > 0) levels = {0, ys / ss, 0};
  const auto [k, d, unused] = levels;
  levels.cost = yy - 2 * (k * y + d * ys) + k * k * w + 2 * k * d * s + d * d * ss;
  return levels;
}

double mean_break_away(const Observations& observations, double otherwise) {
  double sum = 0, count = 0;
  for (const auto& slip : observations.slips) {
    if (!slip.from_stick) continue;
    sum += slip.break_away_friction;
    count += 1;
  }
  return count > 0 ? sum / count : otherwise;
}

/// Decay factors between which the law is neither a constant nor a straight line over the data [s/m].
std::array<double, 2> decay_range(const Observations& observations) {
  const double v = std::max(observations.fastest, 1e-9);
  return {0.2 / v, 40 / v};
}

/// How far the slips of these data exceed those of a tribometer; pieces of a record that never sticks say nothing.
double growth_of(BoundScaling grows, const Observations& observations) {
  constexpr double kSlipTime = 0.1, kSlipLength = 5e-3;  // [s], [m]
  if (grows == BoundScaling::never) return 1;
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
    const double unit = q.si * (q.scales_with_friction || q.bounds_scale_with_force ? scale : 1.0);
    const double grown = growth_of(q.bound_scaling, observations);
    bounds.lower.push_back(q.lower * unit * (q.lower < 0 ? grown : 1.0));
    bounds.upper.push_back(q.upper * unit * grown);
  }
  bounds.upper[0] = bounds.upper[1] = 5 * scale;
  if (model.base_count() == 3) {
    // Beyond these the law is a constant or a jump over all speeds that were recorded.
    const double fastest = std::max(observations.fastest, 1e-12);
    bounds.lower[2] = 0.01 / fastest;
    bounds.upper[2] = 1000 / fastest;
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
  const std::vector<SpeedBin> bins = bin_by_speed(observations);
  const auto [slowest, fastest] = decay_range(observations);
  if (model.law() == BaseLaw::coulomb) {
    const Levels levels = fit_levels(model.law(), 0, bins);
    p[0] = mean_break_away(observations, levels.mu_k);
    p[1] = levels.mu_k;
  } else {
    constexpr int kGrid = 40;
    Levels best;
    for (int k = 0; k < kGrid; ++k) {
      const double decay = slowest * std::pow(fastest / slowest, k / (kGrid - 1.0));
      const Levels levels = fit_levels(model.law(), decay, bins);
      if (k == 0 || levels.cost < best.cost) {
        best = levels;
        p[0] = levels.mu_k + levels.drop;
        p[1] = levels.mu_k;
        p[2] = decay;
      }
    }
  }
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
  const auto [slowest, fastest] = decay_range(observations);
  for (int s = static_cast<int>(starts.size()); s < count; ++s) {
    std::vector<double> p = starts[0];
    for (std::size_t k = 0; k < p.size(); ++k) {
      const double u = uniform(engine);
      const double low = bounds.lower[k], high = bounds.upper[k];
      if (k < 2) {
        p[k] *= 0.8 + 0.4 * u;
      } else if (k == 2 && model.base_count() == 3) {
        p[k] = slowest * std::pow(fastest / slowest, u);
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
