#include "clock_scan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit::kinematics {
namespace {

/// Sums from the first sample on: of a stretch by one subtraction.
class RunningSum {
 public:
  explicit RunningSum(std::size_t n) { sums_.reserve(n + 1), sums_.push_back(0); }
  void add(double x) { sums_.push_back(sums_.back() + x); }
  double over(std::size_t begin, std::size_t end) const { return sums_[end] - sums_[begin]; }

 private:
  std::vector<double> sums_;
};

/// What friction leaves unbalanced at every lag of whole bins, from sums.
class LagScan {
 public:
  LagScan(const std::vector<double>& friction, const std::vector<BlockMotion>& motion)
      : friction_size_(friction.size()), motion_size_(motion.size()) {
    const std::size_t n = motion.size();
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<double> one(n);
      for (std::size_t i = 0; i < n; ++i) one[i] = motion[i][k];
      motion_.push_back(moments(one, one));
      cross_.push_back(products_at_every_lag(friction, one));
      for (std::size_t j = k + 1; j < 3; ++j) {
        mixed_.emplace_back(n);
        for (const BlockMotion& m : motion) mixed_.back().add(m[k] * m[j]);
      }
    }
    friction_.push_back(moments(friction, friction));
  }

  std::size_t lags() const { return friction_size_ + motion_size_ - 1; }
  /// Friction's bins [first, second) lie in the motion at lag number k.
  std::pair<std::size_t, std::size_t> shared(std::size_t k) const {
    const std::size_t behind = motion_size_ - 1;
    return {k > behind ? k - behind : 0, std::min(friction_size_, k + 1)};
  }

  double unbalanced(std::size_t k) const {
    const auto [begin, end] = shared(k);
    const std::size_t begin_motion = begin + motion_size_ - 1 - k, end_motion = begin_motion + (end - begin);
    const auto n = static_cast<double>(end - begin);
    const double squares = n * (n * n - 1) / 12;
    // Products with the straight line taken off, in the order displacement, velocity, acceleration, friction.
    std::array<double, 4> sum{}, slope{};
    std::array<std::array<double, 4>, 4> sums{};
    for (std::size_t a = 0; a < 4; ++a) {
      const Moments& m = a < 3 ? motion_[a] : friction_[0];
      const std::size_t from = a < 3 ? begin_motion : begin, to = a < 3 ? end_motion : end;
      sum[a] = m.values.over(from, to);
      slope[a] = m.times.over(from, to) - (static_cast<double>(from) + 0.5 * (n - 1)) * sum[a];
      sums[a][a] = m.squares.over(from, to);
      if (a < 3) sums[a][3] = cross_[a][k];
    }
    sums[0][1] = mixed_[0].over(begin_motion, end_motion);
    sums[0][2] = mixed_[1].over(begin_motion, end_motion);
    sums[1][2] = mixed_[2].over(begin_motion, end_motion);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a; b < 4; ++b) sums[a][b] -= sum[a] * sum[b] / n + slope[a] * slope[b] / squares;
    }
    return part_left(sums, 0);
  }

 private:
  struct Moments {
    RunningSum values, times, squares;
  };
  static Moments moments(const std::vector<double>& x, const std::vector<double>& y) {
    Moments out{RunningSum(x.size()), RunningSum(x.size()), RunningSum(x.size())};
    for (std::size_t i = 0; i < x.size(); ++i) {
      out.values.add(x[i]);
      out.times.add(static_cast<double>(i) * x[i]);
      out.squares.add(x[i] * y[i]);
    }
    return out;
  }

  std::size_t friction_size_, motion_size_;
  std::vector<Moments> motion_, friction_;
  std::vector<RunningSum> mixed_;  ///< products of 0 and 1, 0 and 2, 1 and 2
  std::vector<std::vector<double>> cross_;
};

