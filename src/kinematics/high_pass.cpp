#include "high_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
HighPassTerms restoring_terms(const BlockMeans& velocity, const Plateaus& plateaus, double corner, double plateau,
                              std::span<const double> disc) {
  HighPassTerms terms;
  terms.rate = (2 * std::numbers::pi) * corner;
  const double h = velocity.step;
  std::vector<double> restored(velocity.mean.size());
  double integral = 0;
  for (std::size_t b = 0; b < restored.size(); ++b) {
    restored[b] = velocity.mean[b] + terms.rate * (integral + 0.5 * h * velocity.mean[b]);
    integral += h * velocity.mean[b];
    if (!disc.empty()) restored[b] -= disc[b];
  }
  if (plateaus.empty()) {  // no plateau to be level: no drift and no net displacement of the block
    const StraightLine line = fit_line(restored);
    terms.slope = -line.slope / h;
    terms.offset = -line.value + 0.5 * line.slope * static_cast<double>(restored.size());
    return terms;
  }
  // Straight line through the levels of the plateaus; those of a run-up or a mistaken plateau are left out by halves.
  std::vector<double> times, levels, weights;
  for (const StickPlateau& run : plateaus.runs) {
    const std::size_t n = run.inner_end() - run.inner_begin();
    const StraightLine line = fit_line(std::span<const double>(restored).subspan(run.inner_begin(), n));
    times.push_back(0.5 * h * static_cast<double>(run.inner_begin() + run.inner_end()));
    levels.push_back(line.value);
    weights.push_back(static_cast<double>(n));
  }
  std::vector<double> used = weights;
  StraightLine line;
  for (int pass = 0; pass < 4; ++pass) {
    line = fit_line(times, levels, used);
    std::vector<double> deviation;
    for (std::size_t k = 0; k < levels.size(); ++k) deviation.push_back(std::abs(levels[k] - line.at(times[k])));
    const double limit = std::max(5 * median(deviation), 1e-12);
    for (std::size_t k = 0; k < levels.size(); ++k) used[k] = deviation[k] <= limit ? weights[k] : 0;
  }
  const double slope = line.slope, offset = line.at(0);
  terms.slope = -slope;
  if (plateau == plateau) {
    terms.offset = plateau - offset;
    return terms;
  }
  // No net displacement between the middles of the first and the last plateau.
  const std::size_t begin = (plateaus.runs.front().begin + plateaus.runs.front().end) / 2;
  const std::size_t end = (plateaus.runs.back().begin + plateaus.runs.back().end) / 2;
  double sum = 0;
  for (std::size_t b = begin; b < end; ++b) sum += restored[b] - slope * h * (static_cast<double>(b) + 0.5);
  terms.offset = end > begin ? -sum / static_cast<double>(end - begin) : 0;
  return terms;
}

void restore(std::span<double> velocity, double step, const HighPassTerms& terms) {
  double integral = 0;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double v = velocity[i];
    // Trapezoid: half of the sample now, half with the next.
    velocity[i] =
        v + terms.rate * (integral + 0.5 * step * v) + terms.offset + terms.slope * step * static_cast<double>(i);
    integral += step * v;
  }
}

}  // namespace tribofit::kinematics
