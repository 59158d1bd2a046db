#pragma once

#include <span>

#include "tribofit/friction/model.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// The drive as it is, where effects of the model say that it is not as stated: the speed of the disc swings with its
/// angle, or the radius is another (hooks speed_swing and true_radius of friction/effect.hpp). p: parameters of the
/// model in SI.
Drive true_drive(const Drive& stated, const FrictionModel& model, std::span<const double> p);

/// The sensors with what the model adds to them: gain and high-pass of the vibrometer.
Sensors true_sensors(const Sensors& stated, const FrictionModel& model, std::span<const double> p);

/// The channels without which the motion of that model cannot be recorded by those sensors.
SimulatedChannels recorded_channels(const FrictionModel& model, std::span<const double> p, const Drive& drive,
                                    const Sensors& sensors);

/// A record in which effects are hidden, with the truth.
struct SimulatedRecording {
  SimulatedMotion motion;
  Recording recording;
  double floor_rmse = 0;  ///< what the true law leaves over slip [1], see floor_rmse()
};

/// Simulates and records a rig whose friction is `model` with any effects of the catalogue. Effects of friction and rig
/// act in the motion, those of the instruments on the record only, and the record states radius and speed as `drive`
/// does, not as they are. Throws as simulate() and record() do; costs what they cost.
SimulatedRecording simulate_recording(const FrictionModel& model, std::span<const double> p, const Rig& rig,
                                      const Drive& drive, const SimulationOptions& options = {},
                                      const Sensors& sensors = {});

}  // namespace tribofit
