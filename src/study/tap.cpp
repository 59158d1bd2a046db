#include "tap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "weighing.hpp"

namespace tribofit {

namespace {

/// What a tap shows of each answer: a shift of the channels [s], and the time of a filter [s].
struct TapShows {
  double shift = 0, filter = 0;
};
TapShows tap_shows(const OpenQuestion& question, std::size_t model) {
  TapShows out;
  const Effect& effect = question.asked[std::min(model, question.asked.size() - 1)];
  if (question.without(model)) return out;
  const EffectInfo info = describe(effect);
  const Machine& machine = question.machines[model].machine;
  const double value = machine.parameters[machine.model.offset_of(info.key)];
  if (info.declared_by == InstrumentValue::vibrometer_delay) out.shift = value;
  // A corner in Hz, or a time constant of one pole.
  if (info.declared_by == InstrumentValue::force_bandwidth) {
    out.filter = info.parameters[0].unit == "Hz" ? 1 / (2 * std::numbers::pi * value) : value;
  }
  return out;
}

/// Chance that a value so many of its errors beyond a limit is read beyond it.
double chance_of_slower(double errors) {
  return 0.5 * std::erfc(-errors / std::sqrt(2.0));
}

}  // namespace

double chance_of_tap(const OpenQuestion& question, std::size_t truth, double rate) {
  const double edge = std::hypot(kReadingOfEdge, kPartOfSample / rate), slow = 4 / (2 * std::numbers::pi * rate);
  const TapShows own = tap_shows(question, truth);
  double least = 1;
  for (std::size_t other = 0; other < question.models.size(); ++other) {
    if (other == truth) continue;
    const TapShows its = tap_shows(question, other);
    const double by_shift = std::abs(own.shift - its.shift) / edge,
                 by_filter = std::abs(own.filter - its.filter) / slow;
    double chance = by_shift > 0 ? chance_beyond(by_shift) : 0;
    if (by_filter > 0) chance = std::max(chance, chance_of_slower((by_filter - 1) / kReadingOfSlope));
    least = std::min(least, chance);
  }
  return least;
}

std::vector<Prediction> predict_tap(const OpenQuestion& question, double rate) {
  const double edge = std::hypot(kReadingOfEdge, kPartOfSample / rate);
  Prediction shift{"shift between the edges of the channels", "ms", 1e-3},
      filter{"time of the edge of friction", "ms", 1e-3};
  for (std::size_t m = 0; m < question.models.size(); ++m) {
    const TapShows shows = tap_shows(question, m);
    shift.models.push_back({shows.shift, shows.shift - 2 * edge, shows.shift + 2 * edge});
    filter.models.push_back(
        {shows.filter, shows.filter - 2 * kPartOfSample / rate, shows.filter + 2 * kPartOfSample / rate});
    shift.apart = std::max(shift.apart, std::abs(shows.shift) / edge);
    filter.apart = std::max(filter.apart, shows.filter * rate / kPartOfSample);
  }
  std::vector<Prediction> out;
  if (shift.apart > 0) out.push_back(std::move(shift));
  if (filter.apart > 0) out.push_back(std::move(filter));
  return out;
}

}  // namespace tribofit
