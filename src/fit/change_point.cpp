#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// What slips leave, whitened, when the change comes at one time or another. It touches the slips beside it alone:
/// those further away are looked at once, before the change and after it.
class ChangeInTime {
 public:
  ChangeInTime(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
               std::vector<double> p)
      : point_(point), residuals_(residuals), p_(std::move(p)), order_(observations.slips.size()) {
    const auto& slips = observations.slips;
    std::iota(order_.begin(), order_.end(), std::size_t(0));
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return observations.time[slips[a].begin] < observations.time[slips[b].begin];
    });
    if (!look_before_and_after(observations)) return;
    const std::vector<double> before = residuals.squares_of(before_), after = residuals.squares_of(after_);
    squares = {std::accumulate(after.begin(), after.end(), 0.0)};
    for (const std::size_t k : order_) {
      begin.push_back(observations.time[slips[k].begin]);
      end.push_back(observations.time[slips[k].end - 1]);
      squares.push_back(squares.back() + before[k] - after[k]);
    }
  }

  std::vector<double> begin, end;  ///< of each slip, in order of time [s]; empty where the model is not finite
  std::vector<double> squares;     ///< of all slips when the change comes just before each, or after the last

  /// Squares of all slips; several threads may ask.
  double squares_at(double time) const {
    const auto next = std::upper_bound(begin.begin(), begin.end(), time) - begin.begin();
    std::vector<Eigen::MatrixXd> blocks = after_;
    const ModelResiduals residuals = residuals_;  // formulas must not be shared between threads
    const std::vector<double> p = with_change_at(time);
    for (std::ptrdiff_t i = 0; i < std::min(next + kSlipsTouched, std::ssize(order_)); ++i) {
      const std::size_t k = order_[static_cast<std::size_t>(i)];
      blocks[k] = i < next - kSlipsTouched ? before_[k] : residuals.residual_block(k, p.data());
      if (blocks[k].size() == 0) return std::numeric_limits<double>::infinity();
    }
    const std::vector<double> left = residuals.squares_of(blocks);
    return std::accumulate(left.begin(), left.end(), 0.0);
  }

  std::vector<double> squares_at(const std::vector<double>& times, int threads) const {
    std::vector<double> out(times.size());
    run_tasks(times.size(), threads, [&](std::size_t k) { out[k] = squares_at(times[k]); });
    return out;
  }

 private:
  std::vector<double> with_change_at(double time) const {
    std::vector<double> p = p_;
    p[point_.time] = time;
    return p;
  }

  /// Sets what slips leave before the change and after it; false where the model is not finite. Slips that are far from
  /// where the change is now are on one side of it, which may be known: they are looked at on the other side alone.
  bool look_before_and_after(const Observations& observations) {
    constexpr double kFar = 1e6;  // [s], far from any record
    before_ = residuals_.residual_blocks(p_.data());
    if (before_.empty()) return false;
    after_ = before_;
    const auto begin_of = [&](std::size_t k) { return observations.time[observations.slips[k].begin]; };
    const auto end_of = [&](std::size_t k) { return observations.time[observations.slips[k].end - 1]; };
    double records = 1;
    for (const auto& slip : observations.slips) records = std::max(records, 1.0 + static_cast<double>(slip.record));
    const double cycle =
        (begin_of(order_.back()) - begin_of(order_.front())) * records / static_cast<double>(order_.size());
    const double now = p_[point_.time], near = kTimeTouched * std::abs(now) + kSlipsTouched * cycle;
    std::vector<std::size_t> not_after, not_before;
    for (const std::size_t k : order_) {
      if (begin_of(k) <= now + near) not_after.push_back(k);
      if (end_of(k) >= now - near) not_before.push_back(k);
    }
    return look_at(not_after, -kFar, after_) && look_at(not_before, kFar, before_);
  }
  bool look_at(const std::vector<std::size_t>& slips, double time, std::vector<Eigen::MatrixXd>& out) const {
    std::vector<Eigen::MatrixXd> blocks = residuals_.of_slips(slips).residual_blocks(with_change_at(time).data());
    if (blocks.size() < slips.size()) return false;
    for (std::size_t k = 0; k < slips.size(); ++k) out[slips[k]] = std::move(blocks[k]);
    return true;
  }

  const ChangePoint& point_;
  const ModelResiduals& residuals_;
  std::vector<double> p_;
  std::vector<std::size_t> order_;               ///< of the slips in time
  std::vector<Eigen::MatrixXd> before_, after_;  ///< of each slip, when the change comes after it and before it
};

}  // namespace

