#include "wandering_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limits.hpp"
#include "linear_algebra.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Whitened cross products of the columns of all that was observed, own values of the stretches taken out.
class Likelihood {
 public:
  Likelihood(const NoisySeries& series, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
             const Eigen::MatrixXd& own)
      : series_(series), shared_(jacobian.cols()), own_(own.cols()) {
    columns_.resize(shared_ + 1 + own_, residual.size());  // one value a column: they are passed in this order
    columns_.topRows(shared_) = jacobian.transpose();
    columns_.row(shared_) = residual.transpose();
    columns_.bottomRows(own_) = own.transpose();
  }

  /// Minus twice the logarithm of the restricted likelihood at a ratio of the variances, slow over white; white: the
  /// standard deviation that makes it least; squares: what is left over the white variance of one.
  double operator()(double ratio, double time, double& white, double* squares_left = nullptr) const {
    stop_point();
    const Eigen::Index all = columns_.rows(), free = shared_ + 1;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(free, free), part(all, all);
    Eigen::VectorXd state(all), innovation(all);
    double logs = 0;
    Eigen::Index parameters = shared_, values = columns_.cols();
    for (std::size_t s = 0; s < series_.stretch_begins.size(); ++s) {
      const auto begin = static_cast<Eigen::Index>(series_.stretch_begins[s]),
                 end = static_cast<Eigen::Index>(series_.end_of(s));
      if (end - begin <= own_) {
        values -= end - begin;
        continue;
      }
      part.setZero();
      state.setZero();
      double variance = ratio;
      for (Eigen::Index i = begin; i < end; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (i > begin && ratio > 0) {
          const double decay = std::exp(-(series_.time[at] - series_.time[at - 1]) / time);
          state *= decay;
          variance = ratio + decay * decay * (variance - ratio);
        }
        const double total = variance + 1 / series_.count[at];
        innovation = columns_.col(i) - state;
        const double gain = variance / total;
        state += gain * innovation;
        variance *= 1 - gain;
        logs += std::log(total);
        part.selfadjointView<Eigen::Lower>().rankUpdate(innovation, 1 / total);
      }
      sum += part.topLeftCorner(free, free).triangularView<Eigen::Lower>().toDenseMatrix();
      if (own_ == 0) continue;
      const Eigen::MatrixXd corner = part.bottomRightCorner(own_, own_), cross = part.bottomLeftCorner(own_, free);
      logs += log_determinant(corner);
      sum -= (cross.transpose() * solve_symmetric(full(corner), cross)).triangularView<Eigen::Lower>().toDenseMatrix();
      parameters += own_;
    }
    double squares = sum(shared_, shared_);
    if (shared_ > 0) {
      const Eigen::MatrixXd normal = full(sum.topLeftCorner(shared_, shared_));
      const Eigen::MatrixXd right = sum.bottomLeftCorner(1, shared_).transpose();
      const Eigen::MatrixXd solved = solve_symmetric(normal, right);
      squares -= (right.transpose() * solved)(0, 0);
      logs += log_determinant(normal);
    }
    if (squares_left != nullptr) *squares_left = squares;
    const double freedom = static_cast<double>(values - parameters);
    if (!(freedom > 0) || !(squares > 0)) return std::numeric_limits<double>::infinity();
    white = std::sqrt(squares / freedom);
    return logs + freedom * std::log(squares / freedom);
  }

 private:
  static Eigen::MatrixXd full(const Eigen::MatrixXd& lower) { return lower.selfadjointView<Eigen::Lower>(); }
  static double log_determinant(const Eigen::MatrixXd& lower) {
    double sum = 0;
    for (const double value : symmetric_eigen(lower).values) sum += std::log(std::max(value, 1e-300));
    return sum;
  }

  const NoisySeries& series_;
  Eigen::Index shared_, own_;
  Eigen::MatrixXd columns_;
};

