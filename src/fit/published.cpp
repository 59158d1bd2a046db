#include "published.hpp"

#include <cmath>
#include <limits>

#include "limits.hpp"

namespace tribofit {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
}  // namespace

std::array<double, 2> CycleExtremes::means(const std::vector<bool>& left_out) const {
  std::array<double, 2> out{};
  for (std::size_t k = 0; k < 2; ++k) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t c = 0; c < of_cycle[k].size(); ++c) {
      if (!std::isfinite(of_cycle[k][c]) || (!left_out.empty() && left_out[c])) continue;
      sum += of_cycle[k][c];
      ++count;
    }
    out[k] = count < kFewestCycles ? kNaN : sum / static_cast<double>(count);
  }
  return out;
}

CycleExtremes extremes_of(const Observations& observations, std::span<const Record> records) {
  CycleExtremes out;
  for (auto& values : out.of_cycle) values.assign(observations.cycles, kNaN);
  for (const auto& slip : observations.slips) {
    const Cycle& cycle = records[slip.record].segmentation->cycles[slip.segment];
    if (cycle.stick.size() == 0 || !cycle.slip_complete) continue;
    out.of_cycle[0][slip.cycle] = cycle.stick_maximum;
    out.of_cycle[1][slip.cycle] = cycle.slip_minimum;
  }
  return out;
}

Eigen::MatrixXd published_influence(const NormalEquations& equations, const std::vector<bool>& free,
                                    const CycleExtremes& extremes) {
  Eigen::MatrixXd levels =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equations.curvature.size()), equations.total.cols());
  const std::array<double, 2> means = extremes.means();
  for (std::size_t k = 0; k < 2; ++k) {
    double known = 0;
    for (const double value : extremes.of_cycle[k]) known += std::isfinite(value) ? 1 : 0;
    for (std::size_t c = 0; c < extremes.of_cycle[k].size(); ++c) {
      if (!std::isfinite(extremes.of_cycle[k][c])) continue;
      levels(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) =
          static_cast<double>(extremes.of_cycle[k].size()) / known * (extremes.of_cycle[k][c] - means[k]);
    }
  }
  const Eigen::MatrixXd follows = inverse_over(equations.total, free) * equations.total;
  return influence(equations, free) + levels - levels * follows.transpose();
}

}  // namespace tribofit
