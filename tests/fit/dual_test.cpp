/// Dual numbers beside those of Ceres: the same to the last bit.
#include "fit/dual.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace tribofit {
namespace {

using Jet = ceres::Jet<double, 6>;
using Number = Dual<6>;

/// The same number twice, with derivatives in all directions.
struct Twice {
  Jet jet;
  Number dual;

  explicit Twice(double value) : jet(value), dual(value) {
    for (int k = 0; k < 6; ++k) {
      const double slope = std::sin(value + 1.7 * k);
      jet.v[k] = slope;
      dual += slope * (Number(0, static_cast<std::size_t>(k)));
    }
  }
};

void expect_same(const Jet& jet, const Number& dual) {
  EXPECT_EQ(jet.a, dual.a);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(jet.v[k], dual.v[static_cast<std::size_t>(k)]) << k;
  EXPECT_NEAR(jet.v.squaredNorm(), dual.v.squaredNorm(), 1e-15 * jet.v.squaredNorm());
}

TEST(Dual, ArithmeticIsThatOfJets) {
  for (const double value : {-2.5, -0.3, 0.7, 4.0}) {
    const Twice x(value), y(1.3 - value);
    expect_same(x.jet, x.dual);
    expect_same(-x.jet, -x.dual);
    expect_same(x.jet + y.jet, x.dual + y.dual);
    expect_same(x.jet - y.jet, x.dual - y.dual);
    expect_same(x.jet * y.jet, x.dual * y.dual);
    expect_same(x.jet / y.jet, x.dual / y.dual);
    expect_same(x.jet + 0.3, x.dual + 0.3);
    expect_same(0.3 - x.jet, 0.3 - x.dual);
    expect_same(3.1 * x.jet, 3.1 * x.dual);
    expect_same(x.jet / 3.1, x.dual / 3.1);
    expect_same(3.1 / x.jet, 3.1 / x.dual);
    Jet jet = x.jet;
    Number dual = x.dual;
    jet += y.jet, dual += y.dual;
    jet *= x.jet, dual *= x.dual;
    jet /= y.jet, dual /= y.dual;
    jet -= y.jet, dual -= y.dual;
    expect_same(jet, dual);
    EXPECT_EQ(x.jet < y.jet, x.dual < y.dual);
    EXPECT_EQ(x.jet > 0.5, x.dual > 0.5);
  }
}

TEST(Dual, FunctionsAreThoseOfJets) {
  for (const double value : {0.01, 0.7, 4.0}) {
    const Twice x(value), negative(-value);
    expect_same(abs(negative.jet), abs(negative.dual));
    expect_same(sqrt(x.jet), sqrt(x.dual));
    expect_same(exp(negative.jet), exp(negative.dual));
    expect_same(log(x.jet), log(x.dual));
    expect_same(sin(negative.jet), sin(negative.dual));
    expect_same(cos(negative.jet), cos(negative.dual));
    expect_same(tanh(negative.jet), tanh(negative.dual));
  }
}

}  // namespace
}  // namespace tribofit
