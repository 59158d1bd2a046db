#include "tribofit/kinematics/clock_offset.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ingest/clock.hpp"
#include "ingest/limits.hpp"
#include "limits.hpp"
#include "statistics/golden_section.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// The velocity most samples have, and how far slip takes it away from that.
struct Plateau {
  double velocity = 0, reach = 0;
};

Plateau find_plateau(const std::vector<double>& velocity) {
  const double low = quantile(thinned(velocity, kEnough), kSpikesOfVelocity),
               high = quantile(thinned(velocity, kEnough), 1 - kSpikesOfVelocity);
  std::array<std::size_t, kVelocityBins> bins{};
  const double width = (high - low) / static_cast<double>(bins.size());
  if (!(width > 0)) return {low, 0};
  for (const double v : velocity) {
    const double bin = std::clamp((v - low) / width, 0.0, static_cast<double>(bins.size() - 1));
    ++bins[static_cast<std::size_t>(bin)];
  }
  const auto top = std::max_element(bins.begin(), bins.end()) - bins.begin();
  const double mode = low + (static_cast<double>(top) + 0.5) * width;
  return {mode, std::max(high - mode, mode - low)};
}

/// Times at which `signal` goes from below `arm` to above `level`, where it has been below `arm` since the last time.
template <typename Signal>
std::vector<double> upward_crossings(const std::vector<double>& time, Signal signal, double arm, double level) {
  std::vector<double> events;
  bool armed = false;
  double last = signal(0);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double value = signal(i);
    if (value < arm) armed = true;
    if (armed && value > level && i > 0) {
      armed = false;
      events.push_back(time[i - 1] + (time[i] - time[i - 1]) * (level - last) / (value - last));
    }
    last = value;
  }
  return events;
}

double median_interval(const std::vector<double>& events) {
  return events.size() > 1 ? typical_interval(events) : 0;
}

struct Candidate {
  double offset = 0;
  std::size_t support = 0;
};

/// Offsets under which most events of both coincide, best first.
std::vector<Candidate> coincidences(const std::vector<double>& a, const std::vector<double>& b, double width,
                                    double apart) {
  std::vector<double> differences;
  for (const double x : a) {
    for (const double y : b) differences.push_back(x - y);
  }
  std::sort(differences.begin(), differences.end());
  std::vector<Candidate> windows;
  for (std::size_t i = 0, j = 0; i < differences.size(); ++i) {
    while (j < differences.size() && differences[j] <= differences[i] + width) ++j;
    windows.push_back({(differences[i] + differences[j - 1]) / 2, j - i});
  }
  std::stable_sort(windows.begin(), windows.end(), [](const auto& x, const auto& y) { return x.support > y.support; });
  std::vector<Candidate> best;
  for (const Candidate& window : windows) {
    if (best.size() == kMostOffsets) break;
    if (!best.empty() &&
        static_cast<double>(window.support) < kFewestOfBest * static_cast<double>(best.front().support))
      break;
    const bool is_new = std::all_of(best.begin(), best.end(),
                                    [&](const Candidate& c) { return std::abs(c.offset - window.offset) > apart; });
    if (is_new) best.push_back(window);
  }
  return best;
}

