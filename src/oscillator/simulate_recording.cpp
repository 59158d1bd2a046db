#include "tribofit/oscillator/simulate_recording.hpp"

#include <utility>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

Drive true_drive(const Drive& stated, const FrictionModel& model, std::span<const double> p) {
  Drive drive = stated;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (requires { E::speed_swing(q); }) {
      const SpeedSwing swing = E::speed_swing(q);
      drive.speed = rippled_speed(drive.speed, swing.amplitude, swing.order, swing.phase);
    }
    if constexpr (requires { E::true_radius(q, 1.0); }) drive.radius = E::true_radius(q, drive.radius);
  });
  return drive;
}

Sensors true_sensors(const Sensors& stated, const FrictionModel& model, std::span<const double> p) {
  Sensors sensors = stated;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (requires { E::velocity_gain(q); }) sensors.velocity_gain *= E::velocity_gain(q);
    if constexpr (requires { E::velocity_high_pass(q); }) sensors.velocity_high_pass = E::velocity_high_pass(q);
    if constexpr (requires { E::velocity_zero(q); }) sensors.velocity_zero = E::velocity_zero(q);
    if constexpr (requires { E::velocity_low_pass(q); }) sensors.velocity_low_pass = E::velocity_low_pass(q);
    if constexpr (requires { E::velocity_response(q); }) sensors.velocity_response = E::velocity_response(q);
    if constexpr (requires { E::friction_response(q); }) sensors.friction_response = E::friction_response(q);
    if constexpr (requires { E::friction_low_pass(q); }) sensors.friction_low_pass = E::friction_low_pass(q);
    if constexpr (requires { E::clock_drift(q); }) sensors.clock_drift = E::clock_drift(q);
  });
  return sensors;
}

SimulatedChannels recorded_channels(const FrictionModel& model, std::span<const double> p, const Drive& drive,
                                    const Sensors& stated) {
  const Sensors sensors = true_sensors(stated, model, p);
  const Channels needs = model.needs();
  bool senses = sensors.mass_below > 0 || sensors.force_bandwidth > 0 || sensors.friction_delay != 0;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double*) { senses |= hooks::SensorEffect<E>; });
  return {.displacement = sensors.velocity_high_pass > 0,
          .acceleration = needs.acceleration || sensors.mass_below > 0,
          .disc = needs.angle || !drive.speed.constant,
          .distance = needs.distance,
          .relative_velocity = senses};
}

SimulatedRecording simulate_recording(const FrictionModel& model, std::span<const double> p, const Rig& rig,
                                      const Drive& drive, const SimulationOptions& options, const Sensors& sensors) {
  SimulatedRecording hidden;
  hidden.motion = simulate(rig, drive, model, p, options);
  hidden.recording = record(hidden.motion, model, p, sensors);
  hidden.floor_rmse = floor_rmse(hidden.motion, hidden.recording, model, p);
  return hidden;
}

}  // namespace tribofit
