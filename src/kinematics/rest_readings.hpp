#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "plateau_search.hpp"

// Linear regression on what the velocity reads in the middles of the sticks.

namespace tribofit::kinematics {

/// The middles of the sticks, each in pieces: row by row one piece.
struct RestReadings {
  struct Stick {
    Eigen::Index begin, size;
    double duration;  ///< [s]
  };
  std::vector<Stick> sticks;
  std::vector<std::pair<std::size_t, std::size_t>> pieces;  ///< in blocks
  Eigen::VectorXd velocity, time;                           ///< less that of the disc where it varies [m/s]; [s]
  double scale = 0;                                         ///< mean of |v_b| as read [m/s]

  Eigen::VectorXd means(std::span<const double> blocks) const;
};

RestReadings rest_readings(const PlateauSearch& search);

struct LinearFit {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;  ///< from stick to stick
  double left = HUGE_VAL;      ///< squares
};

/// Means of a stick are its level, which wanders from stick to stick: they weigh by the part of their variance that is
/// noise (random effects, the transformation of Fuller and Battese 1974). used: sticks that take part; those whose
/// level is far off do not.
struct StickWeights {
  std::vector<double> of_mean;
  std::vector<bool> used;
};

/// Level, drift and some more columns, and the fit of others beside them.
class RestRegression {
 public:
  explicit RestRegression(const RestReadings& readings);
  void add(const Eigen::MatrixXd& columns);
  /// Other columns in the place of those from `at` on, nothing else changed.
  void replace(Eigen::Index at, const Eigen::MatrixXd& columns);
  const LinearFit& settled() const { return fit_; }
  const Eigen::MatrixXd& design() const { return design_; }
  std::size_t sticks() const;
  LinearFit with(const Eigen::MatrixXd& columns, bool with_errors) const;
  /// The same in the first half of the sticks, or the second, the rest of the model as in the whole.
  LinearFit in_half(const Eigen::MatrixXd& columns, const LinearFit& whole, bool second) const;

 private:
  void settle();

  const RestReadings& readings_;
  Eigen::MatrixXd design_;
  StickWeights weights_;
  LinearFit fit_;
};

}  // namespace tribofit::kinematics
