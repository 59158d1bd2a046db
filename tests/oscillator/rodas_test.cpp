#include "oscillator/rodas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

namespace tribofit::oscillator {
namespace {

using Step = RodasStep<double, 2>;
using State = Step::State;

struct Derivatives {
  std::array<State, 2> by_state;  ///< [row][column]
  State by_time;
};
struct Problem {
  std::function<State(double, const State&)> rates;
  std::function<Derivatives(double, const State&)> derivatives;
};

/// Step by step, with the errors within a tolerance, absolute and relative.
class Integrator {
 public:
  Integrator(const Problem& problem, const State& y, double tolerance, double longest)
      : problem_(problem), state_(y), tolerance_(tolerance), longest_(longest), next_(1e-6 * longest) {}

  double time() const { return time_; }
  const State& state() const { return state_; }

  /// One step, at most to `until`. Whether any was short enough.
  bool step(double until) {
    for (;;) {
      const double h = std::min(next_, until - time_), error = try_step(h), change = next_step_over_this(error);
      const bool was_cut = error <= 1 && h < next_;
      next_ = std::min(longest_, was_cut ? std::max(next_, change * h) : change * h);
      if (error <= 1) {
        begin_ = time_;
        time_ = h == until - time_ ? until : time_ + h;
        state_ = step_.after;
        return true;
      }
      if (next_ < 1e-15 * longest_) return false;
    }
  }
  State at(double t) const { return step_.at((t - begin_) / (time_ - begin_)); }

 private:
  double try_step(double h) {
    const Derivatives d = problem_.derivatives(time_, state_);
    const auto rates = [&](std::size_t stage, const State& y) {
      State f = problem_.rates(time_ + Step::place[stage] * h, y);
      for (std::size_t k = 0; k < 2; ++k) f[k] += Step::by_time[stage] * h * d.by_time[k];
      return f;
    };
    const double diagonal = 1 / (Step::gamma * h), a = diagonal - d.by_state[0][0], b = -d.by_state[0][1],
                 c = -d.by_state[1][0], e = diagonal - d.by_state[1][1];
    const auto solve = [&](const State& r) {
      return State{(e * r[0] - b * r[1]) / (a * e - b * c), (a * r[1] - c * r[0]) / (a * e - b * c)};
    };
    step_.take(state_, h, rates(0, state_), rates, solve);
    double squares = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double size = std::max(std::abs(state_[k]), std::abs(step_.after[k]));
      squares += 0.5 * std::pow(step_.error()[k] / (tolerance_ * (1 + size)), 2);
    }
    return std::sqrt(squares);
  }

