#include "force_balance.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "statistics/linear_algebra.hpp"
#include "statistics/low_pass.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kOrder = 3;         // of the B-spline: mean of mean of mean
constexpr double kKnotsPerPeriod = 16;    // its knots; three of them are its width
constexpr std::size_t kFewestRows = 8;    // of a block: two go with the straight line, up to four with the unknowns
constexpr std::size_t kMostPieces = 400;  // where nothing sticks

/// Integral from the first sample to each [unit of the signal times samples], interval by interval over the cubic
/// through four samples, the trapezoid at the ends.
std::vector<double> cumulative(const std::vector<double>& signal) {
  const std::size_t n = signal.size();
  std::vector<double> sum(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const double near = signal[i - 1] + signal[i];
    const bool inner = i >= 2 && i + 1 < n;
    sum[i] = sum[i - 1] + (inner ? (13 * near - signal[i - 2] - signal[i + 1]) / 24 : 0.5 * near);
  }
  return sum;
}

/// Means over every stretch of `h` intervals: the record is h samples shorter.
void running_mean(std::vector<double>& signal, std::size_t h) {
  const std::size_t n = signal.size() - h;
  const std::vector<double> sum = cumulative(signal);
  for (std::size_t i = 0; i < n; ++i) signal[i] = (sum[i + h] - sum[i]) / static_cast<double>(h);
  signal.resize(n);
}

/// The mean slope over every stretch of `h` intervals, which is the mean of the derivative.
void running_slope(std::vector<double>& signal, std::size_t h, double step) {
  const std::size_t n = signal.size() - h;
  for (std::size_t i = 0; i < n; ++i) signal[i] = (signal[i + h] - signal[i]) / (static_cast<double>(h) * step);
  signal.resize(n);
}

std::vector<double> integral_of(const std::vector<double>& signal, double step) {
  std::vector<double> out = cumulative(signal);
  for (double& x : out) x *= step;
  return out;
}

/// The signal, differentiated `slopes` times, under the test functions.
std::vector<double> weighted(std::vector<double> signal, std::size_t slopes, std::size_t h, double step) {
  for (std::size_t k = 0; k < slopes; ++k) running_slope(signal, h, step);
  for (std::size_t k = slopes; k < kOrder; ++k) running_mean(signal, h);
  return signal;
}

void take_off_mean(std::vector<double>& signal) {
  double sum = 0;
  for (const double x : signal) sum += x;
  for (double& x : signal) x -= sum / static_cast<double>(signal.size());
}

void take_off_line(Eigen::Ref<Eigen::MatrixXd> rows) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(rows.rows(), -1, 1);
  const double squares = t.squaredNorm();
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    const double mean = rows.col(k).mean(), slope = squares > 0 ? rows.col(k).dot(t) / squares : 0;
    rows.col(k).array() -= mean;
    rows.col(k) -= slope * t;
  }
}

/// Knot distance in samples for a free period.
std::size_t knots(double period, double step) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(period / step / kKnotsPerPeriod)));
}

std::size_t hop_of(std::size_t h) {
  return std::max<std::size_t>(1, h / 2);
}

