#include "observing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Weighted means over each value of the reduced slips.
class WeightedMeans {
 public:
  WeightedMeans(const Observations& full, const Observations& few, std::size_t per_value)
      : full_(full), few_(few), per_value_(per_value) {}

  /// Calls write(begin, end) for the values behind each mean, in order.
  template <class Write>
  void each(Write&& write) const {
    for (const auto& slip : full_.slips) {
      for (std::size_t i = slip.begin; i < slip.end; i += per_value_) write(i, std::min(i + per_value_, slip.end));
    }
  }

  std::vector<double> of(const std::vector<double>& channel) const {
    std::vector<double> out;
    if (channel.empty()) return out;
    out.reserve(few_.weight.size());
    each([&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += full_.weight[i] * channel[i];
      out.push_back(sum / few_.weight[out.size()]);
    });
    return out;
  }

  /// Variance of v_r within each mean: between its values, and what each of them has within it.
  std::vector<double> variance_of_velocity() const {
    std::vector<double> out;
    out.reserve(few_.weight.size());
    each([&](std::size_t begin, std::size_t end) {
      const double mean = few_.velocity[out.size()];
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const double within = full_.velocity_variance.empty() ? 0 : full_.velocity_variance[i];
        sum += full_.weight[i] * (std::pow(full_.velocity[i] - mean, 2) + within);
      }
      out.push_back(sum / few_.weight[out.size()]);
    });
    return out;
  }

 private:
  const Observations &full_, &few_;
  std::size_t per_value_;
};

/// Values of the slips of `full` in `few`; the slip before a stick is the one before it in the list.
void number_values(const Observations& full, std::size_t per_value, Observations& few) {
  std::size_t values = 0;
  for (std::size_t k = 0; k < few.slips.size(); ++k) {
    Observations::SlipObservation& slip = few.slips[k];
    slip.begin = values;
    values += (full.slips[k].end - full.slips[k].begin + per_value - 1) / per_value;
    slip.end = values;
    const bool has_earlier = slip.earlier_end > slip.earlier_begin && k > 0;
    slip.earlier_begin = has_earlier ? few.slips[k - 1].begin : 0;
    slip.earlier_end = has_earlier ? few.slips[k - 1].end : 0;
  }
}

}  // namespace

Observations reduced(const Observations& observations, std::size_t per_value) {
  Observations out = observations;
  number_values(observations, per_value, out);
  const WeightedMeans means(observations, out, per_value);
  out.weight.clear();
  out.root_weight.clear();
  means.each([&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += observations.weight[i];
    out.weight.push_back(sum);
    out.root_weight.push_back(std::sqrt(sum));
  });
  for (const auto channel : {&Observations::time, &Observations::velocity, &Observations::friction,
                             &Observations::acceleration, &Observations::angle, &Observations::distance,
                             &Observations::reversal_distance, &Observations::load, &Observations::temperature}) {
    out.*channel = means.of(observations.*channel);
  }
  out.velocity_variance = means.variance_of_velocity();
  out.samples_per_value = observations.samples_per_value * per_value;
  return out;
}

std::optional<Observations> reduced_for_search(const FrictionModel& model, const Observations& observations,
                                               double values_per_slip) {
  for (const Effect& effect : model.effects()) {
    const EffectInfo info = describe(effect);
    if (info.needs_full_resolution || (info.group == EffectGroup::user && info.needs.time)) return std::nullopt;
  }
  std::vector<double> sizes;
  for (const auto& slip : observations.slips) sizes.push_back(static_cast<double>(slip.end - slip.begin));
  if (sizes.empty()) return std::nullopt;
  const auto per_value = static_cast<std::size_t>(median(std::move(sizes)) / values_per_slip + 0.5);
  if (per_value < 2) return std::nullopt;
  return reduced(observations, per_value);
}

}  // namespace tribofit