  const Problem& problem_;
  State state_;
  double tolerance_, longest_, next_, time_ = 0, begin_ = 0;
  Step step_;
};

struct Errors {
  double at_steps = 0, between = 0;  ///< largest of either unknown
  std::size_t steps = 0;
};

/// Integrates to `end` and compares with the exact solution at the end of each step and in its middle.
template <class Exact>
Errors errors_of(const Problem& problem, Exact&& exact, double end, double tolerance, double max_step) {
  const auto difference = [&](double t, const State& y) {
    const State truth = exact(t);
    return std::max(std::abs(y[0] - truth[0]), std::abs(y[1] - truth[1]));
  };
  Integrator integrator(problem, exact(0.0), tolerance, max_step);
  Errors errors;
  while (integrator.time() < end) {
    const double begin = integrator.time();
    if (!integrator.step(end)) {
      ADD_FAILURE() << "no step is short enough at " << begin;
      break;
    }
    ++errors.steps;
    const double middle = 0.5 * (begin + integrator.time());
    errors.at_steps = std::max(errors.at_steps, difference(integrator.time(), integrator.state()));
    errors.between = std::max(errors.between, difference(middle, integrator.at(middle)));
  }
  EXPECT_EQ(integrator.time(), end);
  return errors;
}

// y' = A y with eigenvalues -1 along (1, 1) and -1e6 along (1, -1): y = exp(-t) (1, 1) + exp(-1e6 t) (1, -1).
TEST(Rodas, LinearSystemOfTwoScales) {
  const double fast = 1e6, sum = -0.5 * (1 + fast), difference = -0.5 * (1 - fast);
  const Problem problem{[=](double, const State& y) {
                          return State{sum * y[0] + difference * y[1], difference * y[0] + sum * y[1]};
                        },
                        [=](double, const State&) {
                          return Derivatives{{{{sum, difference}, {difference, sum}}}, {0, 0}};
                        }};
  const auto exact = [=](double t) {
    const double slow = std::exp(-t), quick = std::exp(-fast * t);
    return State{slow + quick, slow - quick};
  };
  for (const double tolerance : {1e-6, 1e-9}) {
    const Errors errors = errors_of(problem, exact, 10, tolerance, 10);
    EXPECT_LT(errors.at_steps, tolerance);
    EXPECT_LT(errors.between, 10 * tolerance);
    EXPECT_LT(static_cast<double>(errors.steps), 30 * std::pow(tolerance, -0.2));  // an explicit method needs 3e6
  }
}

// y0' = -1e4 (y0 - cos t) - sin t (Prothero and Robinson, 1974) with y0(0) = 1: y0 = cos t. And y1' = -t y1: the
// derivatives by time matter.
TEST(Rodas, ProblemsThatDependOnTime) {
  const double lambda = -1e4;
  const Problem problem{[=](double t, const State& y) {
                          return State{lambda * (y[0] - std::cos(t)) - std::sin(t), -t * y[1]};
                        },
                        [=](double t, const State& y) {
                          return Derivatives{{{{lambda, 0}, {0, -t}}}, {lambda * std::sin(t) - std::cos(t), -y[1]}};
                        }};
  const auto exact = [](double t) { return State{std::cos(t), std::exp(-0.5 * t * t)}; };
  for (const double tolerance : {1e-5, 1e-8}) {
    const Errors errors = errors_of(problem, exact, 5, tolerance, 1);
    EXPECT_LT(errors.at_steps, 10 * tolerance);
    EXPECT_LT(errors.between, 10 * tolerance);
    EXPECT_LT(static_cast<double>(errors.steps), 30 * std::pow(tolerance, -0.25));
  }
}

// A harmonic oscillation with fixed steps (the tolerance never rejects any): halving them divides the error by 2^4.
TEST(Rodas, IsOfFourthOrder) {
  const Problem problem{[](double, const State& y) {
                          return State{y[1], -y[0]};
                        },
                        [](double, const State&) {
                          return Derivatives{{{{0, 1}, {-1, 0}}}, {0, 0}};
                        }};
  const auto error = [&](double step) {
    Integrator integrator(problem, {1, 0}, 1e3, step);
    for (int i = 1; i <= std::lround(8 / step); ++i) {
      while (integrator.time() < i * step && integrator.step(i * step)) {
      }
    }
    return std::hypot(integrator.state()[0] - std::cos(8.0), integrator.state()[1] + std::sin(8.0));
  };
  EXPECT_NEAR(std::log2(error(0.1) / error(0.05)), 4, 0.3);
  EXPECT_NEAR(std::log2(error(0.05) / error(0.025)), 4, 0.2);
}

// y0' = y1, y1' = ((1 - y0^2) y1 - y0)/1e-6 from (2, 0) to t = 2. The values are those of the Test Set for IVP Solvers
// (Mazzia and Magherini, problem vdpol), computed there by RADAU with a tolerance of 1.1e-18.
TEST(Rodas, VanDerPolAgreesWithTheTestSet) {
  const double epsilon = 1e-6;
  const Problem problem{
      [=](double, const State& y) {
        return State{y[1], ((1 - y[0] * y[0]) * y[1] - y[0]) / epsilon};
      },
      [=](double, const State& y) {
        return Derivatives{{{{0, 1}, {(-2 * y[0] * y[1] - 1) / epsilon, (1 - y[0] * y[0]) / epsilon}}}, {0, 0}};
      }};
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    Integrator integrator(problem, {2, 0}, tolerance, 1);
    while (integrator.time() < 2) ASSERT_TRUE(integrator.step(2));
    EXPECT_NEAR(integrator.state()[0], 1.706167732170483, 10 * tolerance);
    EXPECT_NEAR(integrator.state()[1], -0.8928097010247975, 10 * tolerance);
  }
}

TEST(Rodas, GoesNoFurtherWhereTheRatesAreNoNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Problem problem{[=](double t, const State&) {
                          return State{t < 1 ? 1 : nan, 0};
                        },
                        [](double, const State&) { return Derivatives{}; }};
  Integrator integrator(problem, {0, 0}, 1e-6, 0.1);
  bool stepped = true;
  for (int i = 0; i < 10000 && stepped; ++i) stepped = integrator.step(2);
  EXPECT_FALSE(stepped);
  EXPECT_LE(integrator.time(), 1);
  EXPECT_GT(integrator.time(), 0.99);
  EXPECT_NEAR(integrator.state()[0], integrator.time(), 1e-12);
}

}  // namespace
}  // namespace tribofit::oscillator