Eigen::MatrixXd rows_of(const Motion& motion, const NormalForce& load, const SampleRange& span, std::size_t h) {
  std::vector<double> velocity(span.size()), force(span.size());
  for (std::size_t k = 0; k < span.size(); ++k) {
    const std::size_t i = span.begin + k;
    velocity[k] = motion.disc_velocity_at(i) - motion.relative_velocity[i];
    force[k] = load.at(i) * motion.friction[i];
  }
  // The balance is linear: behind a filter of friction it holds for the motion behind the same filter.
  if (motion.friction_low_pass.any()) low_pass(velocity, motion.step / motion.friction_low_pass.value);
  take_off_mean(velocity);  // a constant more in v_b is a straight line more in the balance
  take_off_mean(force);
  const double step = motion.step;
  std::vector<double> displacement = integral_of(velocity, step);
  take_off_mean(displacement);
  const std::vector<double> columns[kBalanceColumns] = {
      weighted(velocity, 1, h, step),     weighted(velocity, 0, h, step),
      weighted(displacement, 0, h, step), weighted(integral_of(displacement, step), 0, h, step),
      weighted(velocity, 2, h, step),     weighted(force, 0, h, step)};
  const std::size_t hop = hop_of(h), count = (columns[0].size() + hop - 1) / hop;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(count), Eigen::Index{kBalanceColumns});
  for (std::size_t c = 0; c < kBalanceColumns; ++c) {
    for (std::size_t r = 0; r < count; ++r) {
      rows(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = columns[c][r * hop];
    }
  }
  return rows;
}

/// Gathers the noise of a column from the sticks, where it is straight.
class StickNoise {
 public:
  void add(const Eigen::MatrixXd& rows, const SampleRange& block, std::size_t h,
           const std::vector<SampleRange>& sticks) {
    const std::size_t hop = hop_of(h);
    for (const SampleRange& stick : sticks) {
      const std::size_t begin = std::max(stick.begin, block.begin), end = std::min(stick.end, block.end);
      if (begin + kOrder * h >= end) continue;
      const std::size_t first = (begin - block.begin + hop - 1) / hop, last = (end - block.begin - kOrder * h) / hop;
      const std::size_t stop = std::min(last, static_cast<std::size_t>(rows.rows()));
      if (first + kFewestRows > stop) continue;
      Eigen::MatrixXd part = rows.middleRows(Eigen::Index(first), Eigen::Index(stop - first));
      take_off_line(part);
      products_ += part.transpose() * part;
      freedom_ += static_cast<double>(stop - first - 2);
    }
  }
  Eigen::MatrixXd covariance() const { return freedom_ > 0 ? Eigen::MatrixXd(products_ / freedom_) : 0 * products_; }

 private:
  Eigen::MatrixXd products_ = Eigen::MatrixXd::Zero(kBalanceColumns, kBalanceColumns);
  double freedom_ = 0;
};

/// Covariance that white noise on v_b leaves in velocity, acceleration and jerk: the B-spline's overlaps with itself
/// and its derivatives.
Eigen::MatrixXd white_noise(const Motion& motion, std::size_t h) {
  const double samples = static_cast<double>(h), knot = samples * motion.step;
  const double v = motion.velocity_noise * motion.velocity_noise / samples, per = 1 / (knot * knot);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kBalanceColumns, kBalanceColumns);
  out(kVelocity, kVelocity) = v * 11 / 20;
  out(kAcceleration, kAcceleration) = v * per;
  out(kJerk, kVelocity) = out(kVelocity, kJerk) = -v * per;
  out(kJerk, kJerk) = v * 6 * per * per;
  return out;
}

/// The sticks without their first and last tenths, where re-stick rings and break-away begins.
std::vector<SampleRange> quiet_sticks(const Segmentation& segmentation) {
  std::vector<SampleRange> out;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t tenth = cycle.stick.size() / 10;
    if (tenth > 0) out.push_back({cycle.stick.begin + tenth, cycle.stick.end - tenth});
  }
  return out;
}

/// Without the blocks in which the load steps from one stated value to another.
void drop_changing_loads(const Motion& motion, std::vector<SampleRange>& blocks) {
  for (const Step& step : motion.steps) {
    if (step.begin == 0) continue;
    std::erase_if(blocks, [&](const SampleRange& b) { return b.begin < step.begin && step.begin < b.end; });
  }
}

}  // namespace

