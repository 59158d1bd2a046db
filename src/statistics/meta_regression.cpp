#include "meta_regression.hpp"

#include <cmath>

#include "linear_algebra.hpp"

namespace tribofit {
namespace {

struct Weighted {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd inverse;  ///< (X'WX)^-1
  double squares = 0;       ///< weighted, of the residuals
};

Weighted weighted(const Eigen::VectorXd& y, const Eigen::VectorXd& variance, const Eigen::MatrixXd& x, double between) {
  const Eigen::VectorXd weight = (variance.array() + between).inverse();
  Weighted out;
  out.inverse = inverse_of_symmetric(x.transpose() * weight.asDiagonal() * x);
  out.coefficients = out.inverse * (x.transpose() * (weight.asDiagonal() * y));
  out.squares = (y - x * out.coefficients).array().square().matrix().dot(weight);
  return out;
}

}  // namespace

MetaRegression meta_regression(const Eigen::VectorXd& y, const Eigen::VectorXd& variance,
                               const Eigen::MatrixXd& design) {
  MetaRegression out;
  const Weighted fixed = weighted(y, variance, design, 0);
  out.statistical = fixed.inverse.diagonal().cwiseSqrt();
  const auto freedom = static_cast<double>(y.size() - design.cols());
  if (freedom <= 0) {
    out.coefficients = fixed.coefficients;
    out.covariance = fixed.inverse;
    return out;
  }
  out.degrees_of_freedom = freedom;
  double tau2 = 0;
  if (fixed.squares > freedom) {
    // The squares fall with tau^2; all scatter taken for tau^2 is more than enough.
    double low = 0, high = (y - design * fixed.coefficients).squaredNorm() + variance.maxCoeff();
    for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (weighted(y, variance, design, middle).squares > freedom ? low : high) = middle;
    }
    tau2 = 0.5 * (low + high);
  }
  const Weighted random = weighted(y, variance, design, tau2);
  out.coefficients = random.coefficients;
  out.covariance = random.inverse * (random.squares / freedom);
  out.between = std::sqrt(tau2);
  const Eigen::VectorXd of_run = variance.array() / (variance.array() + tau2).square();
  out.statistical =
      (random.inverse * (design.transpose() * of_run.asDiagonal() * design) * random.inverse).diagonal().cwiseSqrt();
  return out;
}

}  // namespace tribofit