/// Shortest and longest time over which noise is asked to wander: neighbours, and a whole stretch.
std::array<double, 2> range_of_times(const NoisySeries& series) {
  std::vector<double> intervals;
  double longest = 0;
  for (std::size_t s = 0; s < series.stretch_begins.size(); ++s) {
    const std::size_t begin = series.stretch_begins[s], end = series.end_of(s);
    for (std::size_t i = begin + 1; i < end; ++i) intervals.push_back(series.time[i] - series.time[i - 1]);
    if (end > begin) longest = std::max(longest, series.time[end - 1] - series.time[begin]);
  }
  return {std::max(quantile(intervals, 0.05), longest * 1e-9), longest};
}

}  // namespace

WanderingNoise estimate_noise(const NoisySeries& series, const Eigen::VectorXd& residual,
                              const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& own) {
  const Likelihood likelihood(series, residual, jacobian, own);
  WanderingNoise best;
  const double alone = likelihood(0, 1, best.white);
  if (!std::isfinite(alone)) return best;
  const WanderingNoise only_white = best;
  const auto [shortest, longest] = range_of_times(series);
  const double low = std::log(shortest), high = std::log(longest);
  if (!(high > low)) return best;
  double least = alone, ratio_at = 0, time_at = 0, white = 0;
  const auto consider = [&](double log_ratio, double log_time) {
    if (log_time < low || log_time > high || std::abs(log_ratio) > kLargestNoiseRatio) return false;
    const double value = likelihood(std::exp(log_ratio), std::exp(log_time), white);
    if (!(value < least)) return false;
    least = value;
    ratio_at = log_ratio;
    time_at = log_time;
    best.white = white;
    return true;
  };
  constexpr int kTimes = 7;
  for (int i = 0; i < kTimes; ++i) {
    for (const double log_ratio : {-6.0, -4.0, -2.0, 0.0, 2.0, 5.0}) {
      consider(log_ratio, low + (high - low) * (i + 0.5) / kTimes);
    }
  }
  if (least == alone) return only_white;
  for (double step = 1; step > 0.03;) {
    const bool better = consider(ratio_at + step, time_at) || consider(ratio_at - step, time_at) ||
                        consider(ratio_at, time_at + step) || consider(ratio_at, time_at - step) ||
                        consider(ratio_at + step, time_at - step) || consider(ratio_at - step, time_at + step);
    if (!better) step *= 0.5;
  }
  if (0.5 * (alone - least) < 2 * kPriceOfParameter) return only_white;
  best.slow = best.white * std::exp(0.5 * ratio_at);
  best.time = std::exp(time_at);
  return best;
}

double whitened_squares(const NoisySeries& series, const Eigen::VectorXd& residual, const Eigen::MatrixXd& own,
                        const WanderingNoise& noise) {
  const Likelihood likelihood(series, residual, Eigen::MatrixXd(residual.size(), 0), own);
  const double ratio = noise.time > 0 ? noise.slow * noise.slow / (noise.white * noise.white) : 0;
  double white = 0, squares = 0;
  likelihood(ratio, noise.time > 0 ? noise.time : 1, white, &squares);
  return squares / (noise.white * noise.white);
}

NoiseMoments noise_moments(const NoisySeries& series, const Eigen::MatrixXd& weights, const WanderingNoise& noise) {
  const Eigen::Index n = weights.cols();
  NoiseMoments out = {Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  const double white = noise.white * noise.white, slow = noise.slow * noise.slow;
  Eigen::VectorXd carried(n);
  for (std::size_t s = 0; s < series.stretch_begins.size(); ++s) {
    const std::size_t begin = series.stretch_begins[s], end = series.end_of(s);
    carried.setZero();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::VectorXd row = weights.row(static_cast<Eigen::Index>(i)).transpose();
      out.white += white / series.count[i] * row * row.transpose();
      if (!(slow > 0)) continue;
      if (i > begin) carried *= std::exp(-(series.time[i] - series.time[i - 1]) / noise.time);
      const Eigen::MatrixXd cross = row * carried.transpose();
      out.slow += slow * (row * row.transpose() + cross + cross.transpose());
      carried += row;
    }
  }
  return out;
}

}  // namespace tribofit
