#include "tribofit/segmentation/friction_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "counts.hpp"
#include "limits.hpp"

namespace tribofit {

namespace {

struct Sum {
  double value = 0, velocity = 0, count = 0;
  void add(double v, double friction) {
    value += friction;
    velocity += v;
    count += 1;
  }
  double mean() const { return count > 0 ? value / count : std::nan(""); }
};

template <class Use>
void for_each_sample(const Motion& motion, const Cycle& cycle, Use use) {
  for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
    if (!motion.has_fault(i, SampleFault::any)) use(motion.relative_velocity[i], motion.friction[i]);
  }
}

/// Slips of one direction that are used.
std::vector<const Cycle*> slips_of(const Segmentation& segmentation, int direction) {
  std::vector<const Cycle*> slips;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.direction == direction && segmentation.is_selected(cycle.slip)) slips.push_back(&cycle);
  }
  return slips;
}

void add_bins(const Motion& motion, const std::vector<const Cycle*>& slips, int direction,
              std::vector<FrictionLevels::Bin>& bins) {
  double fastest = 0;
  for (const Cycle* slip : slips) fastest = std::max(fastest, slip->peak_velocity);
  std::array<std::vector<double>, segmentation::kLevelBins> means;
  std::array<Sum, segmentation::kLevelBins> all;
  for (const Cycle* slip : slips) {
    std::array<Sum, segmentation::kLevelBins> sums;
    for_each_sample(motion, *slip, [&](double v, double friction) {
      const double at = direction * v / fastest * static_cast<double>(segmentation::kLevelBins);
      if (!(at > 0)) return;
      const auto bin = std::min(segmentation::kLevelBins - 1, static_cast<std::size_t>(at));
      sums[bin].add(v, friction);
      all[bin].add(v, friction);
    });
    for (std::size_t bin = 0; bin < segmentation::kLevelBins; ++bin) {
      if (sums[bin].count > 0) means[bin].push_back(sums[bin].mean());
    }
  }
  for (std::size_t bin = 0; bin < segmentation::kLevelBins; ++bin) {
    if (means[bin].size() < segmentation::kFewestSlipsOfBin) continue;
    bins.push_back({all[bin].velocity / all[bin].count, segmentation::mean_over_slips(means[bin]), means[bin].size()});
  }
}

/// Mean size of friction over the faster part of a slip; NaN where that is not known.
double level_of(const Motion& motion, const Cycle& slip) {
  Sum sum;
  for_each_sample(motion, slip, [&](double v, double friction) {
    if (slip.direction * v >= segmentation::kFasterPart * slip.peak_velocity) sum.add(v, slip.direction * friction);
  });
  return sum.mean();
}

FrictionLevels::Level level_between(const Motion& motion, const std::vector<const Cycle*>& by_peak, std::size_t begin,
                                    std::size_t end) {
  std::vector<const Cycle*> slips(by_peak.begin() + static_cast<std::ptrdiff_t>(begin),
                                  by_peak.begin() + static_cast<std::ptrdiff_t>(end));
  FrictionLevels::Level level{slips.front()->peak_velocity, slips.back()->peak_velocity, {}, slips.size()};
  std::sort(slips.begin(), slips.end(),
            [](const Cycle* a, const Cycle* b) { return a->slip.begin < b->slip.begin; });  // errors are of a series
  std::vector<double> values;
  for (const Cycle* slip : slips) values.push_back(level_of(motion, *slip));
  level.friction = segmentation::mean_over_slips(std::move(values));
  return level;
}

}  // namespace

FrictionLevels friction_levels(const Motion& motion, const Segmentation& segmentation) {
  FrictionLevels out;
  std::vector<const Cycle*> all;
  for (const int direction : {-1, 1}) {
    const std::vector<const Cycle*> slips = slips_of(segmentation, direction);
    add_bins(motion, slips, direction, out.bins);
    all.insert(all.end(), slips.begin(), slips.end());
  }
  std::sort(out.bins.begin(), out.bins.end(), [](const auto& a, const auto& b) { return a.velocity < b.velocity; });
  if (all.size() < segmentation::kFewestForLevels) return out;
  std::sort(all.begin(), all.end(), [](const Cycle* a, const Cycle* b) {
    return a->peak_velocity != b->peak_velocity ? a->peak_velocity < b->peak_velocity : a->slip.begin < b->slip.begin;
  });
  out.levels = {level_between(motion, all, 0, all.size() / 2), level_between(motion, all, all.size() / 2, all.size())};
  return out;
}

}  // namespace tribofit
