#include "tribofit/statistics/distributions.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace tribofit {

double t_quantile_95(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

double t_p_value(double t, double degrees_of_freedom) {
  if (!std::isfinite(t)) return 1;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees_of_freedom), std::abs(t)));
}

double f_p_value(double f, double degrees_of_freedom, double degrees_of_freedom_below) {
  const boost::math::fisher_f distribution(degrees_of_freedom, degrees_of_freedom_below);
  return boost::math::cdf(boost::math::complement(distribution, f));
}

}  // namespace tribofit
