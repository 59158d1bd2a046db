#include "undo_low_pass.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Friction in a stick from re-stick on.
struct Tail {
  std::span<const double> friction;
  double first = 0;   ///< time of its first sample after re-stick [samples]
  double before = 0;  ///< friction at re-stick, as the slip before went on
};

/// The straight line of the spring and what decays on it.
struct Decay {
  double squares = 0;  ///< that are left
  double early = 0;    ///< of these, those within the decay
  double line = 0, size = 0;
};

/// Samples in which a decay is gone: a thousandth is left.
double gone_after(double tau) {
  return 7 * tau;
}

Decay fit_decay(const Tail& tail, double tau) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const double scale = 1 / static_cast<double>(tail.friction.size());
  std::vector<double> left(tail.friction.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = std::exp(-(tail.first + static_cast<double>(i)) / tau);
  const auto row = [&](std::size_t i) {
    return Eigen::Vector3d(1, (tail.first + static_cast<double>(i)) * scale, left[i]);
  };
  for (std::size_t i = 0; i < tail.friction.size(); ++i) {
    const Eigen::Vector3d x = row(i);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l <= k; ++l) normal(k, l) += x[k] * x[l];
      right[k] += x[k] * tail.friction[i];
    }
  }
  const Eigen::Vector3d c = normal.ldlt().solve(right);
  Decay decay{0, 0, c[0], c[2]};
  for (std::size_t i = 0; i < tail.friction.size(); ++i) {
    const double square = std::pow(tail.friction[i] - row(i).dot(c), 2);
    decay.squares += square;
    if (tail.first + static_cast<double>(i) < gone_after(tau)) decay.early += square;
  }
  return decay;
}

/// The tails of some slips: a part of the time to the next re-stick, the same for all.
std::vector<Tail> tails_of(std::span<const double> friction, const std::vector<double>& resticks) {
  std::vector<double> periods;
  for (std::size_t k = 1; k < resticks.size(); ++k) periods.push_back(resticks[k] - resticks[k - 1]);
  std::vector<Tail> tails;
  if (periods.size() < kFewestPeriods) return tails;
  const auto length = static_cast<std::size_t>(kTailPart * median(std::move(periods)));
  if (length < kTailSamples) return tails;
  const std::size_t every = std::max<std::size_t>(1, resticks.size() / kRestickSlips);
  for (std::size_t k = 0; k < resticks.size(); k += every) {
    const double place = std::max(resticks[k], 0.0);
    const auto first = static_cast<std::size_t>(std::ceil(place + kTailGap));
    const auto last = static_cast<std::size_t>(std::floor(std::max(place - kTailGap, 0.0)));  // of the slip
    if (last + 1 < kTailBefore || first + length >= friction.size()) continue;
    const std::size_t begin = last + 1 - kTailBefore;
    const double before = fit_line(friction.subspan(begin, kTailBefore)).at(place - static_cast<double>(begin));
    tails.push_back({friction.subspan(first, length), static_cast<double>(first) - place, before});
  }
  return tails;
}

double squares_left(const std::vector<Tail>& tails, double tau, int threads = 1) {
  std::vector<double> squares(tails.size());
  run_tasks(tails.size(), threads, [&](std::size_t k) { squares[k] = fit_decay(tails[k], tau).squares; });
  return std::accumulate(squares.begin(), squares.end(), 0.0);
}

/// What decays at a time constant: where it begins before re-stick [samples]; whether the reading goes on from where it
/// was, falls by most of the jump, after every slip by about as much, and nothing but noise is left beside it.
struct Evidence {
  double early = 0;
  bool is_first_order = false;
};

