#include "tribofit/oscillator/velocity_steps.hpp"

#include "rate_state_slider.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

void refuse_impossible(const RateStateMachine& machine, std::span<const LoadPointPhase> phases) {
  const auto positive = [](double value, const char* what) {
    if (value > 0 && std::isfinite(value)) return;
    throw InputError(std::string(what) + " is not above zero", "give a positive value");
  };
  positive(machine.parameters.a, "the direct effect a");
  positive(machine.parameters.stiffness, "the stiffness k");
  positive(machine.reference_speed, "the reference speed v0");
  for (std::size_t i = 0; i < machine.states; ++i) positive(machine.parameters.distance[i], "the distance D_c");
  if (phases.empty()) throw InputError("the load point has no speed", "give at least one");
  positive(phases.front().speed, "the first speed of the load point");
}

}  // namespace

RateStateMotion simulate_velocity_steps(const RateStateMachine& machine, std::span<const LoadPointPhase> phases,
                                        std::span<const double> times) {
  refuse_impossible(machine, phases);
  RateStateMotion out;
  out.friction.resize(times.size());
  const auto run = [&]<std::size_t kStates>() {
    return oscillator::slide_under<double, kStates>(machine.evolution, machine.parameters, machine.reference_speed,
                                                    phases, times, out.friction.data());
  };
  const bool whole = machine.states == 1 ? run.template operator()<1>() : run.template operator()<2>();
  if (!whole) {
    out.friction.clear();
    out.failure =
        "the sliding runs away: the machine is softer than friction needs for stable sliding, and without mass nothing "
        "limits the speed";
    return out;
  }
  double rate = 0;
  for (std::size_t i = 0; i < machine.states; ++i) rate += machine.parameters.b[i];
  const double first = (machine.parameters.a - rate) * std::log(phases.front().speed / machine.reference_speed);
  double displacement = 0;
  std::size_t phase = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    while (phase + 1 < phases.size() && phases[phase + 1].begin <= times[i]) {
      displacement += phases[phase].speed * (phases[phase + 1].begin - phases[phase].begin);
      ++phase;
    }
    const double moved = displacement + phases[phase].speed * (times[i] - phases[phase].begin);
    out.slip.push_back(moved - (out.friction[i] - first) / machine.parameters.stiffness);
    out.friction[i] += machine.base_friction;
  }
  return out;
}

}  // namespace tribofit
