#include "tribofit/oscillator/steady_sliding.hpp"

#include <algorithm>
#include <cmath>

#include "simulation_checks.hpp"
#include "slip_flow.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

SteadySliding steady_sliding(const Machine& machine) {
  const Drive stated = machine.drive();
  check_simulation(machine.rig, stated, machine.model, machine.parameters, {});
  const Setup setup(machine.rig, true_drive(stated, machine.model, machine.parameters), machine.model);
  const double disc = setup.disc_velocity(0);
  if (!(disc > 0)) {
    throw InputError("the disc does not turn forwards: no steady sliding", "give a speed above zero, e.g. 4rpm");
  }
  FrictionDynamics friction(machine.model, machine.parameters);
  friction.begin_slip(0, 1);
  SlipFlow flow(setup, friction);
  BlockState y{};
  flow.begin(0, y, 1, 0, 0);
  flow.steady_memories(0, y);

  SteadySliding out;
  out.friction = flow.friction(0, y);
  require(std::isfinite(out.friction), "friction at " + general(1e3 * disc) + " mm/s is not a finite number",
          "check the formulas and the parameters of the effects");
  out.displacement = setup.load(0) * out.friction / machine.rig.stiffness;
  y[0] = setup.natural_frequency * out.displacement;

  const auto n = static_cast<Eigen::Index>(2 + friction.state_count());
  Eigen::MatrixXd jacobian(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    constexpr double kStep = 1e-4;
    const double step = kStep * (k < 2 ? disc : std::max(std::abs(y[at]), 1e-12));
    BlockState low = y, high = y, below, above;
    low[at] -= step;
    high[at] += step;
    flow(low, below, 0);
    flow(high, above, 0);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      jacobian(i, k) = (above[row] - below[row]) / (2 * step);
    }
  }
  const Eigen::VectorXcd values = eigenvalues(jacobian);
  out.eigenvalues.assign(values.data(), values.data() + n);
  std::sort(out.eigenvalues.begin(), out.eigenvalues.end(), [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return out;
}

}  // namespace tribofit