Evidence evidence_of(const std::vector<Tail>& tails, double tau) {
  double early = 0, late = 0, samples_early = 0, samples_late = 0, decays = 0;
  std::vector<double> sizes, onsets, falls;
  for (const Tail& tail : tails) {
    const Decay decay = fit_decay(tail, tau);
    const double jump = tail.before - decay.line,
                 samples = std::min(gone_after(tau), static_cast<double>(tail.friction.size()));
    sizes.push_back(decay.size / jump);
    falls.push_back(std::copysign(1.0, tail.before) * decay.size);
    onsets.push_back(tau * std::log(std::max(1e-6, jump / decay.size)));
    early += decay.early, late += decay.squares - decay.early;
    decays += decay.size * decay.size / static_cast<double>(tails.size());
    samples_early += samples, samples_late += static_cast<double>(tail.friction.size()) - samples;
  }
  const double size = median(std::move(sizes)), onset = median(std::move(onsets));
  const double fall = median(falls), spread = kSigmaPerMad * median_absolute_deviation(falls, fall);
  const double noise = late / std::max(1.0, samples_late);
  const bool holds = size > kTailSize && fall > kTailAlike * spread &&
                     std::abs(onset) < kTailOnset + kTailOnsetPart * tau &&
                     early / samples_early < kTailLeft * noise + kTailModel * kTailModel * decays;
  return {onset, holds};
}

/// From a tenth to nine tenths of the jump at re-stick, of the mean over the slips [samples]; 0: less than kDrawnOut,
/// or noise hides it.
double fall_at_restick(const std::vector<Tail>& tails) {
  const std::size_t length = tails.front().friction.size(), half = length / 2;
  std::vector<double> left(length, 0);  // of the jump
  for (const Tail& tail : tails) {
    const StraightLine line = fit_line(tail.friction.subspan(half));
    for (std::size_t i = 0; i < length; ++i) {
      const double after = line.at(static_cast<double>(i) - static_cast<double>(half));
      left[i] += (tail.friction[i] - after) / (tail.before - after) / static_cast<double>(tails.size());
    }
  }
  double noise = 0;
  for (std::size_t i = half; i < length; ++i) noise = std::max(noise, std::abs(left[i]));
  if (!(noise < kDrawnNoise)) return 0;
  std::size_t from = 0, to = length;
  while (to > 0 && left[to - 1] < 0.1) --to;
  while (from < to && left[from] > 0.9) ++from;
  const auto fall = static_cast<double>(to - from);
  return fall > kDrawnOut ? fall : 0;
}

}  // namespace

std::size_t undo_low_pass(std::span<double> velocity, double tau, double step, double noise, double fastest) {
  const auto noise_of = [&](std::size_t half) {
    const auto h = static_cast<double>(half);
    return noise * tau / step * std::sqrt(3 / (h * (h + 1) * (2 * h + 1)));
  };
  const double allowed = std::max(noise, kRestoredNoise * fastest);
  std::size_t half = 1;
  while (noise_of(half) > allowed && static_cast<double>(half + 1) * step < kRestoredSmear * tau) ++half;
  const std::vector<double> slope = savitzky_golay_slope(velocity, step, half);
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] += tau * slope[i];
  return half;
}

FrictionLowPass find_friction_low_pass(std::span<const double> friction, const std::vector<double>& resticks,
                                       double step, int threads) {
  const std::vector<Tail> tails = tails_of(friction, resticks);
  if (tails.size() < kFewestPeriods) return {};
  double best = 0, least = std::numeric_limits<double>::infinity();
  const double longest = kTailDecay * static_cast<double>(tails.front().friction.size());
  std::vector<double> tried;
  for (double tau = kTailFirst; tau < longest; tau *= kRestickNext) tried.push_back(tau);
  std::vector<double> left(tried.size());
  run_tasks(tried.size(), threads, [&](std::size_t k) { left[k] = squares_left(tails, tried[k]); });
  for (std::size_t k = 0; k < tried.size(); ++k) {
    if (left[k] < least) least = left[k], best = tried[k];
  }
  const auto refined = [&](const auto& squares) {
    return boost::math::tools::brent_find_minima(squares, best / kRestickNext, best * kRestickNext, kBitsOfSearch)
        .first;
  };
  const double tau = refined([&](double t) { return squares_left(tails, t, threads); });
  const Evidence evidence = evidence_of(tails, tau);
  if (best == kTailFirst || !evidence.is_first_order) return {true, {}, 0, fall_at_restick(tails) * step};
  std::vector<double> taus(tails.size());
  run_tasks(tails.size(), threads,
            [&](std::size_t k) { taus[k] = refined([&](double t) { return fit_decay(tails[k], t).squares; }); });
  const double scatter = kSigmaPerMad * median_absolute_deviation(taus, median(taus));
  return {true, {tau * step, scatter / std::sqrt(static_cast<double>(taus.size())) * step}, evidence.early};
}

}  // namespace tribofit::kinematics