/// How far friction is from balancing the motion at a given offset: m a + c v + k x = N mu holds for any law of
/// friction, in stick and in slip, so friction is a linear function of the block's displacement, velocity and
/// acceleration when the clocks agree, and is not when they do not.
class ForceBalance {
 public:
  ForceBalance(const std::vector<double>& friction_time, const std::vector<double>& friction,
               const std::vector<double>& velocity_time, const std::vector<double>& velocity)
      : friction_time_(friction_time), friction_(friction), velocity_time_(velocity_time) {
    const std::size_t n = velocity.size();
    double mean = 0;
    for (const double v : velocity) mean += v / static_cast<double>(n);
    motion_.resize(n);
    double x = 0;
    const auto half =
        std::max<std::size_t>(1, static_cast<std::size_t>(kAccelerationOver / typical_interval(velocity_time)));
    width_ = static_cast<double>(half) * typical_interval(velocity_time);
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) x += ((velocity[i] + velocity[i - 1]) / 2 - mean) * (velocity_time[i] - velocity_time[i - 1]);
      const std::size_t before = i - std::min(i, half), after = std::min(n - 1, i + half);
      const double a = (velocity[after] - velocity[before]) / (velocity_time[after] - velocity_time[before]);
      motion_[i] = {x, velocity[i] - mean, a};
    }
  }

  /// Part of the variance of friction that the motion does not balance, for friction samples [begin, end).
  double operator()(double offset, std::size_t begin, std::size_t end, std::size_t stride) const {
    // Regressors: a constant, a drift of the integral, x, v, a; scaled so that the normal equations are well
    // conditioned.
    constexpr int count = 5;
    Eigen::Matrix<double, count, count> normal = Eigen::Matrix<double, count, count>::Zero();
    Eigen::Matrix<double, count, 1> right = Eigen::Matrix<double, count, 1>::Zero();
    double squares = 0, sum = 0, samples = 0;
    std::size_t k = 0;
    const double first = friction_time_[begin], span = friction_time_[end - 1] - first;
    for (std::size_t i = begin; i < end; i += stride) {
      const double t = friction_time_[i] - offset;
      if (t < velocity_time_.front() || t >= velocity_time_.back()) continue;
      if (k == 0)
        k = static_cast<std::size_t>(std::upper_bound(velocity_time_.begin(), velocity_time_.end(), t) -
                                     velocity_time_.begin()) -
            1;
      while (velocity_time_[k + 1] <= t) ++k;
      const double part = (t - velocity_time_[k]) / (velocity_time_[k + 1] - velocity_time_[k]);
      const Eigen::Vector3d motion = (1 - part) * motion_[k] + part * motion_[k + 1];
      Eigen::Matrix<double, count, 1> row;
      row << 1, (friction_time_[i] - first) / span, motion;
      normal.noalias() += row * row.transpose();
      right += friction_[i] * row;
      squares += friction_[i] * friction_[i];
      sum += friction_[i];
      samples += 1;
    }
    const double variance = squares - sum * sum / samples;
    if (samples < static_cast<double>(kFewestBalanced) || !(variance > 0)) return 1;
    const Eigen::Matrix<double, count, 1> scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Eigen::Matrix<double, count, count> scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    const Eigen::VectorXd scaled_right = scale.asDiagonal() * right;
    const Eigen::VectorXd solved = solve_symmetric_system(scaled, scaled_right).x;
    // Mass and stiffness have one sign; where they have not, a shifted copy of the motion imitates friction.
    if (!(solved[2] * solved[4] > 0)) return 1;
    const double balanced = scaled_right.dot(solved);
    return std::clamp((squares - balanced) / variance, 0.0, 1.0);
  }

  /// The offset that leaves least within `reach` of `start`.
  double minimise(double start, double reach, std::size_t begin, std::size_t end, std::size_t stride,
                  double tolerance) const {
    const auto cost = [&](double offset) { return (*this)(offset, begin, end, stride); };
    double best = start, least = std::numeric_limits<double>::infinity();
    // The minimum is as narrow as the jump of friction at re-stick, over which the acceleration is smeared.
    const int steps = static_cast<int>(std::max(kFewestScanSteps, std::ceil(2 * reach / (kScanStep * width_))));
    for (int i = 0; i <= steps; ++i) {
      const double offset = start + reach * (2.0 * i / steps - 1);
      if (const double c = cost(offset); c < least) {
        least = c;
        best = offset;
      }
    }
    const double width = 4 * reach / steps;
    const int cuts = std::max(0, static_cast<int>(std::ceil(std::log(tolerance / width) / std::log(0.618))));
    return golden_section(cost, best - width / 2, best + width / 2, cuts).at;
  }

 private:
  double width_ = 0;  ///< over which the acceleration is taken, to either side [s]
  const std::vector<double>&friction_time_, &friction_, &velocity_time_;
  std::vector<Eigen::Vector3d> motion_;  ///< displacement from its mean, velocity from its mean, acceleration
};

/// Refuses records of different runs. width: within which events coincide [s]; unbalanced: of the variance of friction;
/// ambiguity: the same over that of the next best offset.
void refuse_strangers(const std::vector<double>& falls, const std::vector<double>& jumps, double offset, double width,
                      double unbalanced, double ambiguity) {
  const auto within = [&](const std::vector<double>& events, double from, double to) {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [&](double t) { return t >= from && t <= to; }));
  };
  const double from = std::max(falls.front(), jumps.front() + offset),
               to = std::min(falls.back(), jumps.back() + offset);
  std::size_t matched = 0, shared = 0;
  for (const double jump : jumps) {
    const double at = jump + offset;
    if (at < from || at > to) continue;
    ++shared;
    matched += within(falls, at - width, at + width) > 0 ? 1U : 0U;
  }
  const bool belong = static_cast<double>(matched) >= kFewestMatched * static_cast<double>(shared) && shared > 1;
  const bool balances = unbalanced < kMostUnbalanced && (unbalanced < kBalanced || ambiguity < kAmbiguous);
  if (belong && balances) return;
  throw InputError(
      fmt::format("the two records are not of one run: {} of {} break-aways coincide, and the motion leaves "
                  "{:.0f} % of friction unbalanced",
                  matched, shared, 100 * unbalanced),
      "give the two files of one run");
}

