#include "record_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/points.hpp"
#include "fit/spectral_lines.hpp"
#include "limits.hpp"

namespace tribofit::diagnosis {

Channels all_channels(std::span<const Record> records) {
  Channels all;
  all.acceleration = all.distance = all.reversal_distance = all.stick_time = all.lead = !are_points(records);
  const auto each = [&](auto has) { return std::all_of(records.begin(), records.end(), has); };
  all.angle = each([](const Record& r) {
    return !r.motion->disc_angle.empty() || !r.motion->disc_speed.empty() || r.motion->conditions.speed.known();
  });
  all.load = each([](const Record& r) { return !r.motion->load.empty() || r.motion->conditions.load.known(); });
  all.temperature = each([](const Record& r) { return !r.motion->temperature.empty(); });
  return all;
}

std::vector<RecordNoise> noises_of(std::span<const Record> records, int threads) {
  std::vector<RecordNoise> noises;
  for (const Record& record : records) {
    RecordNoise noise = noise_of(*record.motion, *record.segmentation, threads);
    const Floor floor = tribofit::floor_of(noise);
    if (!record.motion->is_points() && floor.sampling == 0) {
      const LineInStick line = line_in_stick(record, floor.noise);
      noise.line = line.frequency;
      noise.beside_line = line.noise;
    }
    noises.push_back(std::move(noise));
  }
  return noises;
}

Observations observe_all(std::span<const Record> records, std::span<const RecordNoise> noises, const Channels& channels,
                         std::size_t values_per_slip, double stick_unit) {
  std::vector<Observations> parts;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    parts.push_back(observe(*record.motion, *record.segmentation, noises[r], channels, values_per_slip));
    add_stick_evidence(*record.motion, *record.segmentation, stick_unit, parts.back());
  }
  return parts.size() == 1 ? std::move(parts[0]) : join(std::move(parts));
}

std::size_t count_cycles(std::span<const Record> records) {
  std::size_t cycles = 0;
  for (const Record& record : records) {
    if (record.motion->is_points()) {
      cycles += record.motion->size();
      continue;
    }
    const bool sticks = record.segmentation->kind == MotionKind::stick_slip;
    const auto& all = record.segmentation->cycles;
    const auto taken = std::count_if(all.begin(), all.end(),
                                     [&](const Cycle& cycle) { return record.segmentation->is_selected(cycle); });
    cycles += sticks ? static_cast<std::size_t>(taken) : limits::kFewestCycles;
  }
  return cycles;
}

Floor floor_of(std::span<const Record> records, std::span<const RecordNoise> noises) {
  double noise = 0, scatter = 0, sampling = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Floor floor = tribofit::floor_of(noises[r]);
    const double own = noises[r].line > 0 ? noises[r].beside_line : floor.noise;
    noise += std::pow(own, 2) / static_cast<double>(records.size());
    scatter += std::pow(floor.scatter, 2) / static_cast<double>(records.size());
    sampling += std::pow(floor.sampling, 2) / static_cast<double>(records.size());
  }
  Floor out;
  out.noise = std::sqrt(noise);
  out.scatter = std::sqrt(scatter);
  out.sampling = std::sqrt(sampling);
  return out;
}

namespace {

/// Values of a slip in which candidates are fitted.
std::size_t fine_values(std::size_t cycles) {
  return std::clamp(limits::kFineValues / cycles, limits::kFewestFine, limits::kMostFine);
}

/// And in which they are screened. A filter is not seen in means over more than its time.
std::size_t coarse_values(std::span<const Record> records, std::size_t cycles, const Floor& floor) {
  // Means over a good part of a slip are off by more than what sampling leaves.
  if (floor.sampling > 0) return fine_values(cycles);
  const bool filtered = std::any_of(records.begin(), records.end(),
                                    [](const Record& record) { return record.motion->friction_low_pass.any(); });
  if (filtered) return limits::kFewestFine;
  return std::clamp(limits::kCoarseValues / cycles, limits::kFewestCoarse, limits::kMostCoarse);
}

DiagnosisContext context_of(std::span<const Record> records, const Observations& fine, const Observations& coarse,
                            const Floor& floor, int threads, std::vector<GivenParameter> known) {
  DiagnosisContext context(records, fine, coarse, floor.noise, floor.scatter);
  context.shared = (floor.sampling > 0 ? std::pow(floor.sampling / floor.noise, 2) : 0) +
                   left_by_corrections(records, fine, floor.noise) / context.noise_squares();
  context.fine.known = context.coarse.known = std::move(known);
  context.threads = threads;
  return context;
}

}  // namespace

std::size_t finest_values(std::size_t cycles) {
  return std::clamp(limits::kFinestValues / cycles, fine_values(cycles), limits::kMostFine);
}

RecordEvidence::RecordEvidence(std::span<const Record> records, int threads, std::vector<GivenParameter> known)
    : noises(noises_of(records, threads)),
      floor(floor_of(records, noises)),
      fine(observe_all(records, noises, all_channels(records), fine_values(count_cycles(records)), floor.noise)),
      coarse(observe_all(records, noises, all_channels(records), coarse_values(records, count_cycles(records), floor),
                         floor.noise)),
      context(context_of(records, fine, coarse, floor, threads, std::move(known))) {}

}  // namespace tribofit::diagnosis
