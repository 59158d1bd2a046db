#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

namespace tribofit::diagnosis {

/// Straight lines between knots: the weights of x on them.
class Hats {
 public:
  Hats(std::vector<double> knots) : knots_(std::move(knots)) {}
  Eigen::Index count() const { return static_cast<Eigen::Index>(knots_.size()); }
  const std::vector<double>& knots() const { return knots_; }

  Eigen::RowVectorXd operator()(double x) const {
    Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(count());
    const auto next = std::upper_bound(knots_.begin(), knots_.end(), x);
    if (next == knots_.begin()) {
      out(0) = 1;
    } else if (next == knots_.end()) {
      out(count() - 1) = 1;
    } else {
      const auto k = static_cast<Eigen::Index>(next - knots_.begin());
      const double u = (x - *(next - 1)) / (*next - *(next - 1));
      out(k - 1) = 1 - u;
      out(k) = u;
    }
    return out;
  }

 private:
  std::vector<double> knots_;
};

inline std::vector<double> even_knots(double first, double last, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k) knots.push_back(first + (last - first) * k / (count - 1));
  return knots;
}

}  // namespace tribofit::diagnosis
