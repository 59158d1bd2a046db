#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

namespace tribofit::segmentation {

/// Samples around one break-away, in units of samples and m/s above the plateau, in the slip's direction.
struct Window {
  std::size_t begin = 0;        // sample of the first value
  std::vector<double> v;        // above the local plateau
  std::vector<double> squares;  // squares[i]: sum of v^2 before i, what is left over if nothing has happened yet
  double t0 = 0;                // break-away, in samples from `begin`
  double crossing = 0;          // where the velocity crosses the end of the fit
  bool is_cut = false;          // the disc steps before the velocity crosses the end of the fit
  double pull = 1;              // speed of the disc over that of the others: A is in proportion
  double excess = 0;            // friction at break-away over that of the others, less 1: what lambda goes with
};

/// The growth common to all break-aways, time in samples: A, lambda, B, and d log lambda / d excess.
struct Growth {
  double a = 0, lambda = 0, b = 0, gain = 0;
};

/// The growth in one window: lambda by its excess, A by its pull over lambda^2.
Growth growth_in(const Window& window, const Growth& growth);

/// What is fitted beside A and lambda.
struct FreeGrowth {
  bool jump = false;  ///< B
  bool gain = false;
};

/// Residuals of a window and their derivatives, summed into normal equations.
struct Sums {
  double rss = 0, h = 0, g = 0;                     // t0
  Eigen::Vector4d mixed = Eigen::Vector4d::Zero();  // t0 with (log A, log lambda, B, gain)
  Eigen::Matrix4d shared = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
};

/// All of them, at t0.
Sums sums_of(const Window& window, const Growth& growth, double t0);

/// t0 of a window by Gauss-Newton from `start`.
double fit_time(const Window& window, const Growth& growth, double start);

struct PooledFit {
  Growth growth;
  double rss = std::numeric_limits<double>::infinity();
  Eigen::Matrix4d information = Eigen::Matrix4d::Identity();  // of (log A, log lambda, B, gain), for unit variance
  std::size_t samples = 0;
};

/// Levenberg-Marquardt on the shared parameters, each window's t0 eliminated; sets t0 of the windows, and takes out the
/// few that do not share the growth.
PooledFit fit_growth(std::vector<Window>& windows, Growth growth, FreeGrowth free);

/// Variance of what the growth leaves, and the factor by which its colour enlarges it: of the lag-one correlation
/// before break-away.
struct Noise {
  double variance = 0, inflation = 1;
  double effective() const { return variance * inflation; }
};

Noise noise_of(const std::vector<Window>& windows, const Growth& growth);

}  // namespace tribofit::segmentation
