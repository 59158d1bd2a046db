#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/ingest/conditions.hpp"

namespace tribofit {

/// A contact of rate-and-state friction on a massless spring.
struct RateStateMachine {
  StateEvolution evolution = StateEvolution::ageing;
  std::size_t states = 1;                  ///< state variables that count
  RateStateParameters<double> parameters;  ///< a, b_i, D_i [m], k [1/m]
  double base_friction = 0.6;              ///< mu_0, steady friction at the speed v0 [1]
  double reference_speed = 1e-6;           ///< v0 [m/s]
};

/// Friction of a contact whose load point moves as `phases` say, from steady sliding at the first speed; slip is that
/// of the contact from the begin of the first phase [m].
struct RateStateMotion {
  std::vector<double> friction, slip;
  std::string failure;  ///< why it stops early; empty: it does not
};

/// At `times` [s], ascending, none before the first phase. d mu/dt = k (v_lp - v): without mass, sliding that is not
/// stable runs away, which ends the motion with a failure. Stick-slip needs the mass (oscillator/simulate.hpp).
RateStateMotion simulate_velocity_steps(const RateStateMachine& machine, std::span<const LoadPointPhase> phases,
                                        std::span<const double> times);

}  // namespace tribofit
