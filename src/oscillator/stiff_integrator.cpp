#include "stiff_integrator.hpp"
#include "tribofit/output/digits.hpp"

#include <fmt/format.h>

#include <algorithm>
// The checks of ublas throw in debug builds where release builds go on.
#define BOOST_UBLAS_NDEBUG
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace tribofit {

namespace {

/// Boost 1.74 has d4, by which the derivative by time enters, with the wrong sign: y' = t would go to 0.534 at t = 1.
struct Coefficients : boost::numeric::odeint::default_rosenbrock_coefficients<double> {
  const double d4 = -0.362e-01;
};
using Stepper = boost::numeric::odeint::rosenbrock4<double, Coefficients>;
using Vector = Stepper::state_type;
using Matrix = Stepper::matrix_type;

StiffIntegrator::State state_of(const Vector& y) {
  StiffIntegrator::State state{};
  std::copy(y.begin(), y.end(), state.begin());
  return state;
}

Vector vector_of(const StiffIntegrator::State& state) {
  Vector y(StiffIntegrator::kSize);
  std::copy(state.begin(), state.end(), y.begin());
  return y;
}

/// The step to begin with is this share of the largest one; the error control finds its own from there.
constexpr double kFirstStep = 1e-6;

}  // namespace

struct StiffIntegrator::Method {
  Problem problem;
  double max_step;
  boost::numeric::odeint::rosenbrock4_controller<Stepper> controller;
  double next_step;  ///< that the error control asks for
  double begin;      ///< of the step just made
  Vector before, after;

  void rates(const Vector& y, Vector& dy, double t) const {
    const State rate = problem.rates(t, state_of(y));
    std::copy(rate.begin(), rate.end(), dy.begin());
  }
  void derivatives(const Vector& y, Matrix& by_state, double t, Vector& by_time) const {
    const Derivatives values = problem.derivatives(t, state_of(y));
    for (std::size_t row = 0; row < kSize; ++row) {
      for (std::size_t column = 0; column < kSize; ++column) by_state(row, column) = values.by_state[row][column];
      by_time[row] = values.by_time[row];
    }
  }
};

StiffIntegrator::StiffIntegrator(Problem problem, double t, const State& y, const Options& options)
    : time_(t),
      state_(y),
      method_(new Method{std::move(problem),
                         options.max_step,
                         {options.absolute_tolerance, options.relative_tolerance},
                         kFirstStep * options.max_step,
                         t,
                         vector_of(y),
                         vector_of(y)}) {}

StiffIntegrator::~StiffIntegrator() = default;

bool StiffIntegrator::step(double until) {
  Method& m = *method_;
  const auto rates = [&m](const Vector& y, Vector& dy, double t) { m.rates(y, dy, t); };
  const auto derivatives = [&m](const Vector& y, Matrix& by_state, double t, Vector& by_time) {
    m.derivatives(y, by_state, t, by_time);
  };
  std::swap(m.before, m.after);
  m.begin = time_;
  const double asked = std::min(m.next_step, m.max_step);
  double tried = std::min(asked, until - time_);
  const bool cut_short = tried < asked;
  const double least = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time_), m.max_step);
  double reached = time_;
  while (m.controller.try_step(std::pair(rates, derivatives), m.before, reached, m.after, tried) !=
         boost::numeric::odeint::success) {
    if (tried > least) continue;
    failure_ = fmt::format("the error stays too large down to steps of {} s", general(tried, 2));
    return false;
  }
  m.controller.stepper().prepare_dense_output();
  // A step cut short by the end says nothing of longer ones.
  m.next_step = cut_short ? std::max(tried, asked) : tried;
  time_ = until - reached <= least ? until : reached;
  state_ = state_of(m.after);
  return true;
}

StiffIntegrator::State StiffIntegrator::at(double t) const {
  Method& m = *method_;
  Vector y(kSize);
  m.controller.stepper().calc_state(t, y, m.before, m.begin, m.after, time_);
  return state_of(y);
}

}  // namespace tribofit
