#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tribofit::kinematics {

/// A channel of one file on that file's clock.
struct TimedChannel {
  std::vector<double> time, value;
};

/// What the clock of the velocity shows: t - offset - drift (t - middle) at the time t of friction's clock.
struct ClockLine {
  double offset = 0, drift = 0, middle = 0;
  double at(double t) const { return offset + drift * (t - middle); }
  /// When friction's clock shows what the velocity's shows at t.
  double on_friction(double t) const { return (t + offset - drift * middle) / (1 - drift); }
};

/// What moves with the block, at every sample of its velocity.
using BlockMotion = std::array<double, 3>;  ///< displacement, velocity, acceleration

/// Displacement and velocity from their means; velocity and acceleration as the straight line through `half` samples to
/// either side has them. Noise that is not averaged draws an offset to the middle between two samples, where
/// interpolation averages it.
std::vector<BlockMotion> block_motion(const TimedChannel& velocity, std::size_t half);

/// From the sums of products of size - 1 regressors and, last, of friction: the part of its squares that is left when
/// all are fitted, over what is left by those before `motion`, where the three of the block begin. 1 where mass and
/// stiffness have not one sign, for then a shifted copy of the motion imitates friction. The sums are overwritten.
template <std::size_t size>
double part_left(std::array<std::array<double, size>, size>& sums, std::size_t motion) {
  constexpr std::size_t last = size - 1;
  double whole = 0;
  for (std::size_t k = 0; k < last; ++k) {
    if (k == motion) whole = sums[last][last];
    const double pivot = sums[k][k];
    if (!(pivot > 0)) return 1;
    for (std::size_t i = k + 1; i < size; ++i) {
      const double factor = sums[k][i] / pivot;
      for (std::size_t j = i; j < size; ++j) sums[i][j] -= factor * sums[k][j];
    }
  }
  if (!(whole > 0)) return 1;
  std::array<double, size> solved{};
  for (std::size_t k = last; k-- > motion;) {
    solved[k] = sums[k][last];
    for (std::size_t j = k + 1; j < last; ++j) solved[k] -= sums[k][j] * solved[j];
    solved[k] /= sums[k][k];
  }
  if (!(solved[motion] * solved[motion + 2] > 0)) return 1;
  const double part = sums[last][last] / whole;
  return part < 0 ? 0 : part > 1 ? 1 : part;
}

/// How far friction is from balancing the motion: m a + c v + k x = N mu holds for any law of friction, in stick and in
/// slip, so friction is a linear function of the block's displacement, velocity and acceleration when the clocks agree,
/// and is not when they do not.
class ForceBalance {
 public:
  /// half: samples of the velocity over which the acceleration is taken, to either side. Keeps references.
  ForceBalance(const TimedChannel& friction, const TimedChannel& velocity, std::size_t half)
      : friction_(friction), velocity_(velocity), motion_(block_motion(velocity, half)) {}

  /// Part of the squares of friction that the motion leaves, over what a straight line leaves, for samples [begin, end)
  /// of friction; 1 where they are too few.
  double operator()(const ClockLine& clock, std::size_t begin, std::size_t end) const;

  /// The offset beside that of a line, at most `reach` from it, that leaves least for these samples: looked for in
  /// steps, then to `tolerance`.
  double minimise(const ClockLine& clock, double reach, double step, double tolerance, std::size_t begin,
                  std::size_t end) const;

  /// First sample of friction from a time on.
  std::size_t sample_at(double t) const;

 private:
  const TimedChannel &friction_, &velocity_;
  std::vector<BlockMotion> motion_;
};

}  // namespace tribofit::kinematics
