#include "rate_state_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "limits.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::fit {

namespace {

/// What friction does at one step.
struct StepShape {
  double peak = 0;       ///< largest departure from the level before, in the direction of the direct effect [1]
  double left = 0;       ///< of it at the end [1]
  double rise = 0;       ///< displacement of the load point against sliding until half of the peak [m]
  double decay = 0;      ///< sliding from the peak until a third of it is left [m]
  double logarithm = 1;  ///< of the ratio of speeds
};

double mean_between(const RateStateData& data, std::size_t begin, std::size_t end) {
  double sum = 0, count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    sum += data.count[i] * data.friction[i];
    count += data.count[i];
  }
  return count > 0 ? sum / count : std::nan("");
}

/// Running medians of three, against single samples that noise has thrown out.
double smoothed_at(const RateStateData& data, std::size_t i, std::size_t begin, std::size_t end) {
  std::array<double, 3> near = {data.friction[i > begin ? i - 1 : i], data.friction[i],
                                data.friction[i + 1 < end ? i + 1 : i]};
  std::sort(near.begin(), near.end());
  return near[1];
}

StepShape shape_of(const RateStateData& data, std::size_t s) {
  const VelocityStep& step = data.steps[s];
  const std::size_t begin = data.begins[s], end = data.end_of(s);
  std::size_t middle = begin;
  while (middle < end && data.time[middle] < step.time) ++middle;
  std::size_t last = middle;  // where sliding at the new speed begins
  while (last < end && data.time[last] < step.time + step.hold) ++last;
  const double level = mean_between(data, begin, middle);
  const double tail = mean_between(data, end - std::max<std::size_t>(1, (end - last) / 4), end);
  StepShape out;
  out.logarithm = step.hold > 0 ? kHoldAsRatio : std::log(step.after / step.before);
  const double sign = out.logarithm > 0 ? 1 : -1;
  std::size_t peak = last;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = last; i < end; ++i) {
    const double value = sign * (smoothed_at(data, i, begin, end) - level);
    if (value > most) most = value, peak = i;
  }
  const double bottom = step.hold > 0 ? smoothed_at(data, std::max(last, begin + 1) - 1, begin, end) : level;
  const double total = sign * (data.friction[peak] - bottom);
  out.peak = std::max(total, 1e-9);
  out.left = sign * (tail - level);
  const double apart = std::abs(step.after - (step.hold > 0 ? 0 : step.before));
  const double start = step.time + step.hold;
  for (std::size_t i = last; i <= peak && i < end; ++i) {
    out.rise = apart * std::max(data.time[i] - start, 0.3 * step.interval);
    if (sign * (smoothed_at(data, i, begin, end) - bottom) > 0.5 * total) break;
  }
  const double falls = sign * (data.friction[peak] - tail);
  for (std::size_t i = peak; i < end; ++i) {
    out.decay = data.displacement[i] - data.displacement[peak];
    if (sign * (smoothed_at(data, i, begin, end) - tail) < 0.37 * falls) break;
  }
  return out;
}

double range_of(const std::vector<double>& values) {
  return quantile(values, 0.995) - quantile(values, 0.005);
}

Parameter parameter_of(std::string name, std::string description, std::string unit, double si) {
  Parameter out;
  out.name = std::move(name);
  out.description = std::move(description);
  out.unit = std::move(unit);
  out.si = si;
  return out;
}

void add(RateStateUnknowns& unknowns, Parameter parameter, bool logarithmic, double lower, double upper) {
  parameter.lower = lower / parameter.si;
  parameter.upper = upper / parameter.si;
  unknowns.parameters.push_back(std::move(parameter));
  unknowns.logarithmic.push_back(logarithmic);
  unknowns.lower.push_back(logarithmic ? std::log(lower) : lower);
  unknowns.upper.push_back(logarithmic ? std::log(upper) : upper);
}

/// Usual values at the steps of a record.
struct Scales {
  double a, b, distance, stiffness;
};

Scales scales_of(const RateStateData& data) {
  std::vector<double> direct, rate, decay, stiffness;
  for (std::size_t s = 0; s < data.steps.size(); ++s) {
    const StepShape shape = shape_of(data, s);
    const double logarithm = std::abs(shape.logarithm);
    direct.push_back(shape.peak / logarithm);
    if (data.steps[s].hold == 0) rate.push_back(shape.left / logarithm);
    if (shape.decay > 0) decay.push_back(shape.decay);
    if (shape.rise > 0) stiffness.push_back(0.5 * shape.peak / shape.rise);
  }
  Scales out{};
  out.a = 1.2 * median(direct);
  out.b = out.a - (rate.empty() ? 0 : median(rate));
  out.distance = decay.empty() ? std::nan("") : median(decay);
  out.stiffness = stiffness.empty() ? std::nan("") : median(stiffness);
  return out;
}