/// Lags that leave least of their neighbourhood.
std::vector<std::size_t> lowest_of(const std::vector<double>& left, std::size_t apart) {
  std::vector<std::size_t> lowest;
  for (std::size_t k = 0; k < left.size(); ++k) {
    bool is_lowest = left[k] < 1;
    for (std::size_t beside = 1; is_lowest && beside <= apart; ++beside) {
      is_lowest =
          (beside > k || left[k - beside] > left[k]) && (k + beside >= left.size() || left[k + beside] >= left[k]);
    }
    if (is_lowest) lowest.push_back(k);
  }
  return lowest;
}

}  // namespace

TimedChannel binned(const TimedChannel& channel, double width) {
  const std::vector<double>&time = channel.time, &value = channel.value;
  const auto place = [&](double t) { return static_cast<std::size_t>((t - time.front()) / width + 0.5); };
  const std::size_t n = place(time.back()) + 1;
  std::vector<double> sums(n), counts(n);
  for (std::size_t i = 0; i < time.size(); ++i) sums[place(time[i])] += value[i], counts[place(time[i])] += 1;
  TimedChannel out;
  std::size_t last = 0;  // the last bin with a sample; the first and the last one have some
  for (std::size_t k = 0; k < n; ++k) {
    out.time.push_back(time.front() + static_cast<double>(k) * width);
    out.value.push_back(counts[k] > 0 ? sums[k] / counts[k] : 0);
    if (!(counts[k] > 0)) continue;
    for (std::size_t gap = last + 1; gap < k; ++gap) {
      const double part = static_cast<double>(gap - last) / static_cast<double>(k - last);
      out.value[gap] = out.value[last] + part * (out.value[k] - out.value[last]);
    }
    last = k;
  }
  return out;
}

double evidence_of(double unbalanced, double usual, std::size_t cycles) {
  const auto count = static_cast<double>(cycles);
  const double free = std::max(0.0, count - kCyclesFitted) / (1 + count / kCyclesAlike);
  return free * std::log(usual / std::max(unbalanced, 1e-12));
}

ClockScan scan_clocks(const ScannedChannels& channels, std::size_t from, std::size_t to) {
  const TimedChannel &friction = channels.friction, &velocity = channels.velocity;
  const std::vector<double>& jumps = channels.jumps;
  const double width = channels.width, period = channels.period;
  std::vector<double> deviation(friction.value.begin() + static_cast<std::ptrdiff_t>(from),
                                friction.value.begin() + static_cast<std::ptrdiff_t>(to));
  const double level = mean_of(deviation);
  for (double& f : deviation) f -= level;
  const LagScan scan(deviation, block_motion(velocity, 1));
  const auto match_at = [&](std::size_t k) {
    const auto [begin, end] = scan.shared(k);
    const double lag = static_cast<double>(k) - static_cast<double>(velocity.time.size() - 1);
    ClockMatch match;
    match.from = friction.time[from + begin], match.to = friction.time[from + end - 1];
    match.clock = {friction.time[from] - velocity.time.front() + lag * width, 0, 0.5 * (match.from + match.to)};
    match.cycles =
        static_cast<std::size_t>(std::upper_bound(jumps.begin(), jumps.end(), match.to - match.clock.offset) -
                                 std::lower_bound(jumps.begin(), jumps.end(), match.from - match.clock.offset));
    return match;
  };
  std::vector<double> left(scan.lags(), 1);
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (match_at(k).cycles >= kFewestShared) left[k] = scan.unbalanced(k);
  }
  ClockScan found;
  std::vector<double> lowest;
  for (const std::size_t k : lowest_of(left, static_cast<std::size_t>(kOffsetsApart * period / width))) {
    found.best.push_back(match_at(k));
    found.best.back().unbalanced = left[k];
    lowest.push_back(left[k]);
  }
  if (lowest.empty()) return found;
  // Most of them are wrong, and say what a wrong one leaves.
  found.usual = median(std::move(lowest));
  for (ClockMatch& m : found.best) m.evidence = evidence_of(m.unbalanced, found.usual, m.cycles);
  std::stable_sort(found.best.begin(), found.best.end(),
                   [](const ClockMatch& a, const ClockMatch& b) { return a.evidence > b.evidence; });
  found.best.resize(std::min(found.best.size(), kMostOffsets));
  return found;
}

}  // namespace tribofit::kinematics
