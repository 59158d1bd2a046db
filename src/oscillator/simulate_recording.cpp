#include "tribofit/oscillator/simulate_recording.hpp"

#include <type_traits>
#include <utility>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

Drive true_drive(const Drive& stated, const FrictionModel& model, std::span<const double> p) {
  Drive drive = stated;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (std::is_same_v<E, SpeedRipple>) drive.speed = rippled_speed(drive.speed, q[0], q[1], q[2]);
    if constexpr (std::is_same_v<E, RadiusOffset>) drive.radius *= q[0];
  });
  return drive;
}

Sensors true_sensors(const Sensors& stated, const FrictionModel& model, std::span<const double> p) {
  Sensors sensors = stated;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (std::is_same_v<E, VelocityGain>) sensors.velocity_gain *= q[0];
    if constexpr (std::is_same_v<E, VelocityHighPass>) sensors.velocity_high_pass = q[0];
  });
  return sensors;
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