/// Starts: sizes of a and D_c about those that the steps show, with b from the friction that is left, and k from close
/// to the critical stiffness upwards. Near it the response swings, and only starts near by lead to the minimum.
std::vector<std::vector<double>> starts_about(const Scales& scales, std::size_t states,
                                              const RateStateUnknowns& unknowns) {
  constexpr std::array<double, 5> kDirect = {0.8, 1.2, 1.8, 2.7, 4};
  constexpr std::array<double, 10> kDistance = {1, 0.67, 1.5, 0.45, 2.2, 0.3, 4, 0.2, 0.13, 0.09};
  constexpr std::array<double, 8> kOverCritical = {4, 2, 10, 1.4, 40, 1.15, 1.03, 0.97};
  constexpr std::array<double, 5> kStiffness = {1, 3, 0.3, 10, 0.1};
  const double fall = scales.b - scales.a;  // of steady friction for an e-fold of the speed
  std::vector<std::vector<double>> out;
  for (const double direct : kDirect) {
    for (const double distance : kDistance) {
      const double a = direct * scales.a, d = distance * scales.distance;
      std::vector<double> stiffness;
      if (fall > 0) {
        for (const double k : kOverCritical) stiffness.push_back(k * fall / d);
      } else {
        for (const double k : kStiffness) stiffness.push_back(k * scales.stiffness);
      }
      for (const double k : stiffness) {
        std::vector<double> p = {a};
        for (std::size_t i = 0; i < states; ++i) {
          p.push_back(states == 1 ? a + fall : 0.5 * (a + fall));
          p.push_back(std::log(d * (i == 0 ? 1 : kSecondDistance)));
        }
        p.push_back(std::log(k));
        for (std::size_t j = 0; j < p.size(); ++j) p[j] = std::clamp(p[j], unknowns.lower[j], unknowns.upper[j]);
        out.push_back(std::move(p));
      }
    }
  }
  return out;
}

void apply_given(const std::vector<GivenParameter>& given, RateStateUnknowns& unknowns) {
  for (std::size_t k = 0; k < unknowns.parameters.size(); ++k) {
    Parameter& parameter = unknowns.parameters[k];
    const auto found =
        std::find_if(given.begin(), given.end(), [&](const GivenParameter& g) { return g.name == parameter.name; });
    if (found == given.end()) continue;
    if (parameter.name != "a" && parameter.name != "k") unknowns.states_alike = false;
    if (found->bounds) {
      parameter.lower = found->bounds->lower / parameter.si;
      parameter.upper = found->bounds->upper / parameter.si;
      unknowns.lower[k] = unknowns.searched(k, found->bounds->lower);
      unknowns.upper[k] = unknowns.searched(k, found->bounds->upper);
    }
    for (std::vector<double>& start : unknowns.starts) {
      if (found->start) start[k] = unknowns.searched(k, *found->start);
      start[k] = std::clamp(start[k], unknowns.lower[k], unknowns.upper[k]);
    }
  }
}

}  // namespace

double RateStateUnknowns::value(std::size_t k, double searched) const {
  return logarithmic[k] ? std::exp(searched) : searched;
}

double RateStateUnknowns::searched(std::size_t k, double value) const {
  return logarithmic[k] ? std::log(std::max(value, std::numeric_limits<double>::min())) : value;
}