NormalForce normal_force(const Motion& motion) {
  NormalForce out;
  if (motion.friction_kind == FrictionKind::force) return out;
  const std::size_t n = motion.size();
  if (!motion.load.empty()) {
    out.channel = motion.load;
  } else {
    const Condition& whole = motion.conditions.load;
    const bool by_step =
        std::any_of(motion.steps.begin(), motion.steps.end(), [](const Step& s) { return s.conditions.load.known(); });
    if (by_step) {
      out.channel.assign(n, whole.value);
      for (const Step& step : motion.steps) {
        if (!step.conditions.load.known()) continue;
        std::fill(out.channel.begin() + std::ptrdiff_t(step.begin), out.channel.begin() + std::ptrdiff_t(step.end),
                  step.conditions.load.value);
      }
      const bool all = std::all_of(out.channel.begin(), out.channel.end(), [](double x) { return x == x; });
      if (!all) out = {{}, 1, false, false, 1};
    } else {
      out.known = whole.known();
      out.constant = whole.known() ? whole.value : 1;
    }
    out.nominal = out.known;
  }
  out.mean = out.constant;
  if (!out.channel.empty()) {
    double sum = 0;
    for (const double x : out.channel) sum += x;
    out.mean = sum / static_cast<double>(n);
  }
  return out;
}

std::vector<SampleRange> balance_blocks(const Motion& motion, const Segmentation& segmentation, std::size_t least) {
  std::vector<std::size_t> ends;
  if (segmentation.kind == MotionKind::stick_slip) {
    for (const Cycle& cycle : segmentation.cycles) {
      const std::size_t middle = cycle.stick.size() > 0 ? cycle.stick.begin + cycle.stick.size() / 2 : cycle.slip.begin;
      if (ends.empty() || middle >= ends.back() + least) ends.push_back(middle);
    }
  } else {
    const double period = period_guess(motion, segmentation);
    const auto samples = static_cast<std::size_t>(2 * period / motion.step);
    const std::size_t n = motion.size();
    const std::size_t length = std::max({least, samples, (n + kMostPieces - 1) / kMostPieces, std::size_t{1}});
    for (std::size_t begin = 0; begin <= n; begin += length) ends.push_back(std::min(begin, n - 1));
  }
  std::vector<SampleRange> blocks;
  for (std::size_t k = 1; k < ends.size(); ++k) blocks.push_back({ends[k - 1], ends[k]});
  drop_changing_loads(motion, blocks);
  return blocks;
}

double period_guess(const Motion& motion, const Segmentation& segmentation) {
  if (segmentation.kind == MotionKind::stick_slip) {
    std::vector<double> slips;
    for (const Cycle& cycle : segmentation.cycles) {
      if (cycle.slip_complete) slips.push_back(static_cast<double>(cycle.slip.size()) * motion.step);
    }
    if (slips.empty()) return 0;
    return 1.5 * median(std::move(slips));  // a slip takes between a half and a whole period of the free block
  }
  const double frequency = fundamental(motion.relative_velocity, motion.step).frequency;
  return frequency > 0 ? 1 / frequency : 0;
}

Balance force_balance(const Motion& motion, const Segmentation& segmentation, const NormalForce& load, double period) {
  Balance out;
  const std::size_t h = knots(period, motion.step);
  out.width = static_cast<double>(kOrder * h) * motion.step;
  const std::vector<SampleRange> sticks = quiet_sticks(segmentation);
  StickNoise noise;
  auto stick = sticks.begin();
  for (const SampleRange& span : balance_blocks(motion, segmentation, kOrder * h + (kFewestRows + 4) * hop_of(h))) {
    Eigen::MatrixXd rows = rows_of(motion, load, span, h);
    while (stick != sticks.end() && stick->end <= span.begin) ++stick;
    std::vector<SampleRange> within;
    for (auto s = stick; s != sticks.end() && s->begin < span.end; ++s) within.push_back(*s);
    noise.add(rows, span, h, within);
    take_off_line(rows);
    out.blocks.push_back(std::move(rows));
    out.spans.push_back(span);
  }
  const Eigen::MatrixXd scatter = noise.covariance();
  out.force_noise = scatter(kForce, kForce);
  for (const BalanceColumn a : {kAcceleration, kVelocity, kJerk}) {
    for (const BalanceColumn b : {kAcceleration, kVelocity, kJerk}) out.noise(a, b) = scatter(a, b);
  }
  if (!motion.sticks) out.noise = white_noise(motion, h);
  return out;
}

