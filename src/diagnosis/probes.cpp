#include "probes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

#include "evidence.hpp"
#include "fit/points.hpp"
#include "fit/spectral_lines.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::diagnosis {

namespace {

/// Straight lines between knots: the weights of x on them.
class LinesBetweenKnots {
 public:
  explicit LinesBetweenKnots(std::vector<double> knots) : knots_(std::move(knots)) {}
  Eigen::Index count() const { return static_cast<Eigen::Index>(knots_.size()); }
  const std::vector<double>& knots() const { return knots_; }

  Eigen::RowVectorXd operator()(double x) const {
    Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(count());
    const auto next = std::upper_bound(knots_.begin(), knots_.end(), x);
    if (next == knots_.begin()) {
      out(0) = 1;
    } else if (next == knots_.end()) {
      out(count() - 1) = 1;
    } else {
      const auto k = static_cast<Eigen::Index>(next - knots_.begin());
      const double u = (x - *(next - 1)) / (*next - *(next - 1));
      out(k - 1) = 1 - u;
      out(k) = u;
    }
    return out;
  }

 private:
  std::vector<double> knots_;
};

std::vector<double> even_knots(double first, double last, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k) knots.push_back(first + (last - first) * k / (count - 1));
  return knots;
}

double middle_time(const Observations& observations, const Observations::SlipObservation& slip) {
  return 0.5 * (observations.time[slip.begin] + observations.time[slip.end - 1]);
}

/// Columns of a probe for slip k: one row a value and one for the break-away.
using Columns = ModelResiduals::FurtherColumns;

/// What a model says of every slip.
struct ProbeInputs {
  const Observations& observations;
  std::vector<std::vector<double>> mu;  ///< |model| at every value of each slip
  std::vector<double> level;            ///< |model| at break-away
};

ProbeInputs probe_inputs(const Observations& observations, const Trial& trial) {
  ProbeInputs out{observations, {}, {}};
  for (const auto& range : observations.slips) {
    const Slip slip = observations.slip(range);
    std::vector<double> mu(slip.size());
    evaluate<double>(trial.model, trial.p.data(), slip, slip.velocity, mu);
    for (double& x : mu) x *= range.direction;
    out.mu.push_back(std::move(mu));
    out.level.push_back(range.from_stick ? break_away_level(trial.model, trial.p.data(), slip) : 0);
  }
  return out;
}

/// Columns from a function of (slip, value) that returns what each coefficient adds to |mu|; value == size of the slip
/// asks for the break-away. The residual falls by it.
template <class Row>
Columns columns_of(const Observations& observations, Eigen::Index count, Row row) {
  return [&observations, count, row](std::size_t k) {
    const auto& range = observations.slips[k];
    const std::size_t n = range.end - range.begin;
    Eigen::MatrixXd out(static_cast<Eigen::Index>(n + (range.from_stick ? 1 : 0)), count);
    for (std::size_t i = 0; i < n; ++i) out.row(static_cast<Eigen::Index>(i)) = -range.direction * row(k, i);
    if (range.from_stick) out.row(static_cast<Eigen::Index>(n)) = -row(k, n);
    return out;
  };
}

std::optional<Probe> over_velocity(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  const LinesBetweenKnots lines(even_knots(0, o.fastest, 12));
  Probe probe;
  probe.variable = ResidualVariable::velocity;
  const auto row = [&o, &lines](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    const bool at_rest = range.begin + i == range.end;
    return lines(at_rest ? 0.0 : std::abs(o.velocity[range.begin + i]));
  };
  const Eigen::VectorXd found = judge_probe(context, level, trial, columns_of(o, lines.count(), row), 1, probe);
  probe.at = lines.knots();
  probe.value.assign(found.data(), found.data() + found.size());
  return probe;
}

std::optional<Probe> over_branch(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  const LinesBetweenKnots lines(even_knots(0, o.fastest, 6));
  Probe probe;
  probe.variable = ResidualVariable::branch;
  std::vector<std::size_t> peak;
  for (const auto& range : o.slips) {
    std::size_t best = range.begin;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (std::abs(o.velocity[i]) > std::abs(o.velocity[best])) best = i;
    }
    peak.push_back(best);
  }
  const auto row = [&](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    const std::size_t at = range.begin + i;
    if (at == range.end) return lines(0);
    const double sign = at < peak[k] ? 1 : -1;
    return Eigen::RowVectorXd(sign * lines(std::abs(o.velocity[at])));
  };
  judge_probe(context, level, trial, columns_of(o, lines.count(), row), 1, probe);
  return probe;
}