RateStateUnknowns unknowns_of(const RateStateData& data, std::size_t states, const std::vector<GivenParameter>& given) {
  const double friction = range_of(data.friction);
  double longest = 0, finest = std::numeric_limits<double>::infinity();
  for (const VelocityStep& step : data.steps) {
    longest = std::max(longest, step.after * (step.to - step.time - step.hold));
    finest = std::min(finest, std::max(step.before, step.after) * step.interval);
  }
  RateStateUnknowns out;
  const auto bound_friction = [&](const char* name, const char* description, double lower) {
    add(out, parameter_of(name, description, data.is_force ? "N" : "1", 1), false, lower, kLargestOfRange * friction);
  };
  const auto bound_distance = [&](const char* name) {
    add(out, parameter_of(name, "sliding distance over which the contacts are renewed", "um", kMicrometre), true,
        kLeastOfSampling * finest, kMostOfSliding * longest);
  };
  bound_friction("a", "direct effect: what an e-fold of the sliding speed adds at once", kLeastOfRange * friction);
  bound_friction("b", "evolution effect: what it takes away over D_c", -kLargestOfRange * friction);
  bound_distance("D_c");
  if (states > 1) {
    bound_friction("b_2", "evolution effect of the second state", -kLargestOfRange * friction);
    bound_distance("D_c2");
  }
  const char* stiffness = data.is_force ? "stiffness of the machine" : "stiffness of the machine per normal force";
  add(out, parameter_of("k", stiffness, data.is_force ? "N/um" : "1/um", 1 / kMicrometre), true,
      kLeastOfRange * friction / longest, kLargestOfRange * friction / finest);
  Scales scales = scales_of(data);
  if (!(scales.distance > 0)) scales.distance = 0.1 * longest;
  if (!(scales.stiffness > 0)) scales.stiffness = friction / (0.1 * longest);
  out.starts = starts_about(scales, states, out);
  apply_given(given, out);
  for (std::size_t k = 0; k < out.parameters.size(); ++k)
    out.parameters[k].start = out.value(k, out.starts.front()[k]) / out.parameters[k].si;
  return out;
}

Solution refine(const RateStateProblem& problem, const std::vector<double>& start, const RateStateUnknowns& unknowns) {
  constexpr SolverOptions kSearch{
      .max_iterations = 100, .relative_step = 1e-9, .relative_cost = 1e-10, .careful = false};
  Solution found = minimize(problem, start, unknowns.lower, unknowns.upper, kSearch);
  found.converged = found.converged && std::isfinite(found.cost);
  return found;
}

Solution search(const RateStateData& data, const RateStateModel& model, const std::vector<std::size_t>& steps,
                const RateStateUnknowns& unknowns) {
  const RateStateData few = thinned(data, kValuesOfStepSearch);
  const RateStateProblem coarse(few, model, steps);
  std::vector<Solution> found;
  Eigen::VectorXd residual(static_cast<Eigen::Index>(coarse.count()));
  for (const std::vector<double>& start : unknowns.starts) {
    stop_point();
    if (!coarse.evaluate(start.data(), residual.data(), nullptr)) continue;  // it runs away from here
    found.push_back({.p = start, .cost = 0.5 * residual.squaredNorm(), .message = {}});
  }
  const auto by_cost = [](const Solution& x, const Solution& y) { return x.cost < y.cost; };
  const auto keep_best = [&](std::size_t most, int iterations) {
    std::stable_sort(found.begin(), found.end(), by_cost);
    found.resize(std::min(most, found.size()));
    for (Solution& known : found) {
      Solution lower =
          minimize(coarse, known.p, unknowns.lower, unknowns.upper,
                   {.max_iterations = iterations, .relative_step = 1e-5, .relative_cost = 1e-6, .careful = false});
      if (std::isfinite(lower.cost) && lower.cost <= known.cost) known = std::move(lower);
    }
  };
  keep_best(8, 12);
  keep_best(3, 60);
  if (found.empty()) return {.p = {}, .message = "from every start the simulated sliding ran away"};
  const auto best = std::min_element(found.begin(), found.end(), by_cost);
  Solution out = refine(RateStateProblem(data, model, steps), best->p, unknowns);
  if (model.states == 2 && unknowns.states_alike && out.p.size() > 4 && out.p[2] > out.p[4]) {
    std::swap(out.p[1], out.p[3]);
    std::swap(out.p[2], out.p[4]);
  }
  return out;
}

Solution search_together(const RateStateData& data, const RateStateModel& model, const std::vector<std::size_t>& steps,
                         const RateStateUnknowns& unknowns) {
  Solution together = search(data, model, steps, unknowns);
  if (steps.size() < 2) return together;
  const std::vector<std::size_t> first = {steps.front()};
  Solution grown = search(data, model, first, unknowns);
  if (!grown.converged) return together;
  const auto values_of = [&](const std::vector<std::size_t>& some) {
    std::size_t values = 0;
    for (const std::size_t s : some) values += data.end_of(s) - data.begins[s];
    return static_cast<double>(values);
  };
  const double alone = grown.cost / values_of(first);
  if (together.converged && together.cost / values_of(steps) <= kFarFromMinimum * alone) return together;
  for (std::size_t count = 2; count <= steps.size(); ++count) {
    const std::vector<std::size_t> some(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(count));
    Solution next = refine(RateStateProblem(data, model, some), grown.p, unknowns);
    if (next.converged || count == steps.size()) grown = std::move(next);
  }
  return grown.converged && (!together.converged || grown.cost < together.cost) ? grown : together;
}

}  // namespace tribofit::fit