/// Times at which friction falls and at which the velocity leaves its plateau.
struct BreakAways {
  std::vector<double> falls, jumps;
};

BreakAways find_break_aways(const std::vector<double>& friction_time, const std::vector<double>& friction,
                            const std::vector<double>& velocity_time, const std::vector<double>& velocity) {
  const double low = quantile(thinned(friction, kEnough), kEndsOfFriction),
               high = quantile(thinned(friction, kEnough), 1 - kEndsOfFriction);
  const Plateau plateau = find_plateau(velocity);
  if (!(high > low) || !(plateau.reach > 0)) return {};
  BreakAways out;
  out.falls = upward_crossings(
      friction_time, [&](std::size_t i) { return -friction[i]; }, -(low + kFallFrom * (high - low)),
      -(low + kFallTo * (high - low)));
  out.jumps = upward_crossings(
      velocity_time, [&](std::size_t i) { return std::abs(velocity[i] - plateau.velocity); }, kRiseFrom * plateau.reach,
      kRiseTo * plateau.reach);
  for (std::vector<double>* events : {&out.falls, &out.jumps})
    events->resize(std::min(events->size(), kMostBreakAways));
  return out;
}

/// The offset of a candidate that leaves least of friction for the events that it matches.
struct BestOffset {
  double offset = 0;
  Candidate candidate;
  double ambiguity = 0;  ///< what it leaves over what the next best one does
};

BestOffset best_offset(const std::vector<Candidate>& candidates, const ForceBalance& unbalanced, double reach,
                       std::size_t n, double tolerance) {
  const std::size_t coarse = std::max<std::size_t>(1, n / kScanned);
  BestOffset best;
  double least = std::numeric_limits<double>::infinity(), second = least;
  for (const Candidate& candidate : candidates) {
    const double offset = unbalanced.minimise(candidate.offset, reach, 0, n, coarse, tolerance);
    const double cost = unbalanced(offset, 0, n, coarse) / static_cast<double>(candidate.support);
    second = std::min(second, std::max(least, cost));
    if (!(cost < least)) continue;
    least = cost;
    best.offset = offset;
    best.candidate = candidate;
  }
  best.ambiguity = least / second;
  return best;
}

/// The same offset from contiguous parts: their spread is what wanders from cycle to cycle.
double uncertainty_of(double offset, const ForceBalance& unbalanced, std::size_t n, std::size_t stride,
                      double interval) {
  constexpr std::size_t parts = kPartsOfRecord;
  double squares = 0;
  for (std::size_t i = 0; i < parts; ++i) {
    const double part = unbalanced.minimise(offset, kSearchReachOfPart * interval, i * n / parts, (i + 1) * n / parts,
                                            stride, kFoundInPart * interval);
    squares += (part - offset) * (part - offset);
  }
  return std::sqrt(squares / (parts * (parts - 1.0)));
}

}  // namespace
}  // namespace tribofit::kinematics

namespace tribofit {

ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity) {
  using namespace kinematics;
  const auto [falls, jumps] = find_break_aways(friction_time, friction, velocity_time, velocity);
  if (std::min(falls.size(), jumps.size()) < kFewestBreakAways) return {};
  const double interval = std::max(typical_interval(friction_time), typical_interval(velocity_time));
  // Friction falls twice a cycle, at break-away and again at re-stick.
  const double period = median_interval(jumps);
  const double width = std::max(kCoincideSamples * interval, kCoincidePart * period);
  auto candidates = coincidences(falls, jumps, width, kOffsetsApart * period);
  // Instruments started by one trigger share their clock.
  if (!candidates.empty()) candidates.push_back({0, candidates.front().support});

  const ForceBalance unbalanced(friction_time, friction, velocity_time, velocity);
  const std::size_t n = friction.size();
  // Either of these may have been matched, and both lag behind the jump.
  const double reach = std::max(kReachSamples * interval, kReachPart * period);
  const BestOffset best = best_offset(candidates, unbalanced, reach, n, kFoundInScan * interval);
  const std::size_t coarse = std::max<std::size_t>(1, n / kScanned), fine = std::max<std::size_t>(1, n / kSearched);
  refuse_strangers(falls, jumps, best.candidate.offset, width, unbalanced(best.offset, 0, n, coarse), best.ambiguity);
  ClockOffset result;
  result.events = best.candidate.support;
  result.ambiguity = candidates.size() > 1 ? best.ambiguity : 0;
  result.offset = unbalanced.minimise(best.offset, kSearchReach * interval, 0, n, fine, kFound * interval);
  result.uncertainty = uncertainty_of(result.offset, unbalanced, n, fine, interval);
  return result;
}

}  // namespace tribofit
