#include "static_responses.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "force_balance.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit::kinematics {
namespace {

using Form = StaticResponse::Form;

std::vector<double> running_sum(const std::vector<double>& values) {
  std::vector<double> sums(values.size());
  double sum = 0;
  for (std::size_t b = 0; b < values.size(); ++b) sum += values[b], sums[b] = sum;
  return sums;
}

/// Slope of where the block is in the middles of the plateaus, over blocks [m/s].
double mean_velocity_of(const std::vector<double>& velocity, const std::vector<StickPlateau>& runs) {
  const std::vector<double> position = running_sum(velocity);
  std::vector<double> at, where;
  for (const StickPlateau& run : runs) {
    const std::size_t middle = (run.begin + run.end) / 2;
    at.push_back(static_cast<double>(middle));
    where.push_back(position[middle]);
  }
  return fit_line(at, where).slope;
}

/// Part of the squares of friction that displacement, velocity and acceleration of the block leave, each cycle about
/// its mean. Beside re-stick friction and acceleration jump: the block with the jump and those whose difference reaches
/// it are left out.
double left_by_balance(const std::vector<double>& friction, const std::vector<double>& velocity,
                       const std::vector<StickPlateau>& runs) {
  constexpr std::size_t size = 4, reach = 2;
  const std::vector<double> position = running_sum(velocity);
  std::array<std::array<double, size>, size> sums{};
  for (std::size_t k = 0; k + 1 < runs.size(); ++k) {
    const std::size_t begin = runs[k].begin + reach, end = runs[k + 1].begin - reach;
    const auto row_at = [&](std::size_t b) {
      return std::array{position[b], velocity[b], velocity[b + 1] - velocity[b - 1], friction[b]};
    };
    std::array<double, size> mean{};
    for (std::size_t b = begin; b < end; ++b) {
      for (std::size_t i = 0; i < size; ++i) mean[i] += row_at(b)[i] / static_cast<double>(end - begin);
    }
    for (std::size_t b = begin; b < end; ++b) {
      const auto row = row_at(b);
      for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = i; j < size; ++j) sums[i][j] += (row[i] - mean[i]) * (row[j] - mean[j]);
      }
    }
  }
  return part_left(sums, 0);
}

/// The response of one form with which the block goes nowhere; part: its slope over the mean velocity.
UndoneResponse response_without_displacement(const PlateauSearch& search, StaticResponse response,
                                             const Estimate& mean) {
  const double read = std::abs(response.full_scale), direction = response.full_scale < 0 ? -1 : 1;
  std::vector<double> velocity(search.blocks.mean.size());
  const auto mean_at = [&](double part) {
    response.part = part;
    // From the largest reading to what it stands for.
    const bool grows = response.form != Form::one_sided;
    response.full_scale = direction * read / (grows ? 1 - part : 1);
    std::transform(search.blocks.mean.begin(), search.blocks.mean.end(), velocity.begin(),
                   [&](double v) { return response.undone(v); });
    return mean_velocity_of(velocity, search.plateaus.runs);
  };
  // Secants: the mean is nearly a straight line of the part.
  double before = 0, mean_before = mean_at(0), part = 0.01, slope = 0;
  constexpr int kSecants = 6;
  for (int k = 0; k < kSecants && std::abs(part) < 2 * kMostCompressed; ++k) {
    const double here = mean_at(part);
    if (here == mean_before || part == before) break;
    slope = (here - mean_before) / (part - before);
    before = part, mean_before = here;
    part -= here / slope;
  }
  if (!(std::abs(part) <= kMostCompressed) || slope == 0) return {};
  mean_at(part);
  // Another characteristic of the same form would lose as much elsewhere in the slip.
  return {response, std::hypot(mean.std_error / slope, kOtherCharacteristic * part)};
}

/// The blocks of a plateau about its middle in which the velocity is at rest but for noise: where sticks are short
/// beside slips, the ends of a plateau slide.
StickPlateau at_rest(const PlateauSearch& search, const StickPlateau& run) {
  const double most = std::max(kPieceNoise * search.noise, kRestDepth * search.plateaus.depth);
  const auto rests = [&](std::size_t b) {
    const double disc = search.disc.mean.empty() ? 0 : search.disc.mean[b];
    return std::abs(search.blocks.mean[b] - disc - run.level) <= most;
  };
  StickPlateau rest{(run.begin + run.end) / 2, (run.begin + run.end) / 2, run.level};
  while (rest.begin > run.begin && rests(rest.begin - 1)) --rest.begin;
  while (rest.end < run.end && rests(rest.end)) ++rest.end;
  return rest;
}

