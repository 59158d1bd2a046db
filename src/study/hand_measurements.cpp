#include "hand_measurements.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "weighing.hpp"

namespace tribofit {

namespace {

/// What an answer lets be measured without sliding.
struct Shown {
  double shift = 0;   ///< of the channels [s]
  double filter = 0;  ///< its time [s]
  double zero = 0;    ///< of the force sensor [1 or N]
};

Shown shown_by(const OpenQuestion& question, std::size_t model) {
  Shown out;
  const Effect& effect = question.asked[std::min(model, question.asked.size() - 1)];
  if (question.without(model)) return out;
  const EffectInfo info = describe(effect);
  const Machine& machine = question.machines[model].machine;
  const double value = machine.parameters[machine.model.offset_of(info.key)];
  if (info.declared_by == InstrumentValue::vibrometer_delay) out.shift = value;
  if (info.declared_by == InstrumentValue::force_zero) out.zero = value;
  // A corner in Hz, or a time constant of one pole.
  if (info.declared_by == InstrumentValue::force_bandwidth) {
    out.filter = info.parameters[0].unit == "Hz" ? 1 / (2 * std::numbers::pi * value) : value;
  }
  return out;
}

/// Of the place of an edge [s].
double error_of_edge(const Experiment& experiment) {
  return std::hypot(kReadingOfEdge, kPartOfSample / experiment.tap);
}

/// Of a zero [1 or N].
double error_of_zero(const OpenQuestion& question) {
  std::vector<double> sizes;
  for (const double mu : question.record.motion->friction) sizes.push_back(std::abs(mu));
  return std::hypot(kReadingOfZero * median(sizes), kNoiseOfZero * question.record.noise.friction_noise);
}

double chance_of_shift(double shift, double error) {
  return shift != 0 ? chance_beyond(std::abs(shift) / error) : 0;
}

/// error: of what the measurement shows first, a zero or the place of an edge.
double chance_between(const Shown& own, const Shown& other, const Experiment& experiment, double error) {
  if (experiment.lift) return chance_of_shift(own.zero - other.zero, error);
  const double slow = 4 / (2 * std::numbers::pi * experiment.tap);
  const double by_filter = std::abs(own.filter - other.filter) / slow;
  return std::max(chance_of_shift(own.shift - other.shift, error),
                  by_filter > 0 ? normal_below((by_filter - 1) / kReadingOfSlope) : 0);
}

}  // namespace

double chance_by_hand(const OpenQuestion& question, std::size_t truth, const Experiment& experiment) {
  const Shown own = shown_by(question, truth);
  const double error = experiment.lift ? error_of_zero(question) : error_of_edge(experiment);
  double least = 1;
  for (std::size_t other = 0; other < question.models.size(); ++other) {
    if (other != truth) least = std::min(least, chance_between(own, shown_by(question, other), experiment, error));
  }
  return least;
}

std::vector<Prediction> predict_by_hand(const OpenQuestion& question, const Experiment& experiment) {
  std::vector<Prediction> out;
  const auto predict = [&](Prediction what, double Shown::*value, double error) {
    for (std::size_t m = 0; m < question.models.size(); ++m) {
      const double shown = shown_by(question, m).*value;
      what.models.push_back({shown, shown - 2 * error, shown + 2 * error});
      what.apart = std::max(what.apart, std::abs(shown) / error);
    }
    if (what.apart > 0) out.push_back(std::move(what));
  };
  if (experiment.lift) {
    predict({"reading of the force sensor without contact", "", 1}, &Shown::zero, error_of_zero(question));
  } else {
    predict({"shift between the edges of the channels", "ms", 1e-3}, &Shown::shift, error_of_edge(experiment));
    predict({"time of the edge of friction", "ms", 1e-3}, &Shown::filter, kPartOfSample / experiment.tap);
  }
  return out;
}

}  // namespace tribofit