/// Columns that scale |mu| of a whole slip by functions of the slip.
template <class Functions>
Columns scaling(const ProbeInputs& inputs, Eigen::Index count, Functions functions) {
  return columns_of(inputs.observations, count, [&inputs, functions](std::size_t k, std::size_t i) {
    const bool at_rest = i == inputs.mu[k].size();
    return Eigen::RowVectorXd((at_rest ? inputs.level[k] : inputs.mu[k][i]) * functions(k, i));
  });
}

/// The fastest swing that levels of slips follow [Hz]: what is faster shows within slips, what is slower between them.
double fastest_swing(const Observations& observations) {
  std::vector<double> times;
  for (const auto& range : observations.slips) {
    if (range.record == 0 && range.end > range.begin) times.push_back(middle_time(observations, range));
  }
  const double span = times.empty() ? 0 : times.back() - times.front();
  return span > 0 ? limits::kSwingsOfSlip * static_cast<double>(times.size()) / span : 0;
}

/// Period of the strongest swing of the levels of the slips over time, and the number of periods looked at.
std::pair<double, double> strongest_swing(const ProbeInputs& inputs) {
  const Observations& o = inputs.observations;
  std::vector<double> times, levels, weights;
  double mean = 0, total = 0;
  for (std::size_t k = 0; k < o.slips.size(); ++k) {
    const auto& range = o.slips[k];
    if (range.record != 0 || range.end == range.begin) continue;
    double up = 0, down = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const double mu = inputs.mu[k][i - range.begin];
      up += o.weight[i] * mu * (range.direction * o.friction[i] - mu);
      down += o.weight[i] * mu * mu;
    }
    if (!(down > 0)) continue;
    times.push_back(middle_time(o, range));
    levels.push_back(up / down);
    weights.push_back(down);
    mean += up;
    total += down;
  }
  if (times.size() < limits::kFewestCycles) return {0, 1};
  mean /= total;
  const double span = times.back() - times.front();
  const double highest = fastest_swing(o), step = 0.1 / span;
  // From one frequency to the next every phase turns on by a step of its own.
  std::vector<std::complex<double>> at(times.size()), turn(times.size());
  double f = 0.8 / span, best = -1, frequency = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    at[k] = weights[k] * (levels[k] - mean) * std::polar(1.0, -(2 * std::numbers::pi) * f * times[k]);
    turn[k] = std::polar(1.0, -(2 * std::numbers::pi) * step * times[k]);
  }
  for (; f < highest; f += step) {
    double real = 0, imaginary = 0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double x = at[k].real(), y = at[k].imag(), c = turn[k].real(), s = turn[k].imag();
      real += x;
      imaginary += y;
      at[k] = {x * c - y * s, x * s + y * c};
    }
    const double swing = std::hypot(real, imaginary);
    if (swing > best) {
      best = swing;
      frequency = f;
    }
  }
  return {frequency > 0 ? 1 / frequency : 0, highest * span};
}

std::optional<Probe> over_time(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  Probe probe;
  probe.variable = ResidualVariable::time;
  const ProbeInputs inputs = probe_inputs(o, trial);
  const auto [period, places] = strongest_swing(inputs);
  std::vector<double> lasts(context.records.size(), 0.0);
  for (const auto& range : o.slips) lasts[range.record] = std::max(lasts[range.record], o.time[range.end - 1]);
  constexpr int kCosines = 4;
  const bool swings = period > 0;
  const double turn = swings ? (2 * std::numbers::pi) / period : 0;
  const auto functions = [&, swings, turn](std::size_t k, std::size_t /*i*/) {
    const auto& range = o.slips[k];
    const double t = middle_time(o, range);
    Eigen::RowVectorXd out(kCosines + (swings ? 2 : 0));
    for (int c = 0; c < kCosines; ++c) out(c) = std::cos(std::numbers::pi * (c + 1) * t / lasts[range.record]);
    if (swings) {
      out(kCosines) = std::cos(turn * t);
      out(kCosines + 1) = std::sin(turn * t);
    }
    return out;
  };
  const Eigen::VectorXd found =
      judge_probe(context, level, trial, scaling(inputs, kCosines + (swings ? 2 : 0), functions), places, probe);
  if (swings && found.size() == kCosines + 2) {
    probe.period = period;
    probe.value = {std::hypot(found(kCosines), found(kCosines + 1)), std::atan2(found(kCosines), found(kCosines + 1))};
  }
  return probe;
}

