#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// Noise of values taken at any times: white, and beside it an Ornstein-Uhlenbeck process, whose values dt apart have
/// the correlation exp(-dt/time). So is the noise of a sensor that also drifts, or what a model leaves that is nearly
/// right.
struct WanderingNoise {
  double white = 0;  ///< standard deviation of a single sample
  double slow = 0;   ///< of what wanders
  double time = 0;   ///< over which that forgets itself; 0: nothing wanders
};

/// Values at ascending times in stretches that know nothing of one another. A value may be the mean of several
/// neighbouring samples: its white noise is smaller by the root of their number.
struct NoisySeries {
  std::span<const double> time, count;
  std::span<const std::size_t> stretch_begins;  ///< first value of each stretch; ends where the next one begins

  std::size_t end_of(std::size_t stretch) const {
    return stretch + 1 < stretch_begins.size() ? stretch_begins[stretch + 1] : time.size();
  }
};

/// Sizes and time of the noise from the residuals of a least-squares fit, by restricted maximum likelihood (H. D.
/// Patterson, R. Thompson, Biometrika 58 (1971) 545): what the parameters and two values of each stretch took out of
/// the residuals is allowed for. jacobian: derivatives of the residuals by the parameters that all stretches share;
/// own: those by the values of each stretch, as many columns as any stretch has (they are zero elsewhere by meaning,
/// not stored). The likelihood is computed by Kalman's filter. Cost: linear in values, some hundred passes.
WanderingNoise estimate_noise(const NoisySeries& series, const Eigen::VectorXd& residual,
                              const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& own);

/// r' S^-1 r with the covariance S of that noise and the values of each stretch (`own`) left free: minus twice the
/// logarithm of the likelihood of the residuals, but for a constant.
double whitened_squares(const NoisySeries& series, const Eigen::VectorXd& residual, const Eigen::MatrixXd& own,
                        const WanderingNoise& noise);

/// G' S G with the covariance S of that noise: what it does to sums of values weighted by the columns of G.
/// Two parts: that of the white noise and that of what wanders. Cost: linear in values.
struct NoiseMoments {
  Eigen::MatrixXd white, slow;
};
NoiseMoments noise_moments(const NoisySeries& series, const Eigen::MatrixXd& weights, const WanderingNoise& noise);

}  // namespace tribofit
