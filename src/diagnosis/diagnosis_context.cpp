#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "record_evidence.hpp"
#include "trial.hpp"
#include "velocity_noise.hpp"

namespace tribofit::diagnosis {

Level::Level(const Observations& given)
    : observations(given), values(static_cast<double>(given.size())), samples(sum(given.weight)) {}

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
      blocks(finely),
      noise(sensor_noise),
      scatter(break_away_scatter),
      finest_(std::make_shared<Finest>()) {}

const Level& DiagnosisContext::finest() const {
  std::call_once(finest_->made, [&] {
    const std::size_t most = finest_values(count_cycles(records));
    finest_->observations = observe_all(records, fine.observations.noise, all_channels(records), most, noise);
    std::vector<double> left = quieten_velocity(records, *finest_->observations);
    finest_->level.emplace(*finest_->observations);
    finest_->level->velocity_noise = std::move(left);
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