std::optional<Probe> over_angle(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  if (o.angle.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(o.angle.begin(), o.angle.end());
  if (*most - *least < 2 * (2 * std::numbers::pi)) return std::nullopt;
  // Every record begins at an angle of its own: as many terms for each as keep their number.
  const auto records = static_cast<Eigen::Index>(context.records.size());
  const Eigen::Index harmonics = std::max<Eigen::Index>(1, limits::kHarmonicsOfAngle / records);
  Probe probe;
  probe.variable = ResidualVariable::angle;
  const ProbeInputs inputs = probe_inputs(o, trial);
  const auto functions = [&o, records, harmonics](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    const double angle = o.angle[std::min(range.begin + i, range.end - 1)];
    Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(2 * harmonics * records);
    const Eigen::Index first = 2 * harmonics * static_cast<Eigen::Index>(range.record);
    for (Eigen::Index h = 0; h < harmonics; ++h) {
      out(first + 2 * h) = std::cos(static_cast<double>(h + 1) * angle);
      out(first + 2 * h + 1) = std::sin(static_cast<double>(h + 1) * angle);
    }
    return out;
  };
  judge_probe(context, level, trial, scaling(inputs, 2 * harmonics * records, functions), 1, probe);
  return probe;
}

/// Knots are closer just after a reversal, where what remembers it changes most.
std::optional<Probe> over_reversal_distance(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  if (o.reversal_distance.empty()) return std::nullopt;
  const double longest = *std::max_element(o.reversal_distance.begin(), o.reversal_distance.end());
  std::vector<double> knots = even_knots(0, 1, 9);
  for (double& knot : knots) knot *= knot * longest;
  const LinesBetweenKnots lines(knots);
  Probe probe;
  probe.variable = ResidualVariable::reversal_distance;
  const auto row = [&o, &lines](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    return lines(o.reversal_distance[std::min(range.begin + i, range.end - 1)]);
  };
  const Eigen::VectorXd found = judge_probe(context, level, trial, columns_of(o, lines.count(), row), 1, probe);
  probe.at = lines.knots();
  probe.value.assign(found.data(), found.data() + found.size());
  return probe;
}

std::optional<Probe> over_load(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  if (o.load.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(o.load.begin(), o.load.end());
  if (*most - *least < limits::kLeastLoadSpread * std::abs(o.mean_load)) return std::nullopt;
  const LinesBetweenKnots lines(even_knots(*least, *most, 4));
  Probe probe;
  probe.variable = ResidualVariable::load;
  const ProbeInputs inputs = probe_inputs(o, trial);
  const auto functions = [&](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    return lines(o.load[std::min(range.begin + i, range.end - 1)]);
  };
  judge_probe(context, level, trial, scaling(inputs, lines.count(), functions), 1, probe);
  return probe;
}

/// Logarithm of the stick time of each slip. NaN where it is not known.
std::vector<double> log_stick_times(const Observations& o) {
  std::vector<double> out;
  for (const auto& range : o.slips) {
    const bool known = range.from_stick && std::isfinite(range.stick_time) && range.stick_time > 0;
    out.push_back(known ? std::log(range.stick_time) : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

std::optional<Probe> over_stick_time(const DiagnosisContext& context, const Level& level, const Trial& trial) {
  const Observations& o = level.observations;
  const std::vector<double> given = log_stick_times(o);
  std::vector<double> sticks;
  for (const double x : given) {
    if (std::isfinite(x)) sticks.push_back(x);
  }
  if (sticks.size() < limits::kFewestCycles) return std::nullopt;
  std::sort(sticks.begin(), sticks.end());
  const double low = quantile_of_sorted(sticks, 0.05), high = quantile_of_sorted(sticks, 0.95);
  if (high - low < std::log(limits::kLeastStickRatio)) return std::nullopt;
  const LinesBetweenKnots lines(even_knots(low, high, 4));
  Probe probe;
  probe.variable = ResidualVariable::stick_time;
  const auto row = [&](std::size_t k, std::size_t i) {
    const auto& range = o.slips[k];
    const bool known = std::isfinite(given[k]);
    const bool at_rest = range.begin + i == range.end;
    // What a higher break-away does to the slip fades with speed as the law does.
    const double speed = at_rest ? 0 : std::abs(o.velocity[range.begin + i]);
    const double fade = at_rest ? 1 : break_away_left(trial.model.law(), trial.p, speed);
    return Eigen::RowVectorXd((known ? fade : 0.0) * lines(known ? given[k] : low));
  };
  judge_probe(context, level, trial, columns_of(o, lines.count(), row), 1, probe);
  return probe;
}

std::optional<Probe> over_frequency(const DiagnosisContext& context, const Trial& fine,
                                    std::span<const double> residual) {
  if (are_points(context.records)) return std::nullopt;
  const Observations& o = context.fine.observations;
  const SpectralLines found = strongest_lines(
      context.records[0], o, residual, std::max(fastest_swing(o), 1 / (limits::kSlowestLine * o.scales.slip_time)),
      0.4 * observation_rate(o));
  if (found.frequencies.empty()) return std::nullopt;
  const double frequency = found.frequencies.front();
  Probe probe;
  probe.variable = ResidualVariable::frequency;
  probe.period = 1 / frequency;
  const auto columns = [&o, frequency](std::size_t k) {
    const auto& range = o.slips[k];
    const auto n = static_cast<Eigen::Index>(range.end - range.begin);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n + (range.from_stick ? 1 : 0), 2);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double phase = (2 * std::numbers::pi) * frequency * o.time[range.begin + static_cast<std::size_t>(i)];
      out.row(i) << std::cos(phase), std::sin(phase);
    }
    return out;
  };
  judge_probe(context, context.fine, fine, columns, found.places, probe);
  return probe;
}

}  // namespace

std::vector<Probe> probe_all(const DiagnosisContext& context, const Trial& coarse, const Trial& fine,
                             std::span<const double> residual) {
  using Over = std::optional<Probe> (*)(const DiagnosisContext&, const Level&, const Trial&);
  std::vector<Over> all = {over_velocity, over_load};
  if (!are_points(context.records)) {
    all = {over_velocity, over_branch, over_time, over_angle, over_stick_time, over_load, over_reversal_distance};
  }
  std::vector<std::optional<Probe>> found(all.size() + 1);
  run_tasks(found.size(), context.threads, [&](std::size_t k) {
    if (k == all.size()) return void(found[k] = over_frequency(context, fine, residual));
    found[k] = all[k](context, context.coarse, coarse);
    // What matters is judged as models are: means over a good part of a slip are off themselves, and have other noise.
    const bool matters = found[k] && found[k]->fall > 0 && found[k]->size > limits::kLeastStructure;
    if (matters) found[k] = all[k](context, context.fine, fine);
  });
  std::vector<Probe> out;
  for (std::optional<Probe>& probe : found) {
    if (probe) out.push_back(std::move(*probe));
  }
  return out;
}

std::vector<Probe> remaining_structure(const std::vector<Probe>& probes, double shared) {
  std::vector<Probe> out;
  for (const Probe& probe : probes) {
    const bool chance = probe.p_value * static_cast<double>(probes.size()) >= limits::kChance;
    // What a break-away level does to its own stick time is taken out to first order only: enough to say where an error
    // sits, not to carry a verdict.
    if (probe.variable == ResidualVariable::stick_time) continue;
    if (!chance && probe.fall > 0 && probe.size > std::max(limits::kLeastStructure, shared)) out.push_back(probe);
  }
  std::stable_sort(out.begin(), out.end(), [](const Probe& a, const Probe& b) { return a.fall > b.fall; });
  return out;
}

}  // namespace tribofit::diagnosis
