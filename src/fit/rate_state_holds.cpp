#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "rate_state_steps.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::fit {

namespace {

/// Slope of y over x by least squares, its error from the scatter about the line; NaN for fewer than three.
Estimate slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  const StraightLine line = fit_line(x, y);
  if (x.size() < 3 || !(line.squares > 0)) return {std::nan(""), std::nan(""), 1};
  double left = 0;
  for (std::size_t i = 0; i < x.size(); ++i) left += std::pow(y[i] - line.at(x[i]), 2);
  const auto freedom = static_cast<double>(x.size() - 2);
  return {line.slope, std::sqrt(left / freedom / line.squares), freedom};
}

/// Mean of friction less the model over values [begin, end), with the error of white noise.
Estimate offset_over(const RateStateData& data, const Eigen::VectorXd& model, std::size_t begin, std::size_t end,
                     std::size_t first_row, std::size_t first_value, double noise) {
  double sum = 0, count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const auto row = static_cast<Eigen::Index>(first_row + i - first_value);
    sum += data.count[i] * (data.friction[i] - model(row));
    count += data.count[i];
  }
  return {sum / count, noise / std::sqrt(count), count};
}

}  // namespace

std::optional<Healing> healing_of(const RateStateData& data, const RateStateProblem& problem,
                                  const std::vector<double>& p, const RateStateFit& fit) {
  Eigen::VectorXd response;
  if (!problem.response(p.data(), response, nullptr)) return std::nullopt;
  Healing out;
  std::vector<double> decades, measured, simulated;
  for (std::size_t s = 0; s < data.steps.size(); ++s) {
    const VelocityStep& step = data.steps[s];
    if (!(step.hold > 0)) continue;
    const std::size_t begin = data.begins[s], end = data.end_of(s), row = problem.row_of(s);
    const auto at = [&](std::size_t i) { return response(static_cast<Eigen::Index>(row + i - begin)); };
    std::size_t stop = begin, go = begin, peak = begin, lowest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (data.time[i] < step.time) stop = i + 1;
      if (data.time[i] < step.time + step.hold) go = i + 1;
    }
    if (go >= end || stop == begin) continue;
    peak = go;
    for (std::size_t i = go; i < end; ++i) {
      if (at(i) > at(peak)) peak = i;
    }
    lowest = go > stop ? go - 1 : stop;
    // Near the peak the model is right but for an offset, which noise says little of in one sample.
    const double near = 0.25 * std::abs(at(peak) - at(lowest));
    std::size_t from = peak, to = peak + 1;
    while (from > go && at(peak) - at(from - 1) < near) --from;
    while (to < end && at(peak) - at(to) < near) ++to;
    HoldMeasures hold;
    hold.step = s;
    hold.duration = step.hold;
    const double level = at(stop - 1);
    const Estimate before = offset_over(data, response, begin, stop, row, begin, fit.noise_white),
                   behind = offset_over(data, response, from, to, row, begin, fit.noise_white);
    hold.sliding = {level + before.value, before.std_error, before.degrees_of_freedom};
    hold.peak = {at(peak) + behind.value, behind.std_error, behind.degrees_of_freedom};
    hold.minimum = data.friction[lowest];
    hold.healing = hold.peak.value - hold.sliding.value;
    hold.relaxation = hold.sliding.value - hold.minimum;
    decades.push_back(std::log10(step.hold));
    measured.push_back(hold.healing);
    simulated.push_back(at(peak) - level);
    out.holds.push_back(hold);
  }
  if (out.holds.empty()) return std::nullopt;
  const auto [shortest, longest] = std::minmax_element(decades.begin(), decades.end());
  const bool differ = *longest - *shortest > kLeastDecades;
  out.per_decade = differ ? slope_of(decades, measured) : Estimate{std::nan(""), std::nan(""), 1};
  if (differ) out.per_decade_model = slope_of(decades, simulated).value;
  return out;
}

}  // namespace tribofit::fit
