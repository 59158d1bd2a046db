// The response of a channel: known readings, its inverse, and its derivatives against differences.
#include "tribofit/instruments/static_response.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribofit {
namespace {

using Form = StaticResponse::Form;

TEST(StaticResponse, ReadsWhatItsFormSays) {
  EXPECT_DOUBLE_EQ((StaticResponse{Form::square, 0.1, 2}.reading(1)), 0.975);
  EXPECT_DOUBLE_EQ((StaticResponse{Form::square, 0.1, 2}.reading(-2)), -1.8);
  EXPECT_DOUBLE_EQ((StaticResponse{Form::linear, 0.1, 2}.reading(-1)), -0.95);
  EXPECT_DOUBLE_EQ((StaticResponse{Form::one_sided, 0.1, 2}.reading(-1)), -0.9);
  EXPECT_DOUBLE_EQ((StaticResponse{Form::one_sided, 0.1, 2}.reading(1)), 1);
  EXPECT_DOUBLE_EQ((StaticResponse{Form::one_sided, 0.1, -2}.reading(1)), 0.9) << "the disc turns backwards";
  EXPECT_DOUBLE_EQ(StaticResponse{}.reading(3), 3);
}

TEST(StaticResponse, IsUndone) {
  for (const Form form : {Form::square, Form::linear, Form::one_sided}) {
    for (const double part : {-0.3, -0.05, 0.01, 0.1, 0.25}) {
      const StaticResponse response{form, part, 0.5};
      for (double x = -0.5; x <= 0.5; x += 0.01) {
        EXPECT_NEAR(response.undone(response.reading(x)), x, 5e-5) << part << " " << x;
      }
    }
  }
}

TEST(StaticResponse, KnowsItsDerivatives) {
  constexpr double kStep = 1e-6;
  for (const Form form : {Form::square, Form::linear, Form::one_sided}) {
    const StaticResponse response{form, 0.1, 0.5};
    for (const double x : {-0.45, -0.2, 0.1, 0.4}) {
      EXPECT_NEAR((response.reading(x + kStep) - response.reading(x - kStep)) / (2 * kStep), response.gain(x), 1e-8);
      StaticResponse more = response;
      more.part += kStep;
      EXPECT_NEAR((more.undone(response.reading(x)) - x) / kStep, response.slope(x), 1e-4) << x;
    }
  }
}

}  // namespace
}  // namespace tribofit