namespace {

/// Columns of a solution from those of the balance, as one matrix: each column of it is one unknown's.
Eigen::MatrixXd selection(const std::vector<BalanceColumn>& columns, const Eigen::Vector3d& theta) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kBalanceColumns, Eigen::Index(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    if (columns[k] == kJerk) {
      out(kJerk, c) = theta(0);
      out(kAcceleration, c) = theta(1);
      out(kVelocity, c) = theta(2);
    } else {
      out(columns[k], c) = 1;
    }
  }
  return out;
}

/// Inverse of a symmetric matrix whose columns have units of their own; nothing where it is not positive definite.
bool invert(const Eigen::MatrixXd& matrix, Eigen::MatrixXd& inverse) {
  constexpr double kRounding = 1e-11;
  if (!(matrix.diagonal().array() > 0).all()) return false;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  if (!(eigen.values(0) > kRounding)) return false;
  inverse = scale.asDiagonal() * eigen.vectors * eigen.values.cwiseInverse().asDiagonal() * eigen.vectors.transpose() *
            scale.asDiagonal();
  return true;
}

}  // namespace

BalanceSolution solve_balance(const Balance& balance, std::vector<BalanceColumn> columns,
                              const Eigen::Vector3d& theta) {
  BalanceSolution out;
  out.columns = std::move(columns);
  const Eigen::MatrixXd selected = selection(out.columns, theta);
  const Eigen::MatrixXd noise = selected.transpose() * balance.noise * selected;
  const Eigen::Index p = selected.cols(), n = Eigen::Index(balance.blocks.size());
  std::vector<Eigen::MatrixXd> products;
  std::vector<Eigen::VectorXd> sides;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(p, p), raw = total;
  Eigen::VectorXd side = Eigen::VectorXd::Zero(p);
  double squares = 0, rows = 0;
  for (const Eigen::MatrixXd& block : balance.blocks) {
    const Eigen::MatrixXd x = block * selected;
    const auto freedom = static_cast<double>(block.rows() - 2);
    products.push_back(x.transpose() * x - freedom * noise);
    sides.push_back(x.transpose() * block.col(kForce));
    total += products.back();
    side += sides.back();
    squares += block.col(kForce).squaredNorm();
    rows += freedom;
  }
  raw = total + rows * noise;
  Eigen::MatrixXd inverse, raw_inverse;
  if (n < 3 || !invert(total, inverse) || !invert(raw, raw_inverse)) return out;
  out.values = inverse * side;
  out.noise_share = rows * noise.diagonal().cwiseProduct(raw_inverse.diagonal());
  out.rmse = std::sqrt(std::max(0.0, squares - 2 * out.values.dot(side) + out.values.dot(raw * out.values)) / rows);
  if (out.columns.back() != kJerk) {
    Eigen::VectorXd late = Eigen::VectorXd::Zero(p);
    const Eigen::MatrixXd slope = selection({kJerk}, out.values.head(3));
    for (const Eigen::MatrixXd& block : balance.blocks)
      late -= selected.transpose() * block.transpose() * block * slope;
    out.per_delay = inverse * late;
  }
  out.influence.resize(n, p);
  for (Eigen::Index b = 0; b < n; ++b) {
    Eigen::MatrixXd without;
    if (!invert(total - products[std::size_t(b)], without)) return out;
    out.influence.row(b) =
        static_cast<double>(n - 1) * (out.values - without * (side - sides[std::size_t(b)])).transpose();
  }
  out.solved = true;
  return out;
}

}  // namespace tribofit
