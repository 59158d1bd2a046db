#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/limits.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Something that is read off without sliding, as each answer has it.
struct HandReading {
  std::string name, unit;
  double si = 1;
  double error = 0;  ///< standard uncertainty of one reading
  std::vector<double> of_models;
  double slowest = 0;  ///< time that hides a difference [s], of an edge that is slow; 0: of a place or a level

  double chance_to_see(double difference) const {
    if (difference == 0) return 0;
    return slowest > 0 ? normal_below((std::abs(difference) / slowest - 1) / kReadingOfSlope)
                       : chance_beyond(std::abs(difference) / error);
  }
};

/// What each answer makes of a value of an instrument; 0 where it says nothing of it.
std::vector<double> shown_by_models(const OpenQuestion& question, InstrumentValue what) {
  std::vector<double> out(question.models.size(), 0);
  for (std::size_t m = 0; m < question.asked.size(); ++m) {
    const EffectInfo info = describe(question.asked[m]);
    if (info.declared_by != what) continue;
    const Machine& machine = question.machines[m].machine;
    const double value = machine.parameters[machine.model.offset_of(info.key)];
    // A corner in Hz, or a time constant of one pole.
    out[m] = info.parameters[0].unit == "Hz" ? 1 / (2 * std::numbers::pi * value) : value;
  }
  return out;
}

std::vector<HandReading> readings_of(const OpenQuestion& question, const Experiment& experiment) {
  const auto shown = [&](InstrumentValue what) { return shown_by_models(question, what); };
  if (experiment.lift) {
    std::vector<double> sizes;
    for (const double mu : question.record.motion->friction) sizes.push_back(std::abs(mu));
    const double error =
        std::hypot(kReadingOfZero * median(sizes), kNoiseOfZero * question.record.noise.friction_noise);
    return {{"reading of the force sensor without contact", "", 1, error, shown(InstrumentValue::force_zero)}};
  }
  const double sample = kPartOfSample / experiment.tap;
  return {{"shift between the edges of the channels", "ms", 1e-3, std::hypot(kReadingOfEdge, sample),
           shown(InstrumentValue::vibrometer_delay)},
          {"time of the edge of friction", "ms", 1e-3, sample, shown(InstrumentValue::force_bandwidth),
           4 / (2 * std::numbers::pi * experiment.tap)}};
}

}  // namespace

double chance_beyond(double sigmas) {
  return normal_below(sigmas - diagnosis::limits::kDeclaredSigmas);
}

double chance_by_hand(const OpenQuestion& question, std::size_t truth, const Experiment& experiment) {
  const std::vector<HandReading> readings = readings_of(question, experiment);
  double least = 1;
  for (std::size_t other = 0; other < question.models.size(); ++other) {
    if (other == truth) continue;
    double most = 0;
    for (const HandReading& reading : readings) {
      most = std::max(most, reading.chance_to_see(reading.of_models[truth] - reading.of_models[other]));
    }
    least = std::min(least, most);
  }
  return least;
}

std::vector<Prediction> predict_by_hand(const OpenQuestion& question, const Experiment& experiment) {
  std::vector<Prediction> out;
  for (const HandReading& reading : readings_of(question, experiment)) {
    Prediction what{reading.name, reading.unit, reading.si};
    for (const double shown : reading.of_models) {
      what.models.push_back({shown, shown - 2 * reading.error, shown + 2 * reading.error});
      what.apart = std::max(what.apart, std::abs(shown) / reading.error);
    }
    if (what.apart > 0) out.push_back(std::move(what));
  }
  return out;
}

}  // namespace tribofit
