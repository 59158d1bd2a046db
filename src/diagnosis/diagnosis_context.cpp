#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "record_evidence.hpp"
#include "trial.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit::diagnosis {

double sum(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

std::vector<std::size_t> blocks_to_hold_out(const Observations& observations) {
  return blocks_of(observations, std::clamp(observations.cycles / limits::kCyclesOfBlock, limits::kFewestBlocks,
                                            limits::kMostBlocks));
}

Level::Level(const Observations& given)
    : observations(given), values(static_cast<double>(given.size())), samples(sum(given.weight)) {}

namespace {

/// The noise of v_r in the middle of the stick before a slip, smoothed as in the slip. Empty where that is too short.
std::vector<double> noise_of_stick(const Record& record, const Observations::SlipObservation& slip) {
  const SampleRange& stick = record.segmentation->cycles[slip.segment].stick;
  const auto part = static_cast<std::size_t>(limits::kEndOfStick * static_cast<double>(stick.size()));
  if (!slip.from_stick || part == 0) return {};
  const std::size_t begin = stick.begin + part, end = std::min(stick.end - part, begin + slip.samples.size());
  std::vector<double> noise = slip_motion(*record.motion, {begin, end}).velocity;
  const StraightLine line = fit_line(noise);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] -= line.at(static_cast<double>(i));
  return noise;
}

/// The noise that is left of v_r at each value of the observations; 0 where it is not known [m/s].
std::vector<double> left_of_velocity_noise(std::span<const Record> records, const Observations& observations) {
  std::vector<double> noise(observations.size(), 0.0);
  const std::size_t each = observations.samples_per_value;
  for (const auto& slip : observations.slips) {
    const std::vector<double> of_stick = noise_of_stick(records[slip.record], slip);
    if (of_stick.size() < each) continue;
    std::size_t sample = 0;  // a stick that is shorter than its slip is taken again from its beginning
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      for (std::size_t k = 0; k < each; ++k, ++sample)
        noise[i] += of_stick[sample % of_stick.size()] / static_cast<double>(each);
    }
  }
  return noise;
}

}  // namespace

double squares_of_velocity_noise(const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  double sum = 0;
  std::vector<double> mu, noisy, velocity;
  for (const auto& range : o.slips) {
    const Slip slip = o.slip(range);
    mu.resize(slip.size());
    noisy.resize(slip.size());
    velocity.assign(slip.velocity.begin(), slip.velocity.end());
    evaluate<double>(trial.model, trial.p.data(), slip, velocity, mu);
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] += level.velocity_noise[range.begin + i];
    evaluate<double>(trial.model, trial.p.data(), slip, velocity, noisy);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const double change = noisy[i] - mu[i];
      sum += o.weight[range.begin + i] * change * change;
    }
  }
  return sum;
}

struct DiagnosisContext::Finest {
  std::once_flag made;
  std::optional<Observations> observations;
  std::optional<Level> level;
};

DiagnosisContext::DiagnosisContext(std::span<const Record> given, const Observations& finely,
                                   const Observations& coarsely, double sensor_noise, double break_away_scatter)
    : records(given),
      fine(finely),
      coarse(coarsely),
      blocks(blocks_to_hold_out(finely)),
      noise(sensor_noise),
      scatter(break_away_scatter),
      finest_(std::make_shared<Finest>()) {}

const Level& DiagnosisContext::finest() const {
  std::call_once(finest_->made, [&] {
    const std::size_t most = finest_values(count_cycles(records));
    finest_->observations = observe_all(records, fine.observations.noise, all_channels(records), most, noise);
    finest_->level.emplace(*finest_->observations);
    finest_->level->velocity_noise = left_of_velocity_noise(records, *finest_->observations);
    finest_->level->known = fine.known;
  });
  return *finest_->level;
}

double DiagnosisContext::floor_squares(const ModelResiduals::Whitening& whitening) const {
  double sensitivity = 0;
  for (const Eigen::VectorXd& g : whitening.g) sensitivity += g.squaredNorm();
  return noise_squares() + scatter * scatter * sensitivity;
}

}  // namespace tribofit::diagnosis
