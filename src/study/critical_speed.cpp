#include "tribofit/study/critical_speed.hpp"
#include "limits.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

namespace {

Machine at(const Machine& machine, double velocity) {
  return with_value(machine, "velocity", velocity);
}

/// Where `yes` turns, between two speeds of which one holds and the other does not.
double turning_of(const std::function<bool(double)>& yes, double low, double high, double tolerance) {
  const bool at_low = yes(low);
  while (high - low > tolerance * high) {
    const double middle = std::sqrt(low * high);
    if (!(middle > low && middle < high)) break;
    (yes(middle) == at_low ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The highest of speeds in equal ratios at which `yes` holds, and the next above it: {0, lowest} where it does at
/// none.
std::pair<double, double> highest_where(const std::function<bool(double)>& yes, double low, double high) {
  double above = high;
  for (int i = kSpeedsOfStick - 1; i >= 0; --i) {
    const double now = i == 0 ? low : low * std::pow(high / low, static_cast<double>(i) / kSpeedsOfStick);
    if (yes(now)) return {now, above};
    above = now;
  }
  return {0, low};
}

class Search {
 public:
  Search(const Machine& machine, const CriticalSpeedOptions& options) : machine_(machine), options_(options) {}

  CriticalSpeed run() {
    set_range();
    out_.linear = changes_of_stability();
    out_.stable_at_highest = is_stable(out_.highest);
    out_.above_range = sticks(out_.highest);
    if (out_.above_range) return out_;
    const auto sticks_at = [&](double v) { return sticks(v); };
    double low = out_.lowest, high = out_.highest;
    if (!sticks(low)) std::tie(low, high) = highest_where(sticks_at, low, high);
    out_.below_range = low == 0;
    if (out_.below_range) return out_;
    out_.stick_vanishes = turning_of(sticks_at, low, high, options_.tolerance);
    out_.stick_returns = way_down();
    return out_;
  }

 private:
  bool sticks(double velocity) const { return keeps_sticking(at(machine_, velocity), options_.sharpness); }
  bool is_stable(double velocity) const { return steady_sliding(at(machine_, velocity)).is_stable(); }
  /// Sliding is unstable, and vibration of any size grows until it sticks: none without a stick lies between.
  bool returns(double velocity) const {
    if (is_stable(velocity)) return false;
    const Machine machine = at(machine_, velocity);
    for (const double part : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Swings swings = swings_from(machine, part * velocity, kPeriodsOfGrowth);
      if (swings.sticks) continue;
      const std::size_t n = swings.sizes.size();
      if (n < 4 || swings.sizes[n - 1] <= swings.sizes[n - 3]) return false;
    }
    return true;
  }

  void set_range() {
    const double own = machine_.disc_velocity();
    out_.lowest = options_.lowest > 0 ? options_.lowest : 0.01 * own;
    out_.highest = options_.highest;
    if (out_.highest == 0) {
      out_.highest = std::max(own, 2 * out_.lowest);
      while (out_.highest < kMostSpeed * own && (!is_stable(out_.highest) || sticks(out_.highest)))
        out_.highest *= kSpeedStep;
    }
    if (!(out_.lowest > 0 && out_.highest > out_.lowest && std::isfinite(out_.highest))) {
      throw InputError("the speed range is empty", "give a lowest speed above zero and a highest above it");
    }
  }

  std::vector<double> changes_of_stability() const {
    std::vector<double> changes;
    double before = out_.lowest;
    bool stable = is_stable(before);
    for (int i = 1; i <= kSpeedsOfStability; ++i) {
      const double now =
          out_.lowest * std::pow(out_.highest / out_.lowest, static_cast<double>(i) / kSpeedsOfStability);
      if (is_stable(now) != stable) {
        changes.push_back(turning_of([&](double v) { return is_stable(v); }, before, now, 1e-10));
        stable = !stable;
      }
      before = now;
    }
    return changes;
  }

  /// Stick-slip comes back at the latest where sliding, on the way down, has lost its stability.
  double way_down() const {
    if (out_.linear.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double lost = out_.linear.back();
    const double begin = lost * (1 - kBelowTheLoss);
    if (begin <= out_.lowest || is_stable(begin)) return std::numeric_limits<double>::quiet_NaN();
    if (returns(begin)) return lost;
    const auto returns_at = [&](double v) { return returns(v); };
    double low = out_.lowest, high = begin;
    if (!returns(low)) std::tie(low, high) = highest_where(returns_at, low, high);
    return low > 0 ? turning_of(returns_at, low, high, options_.tolerance) : std::numeric_limits<double>::quiet_NaN();
  }

  const Machine& machine_;
  const CriticalSpeedOptions& options_;
  CriticalSpeed out_;
};

}  // namespace

CriticalSpeed critical_speed(const Machine& machine, const CriticalSpeedOptions& options) {
  return Search(machine, options).run();
}

}  // namespace tribofit