/// Friction in one stick, block by block, over something that grows in a straight line there.
struct Ramp {
  Eigen::ArrayXd friction, base;
};

/// By how much the part of a response that was undone is too small, and what sticks disagree by.
struct Curvature {
  double part = 0, std_error = 0;
  std::array<double, 2> halves = {};
  std::vector<double> left;  ///< squares of each stick
};

/// Each stick has a line of its own. What a response makes of it is taken from the line, not from noisy readings.
Curvature curvature_of(const std::vector<Ramp>& ramps, const StaticResponse& undone) {
  std::vector<double> products, squares;
  Curvature out;
  for (const Ramp& ramp : ramps) {
    const Eigen::ArrayXd x = ramp.base - ramp.base.mean();
    const auto without_line = [&](const Eigen::ArrayXd& y) {
      return Eigen::ArrayXd(y - y.mean() - (x * y).sum() / x.square().sum() * x);
    };
    const Eigen::ArrayXd y = ramp.friction.unaryExpr([&](double mu) { return undone.undone(mu); });
    const Eigen::ArrayXd off = without_line(y), line = y - off;
    const Eigen::ArrayXd curve = without_line(line.unaryExpr([&](double mu) { return undone.slope(mu); }));
    products.push_back(-(off * curve).sum());
    squares.push_back(curve.square().sum());
    // As it was read: what is undone has more noise where the gain is less.
    out.left.push_back((off * line.unaryExpr([&](double mu) { return undone.gain(mu); })).square().sum());
  }
  const auto part_of = [&](std::size_t begin, std::size_t end) {
    double product = 0, square = 0;
    for (std::size_t k = begin; k < end; ++k) product += products[k], square += squares[k];
    return square > 0 ? product / square : 0;
  };
  const std::size_t n = ramps.size();
  out.part = part_of(0, n);
  out.halves = {part_of(0, n / 2), part_of(n / 2, n)};
  double scatter = 0, square = 0;
  for (std::size_t k = 0; k < n; ++k) scatter += std::pow(products[k] - out.part * squares[k], 2), square += squares[k];
  out.std_error = square > 0 ? std::sqrt(scatter) / square : 0;
  return out;
}

/// The part of a form with which ramps are straight, and what is left then.
Curvature straightened(const std::vector<Ramp>& ramps, StaticResponse& response) {
  constexpr int kRounds = 8;
  const double read = response.full_scale;
  Curvature found;
  for (int round = 0; round < kRounds; ++round) {
    found = curvature_of(ramps, response);
    response.part += found.part;
    if (std::abs(response.part) > 2 * kMostCompressed) return {};
    response.full_scale = read / (1 - response.part);
  }
  return found;
}

/// A response of one form, and what sticks say of it.
struct Straightened {
  UndoneResponse found;
  std::vector<double> left;
};

/// The better one of two forms. Where sticks do not tell them apart, half of their difference is an error too.
UndoneResponse better_of(const Straightened& a, const Straightened& b) {
  if (!a.found.any() || !b.found.any()) return a.found.any() ? a.found : b.found;
  const Eigen::Map<const Eigen::ArrayXd> left_a(a.left.data(), static_cast<Eigen::Index>(a.left.size())),
      left_b(b.left.data(), static_cast<Eigen::Index>(b.left.size()));
  const Eigen::ArrayXd more = left_b - left_a;
  UndoneResponse best = more.sum() >= 0 ? a.found : b.found;
  if (std::abs(more.sum()) < kZeroErrors * std::sqrt((more - more.mean()).square().sum()))
    best.std_error = std::hypot(best.std_error, 0.5 * (a.found.response.part - b.found.response.part));
  return best;
}

/// Friction in the middles of the sticks, over the displacements of the block and of the disc; the force, where
/// friction was divided by a load that varies, over that of the block.
struct StickRamps {
  std::vector<Ramp> over_way, over_disc, of_force;
  double largest = 0;  ///< friction
};