std::optional<ChangePoint> change_point_of(const FrictionModel& model) {
  const auto& parameters = model.parameters();
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    if (parameters[k].parameter.search == ParameterSearch::moment_of_change) return ChangePoint{k, k - 1};
  }
  return std::nullopt;
}

double best_change(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
                   const Bounds& bounds, std::vector<double> p, int threads) {
  const double now = p[point.time], lower = bounds.lower[point.time], upper = bounds.upper[point.time];
  if (!(lower < upper)) return now;
  const ChangeInTime scan(point, residuals, observations, std::move(p));
  if (scan.begin.size() < 2) return now;
  // Not before the first slip nor after the last: that is no change.
  const auto least = std::min_element(scan.squares.begin() + 1, scan.squares.end() - 1);
  const auto k = static_cast<std::size_t>(least - scan.squares.begin());  // before slip k
  double best = std::clamp(0.5 * (scan.end[k - 1] + scan.begin[k]), lower, upper);
  double best_squares = std::numeric_limits<double>::infinity();
  const auto try_times = [&](std::vector<double> times) {
    std::erase_if(times, [&](double time) { return time < lower || time > upper; });
    const std::vector<double> squares = scan.squares_at(times, threads);
    for (std::size_t t = 0; t < times.size(); ++t) {
      if (squares[t] < best_squares) best = times[t], best_squares = squares[t];
    }
  };
  constexpr int kParts = 8;
  double step = 0;
  std::vector<double> first = {best, now};
  for (const std::size_t slip : {k - 1, k}) {
    step = (scan.end[slip] - scan.begin[slip]) / kParts;
    for (int part = 0; part < kParts; ++part) first.push_back(scan.begin[slip] + (part + 0.5) * step);
  }
  try_times(std::move(first));
  for (int halving = 0; halving < 6; ++halving) {
    step /= 2;
    try_times({best - step, best + step});
  }
  return best;
}

std::pair<double, double> interval_of_change(const ChangePoint& point, const ModelResiduals& residuals,
                                             const Observations& observations, const CycleEvidence& evidence,
                                             const Bounds& bounds, std::vector<double> p, int threads) {
  const double best = p[point.time];
  const auto size = static_cast<Eigen::Index>(point.size);
  double spread = 0, known = 0;
  for (std::size_t c = 0; c < evidence.curvature.size(); ++c) {
    spread += std::pow(evidence.gradient[c](size), 2);
    known += evidence.curvature[c](size, size);
  }
  const ChangeInTime scan(point, residuals, observations, std::move(p));
  if (scan.squares.empty()) return {bounds.lower[point.time], bounds.upper[point.time]};
  double least = scan.squares_at(best);
  for (std::size_t k = 1; k + 1 < scan.squares.size(); ++k) least = std::min(least, scan.squares[k]);
  const double limit = least + kChangePointRise95 * (known > 0 ? spread / known : 0);
  const auto inside = [&](double time) { return scan.squares_at(time) < limit; };
  // Between the slip before which the change would leave too much and the next lies the wall.
  const auto wall = [&](double in, double out) {
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (in + out);
      (inside(middle) ? in : out) = middle;
    }
    return out;
  };
  // The change may come just before any slip from `first` to `last`; or else within the slip that holds the best.
  const std::size_t slips = scan.begin.size();
  std::size_t first = 0, last = slips;
  while (first < slips && scan.squares[first] >= limit) ++first;
  while (last > 0 && scan.squares[last] >= limit) --last;
  std::size_t before = 0, after = slips;  // walls: slips that begin before, or end after all that is possible
  const double earliest = first < slips ? std::min(best, scan.begin[first]) : best;
  const double latest = last > 0 ? std::max(best, scan.end[last - 1]) : best;
  while (before < slips && scan.begin[before] < earliest) ++before;
  while (after > 0 && scan.end[after - 1] > latest) --after;
  double lower = bounds.lower[point.time], upper = bounds.upper[point.time];
  run_tasks(2, threads, [&](std::size_t side) {
    if (side == 0 && before > 0) lower = wall(earliest, scan.begin[before - 1]);
    if (side == 1 && after < slips) upper = wall(latest, scan.end[after]);
  });
  return {lower, upper};
}

void find_change(FitContext& context, const ChangePoint& change, Bounds& held, std::vector<double>& p) {
  // Slips at levels of their own would hide a change that is misplaced.
  const ModelResiduals residuals = context.residuals(all_slips(context.observations), false);
  p[change.time] = best_change(change, residuals, context.observations, context.bounds, p, context.evaluation.threads);
  held.lower[change.time] = held.upper[change.time] = p[change.time];
}

}  // namespace tribofit