/// may_sag: a plateau that is not level is at rest too.
StickRamps ramps_of(const Trace& trace, const PlateauSearch& search, bool may_sag) {
  const std::size_t length = search.blocks.length;
  const BlockMeans friction = block_means(trace.friction, length, search.blocks.step);
  std::vector<double> force = friction.mean;
  if (!trace.load.empty()) {
    const BlockMeans load = block_means(trace.load, length, search.blocks.step);
    const double usual = mean_of(load.mean);
    for (std::size_t b = 0; b < force.size(); ++b) force[b] *= load.mean[b] / usual;
  }
  const std::vector<double> position = running_sum(search.blocks.mean);
  const std::vector<double> turned = search.disc.mean.empty() ? std::vector<double>() : running_sum(search.disc.mean);
  StickRamps ramps{{}, {}, {}, largest_of(friction.mean)};
  for (const StickPlateau& run : search.plateaus.runs) {
    const StickPlateau rest = may_sag ? run : at_rest(search, run);
    const std::size_t first = rest.inner_begin(), size = rest.inner_end() - first;
    if (size < kFewestBlocks) continue;
    const auto n = static_cast<Eigen::Index>(size);
    const auto part = [&](const std::vector<double>& values) {
      return Eigen::ArrayXd(Eigen::Map<const Eigen::ArrayXd>(values.data() + first, n));
    };
    ramps.over_way.push_back({part(friction.mean), part(position)});
    ramps.over_disc.push_back(
        {part(friction.mean), turned.empty() ? Eigen::ArrayXd(Eigen::ArrayXd::LinSpaced(n, 0, 1)) : part(turned)});
    ramps.of_force.push_back({part(force), part(position)});
  }
  return ramps;
}

}  // namespace

UndoneResponse find_velocity_response(const Trace& trace, const PlateauSearch& search, const Estimate& mean) {
  double fastest = 0;
  for (const double v : trace.velocity) fastest = std::max(fastest, std::abs(v));
  if (!(fastest > 0)) return {};
  const BlockMeans friction = block_means(trace.friction, search.blocks.length, search.blocks.step);
  UndoneResponse best;
  double least = std::numeric_limits<double>::infinity();
  for (const Form form : {Form::square, Form::linear, Form::one_sided}) {
    const StaticResponse none{form, 0, std::copysign(fastest, search.plateaus.level)};
    const UndoneResponse found = response_without_displacement(search, none, mean);
    if (!found.any()) continue;
    std::vector<double> velocity = search.blocks.mean;
    for (double& v : velocity) v = found.response.undone(v);
    const double left = left_by_balance(friction.mean, velocity, search.plateaus.runs);
    if (left < least) least = left, best = found;
  }
  return best;
}

StickBends bends_in_stick(const Trace& trace, const PlateauSearch& search) {
  const StickRamps ramps = ramps_of(trace, search, true);
  if (ramps.over_way.size() < kFewestForMedian) return {};
  const StaticResponse straight{Form::linear, 0, ramps.largest};
  const Curvature way = curvature_of(ramps.over_way, straight), disc = curvature_of(ramps.over_disc, straight);
  return {disc.part, way.part, std::max(disc.std_error, way.std_error)};
}

UndoneResponse find_friction_response(const Trace& trace, const PlateauSearch& search) {
  const StickRamps ramps = ramps_of(trace, search, false);
  if (ramps.over_way.size() < 2 * kFewestPeriods) return {};
  const auto straighten = [&](Form form) -> Straightened {
    StaticResponse response{form, 0, ramps.largest};
    const Curvature first = curvature_of(ramps.over_way, response);
    const double part = first.part;
    const auto agrees = [&](double other, double error) {
      return std::abs(part - other) < kHalvesAgree * part + kZeroErrors * std::hypot(first.std_error, error);
    };
    for (const double half : first.halves) {
      if (!agrees(half, std::numbers::sqrt2 * first.std_error)) return {};
    }
    for (const std::vector<Ramp>& others : {ramps.over_disc, ramps.of_force}) {
      const Curvature other = curvature_of(others, response);
      if (!agrees(other.part, other.std_error)) return {};
    }
    if (part < std::max(kLeastCurvature, kSignificance * first.std_error)) return {};
    const Curvature straight = straightened(ramps.over_way, response);
    if (straight.std_error == 0 || response.part < kLeastCurvature || response.part > kMostCompressed) return {};
    return {{response, std::hypot(straight.std_error, kOtherCharacteristic * response.part)}, straight.left};
  };
  return better_of(straighten(Form::square), straighten(Form::linear));
}

}  // namespace tribofit::kinematics
