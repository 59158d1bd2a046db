#pragma once

#include <cstdint>

#include "tribofit/fit/fit.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Noise of the channels of a record as its sensors show it: standard deviations of friction (see Floor) and of v_b,
/// and the correlation of friction in stick from sample to sample, which stands for both channels as Sensors has one.
Sensors noise_of_record(const Motion& motion, const Segmentation& segmentation, const Floor& floor);

/// The same noise in means over `samples` neighbours.
Sensors averaged_noise(Sensors noise, double samples);

/// What all simulated runs take from the record that they go on from.
struct RecordToContinue {
  const Motion* motion = nullptr;
  Sensors noise;  ///< of its samples
  BreakAwayScatter scatter;
  double rate = 0;            ///< of its samples [Hz]
  double simulated_rate = 0;  ///< highest rate that is simulated [Hz]: what is faster is averaged, and shows no more
  /// N0 [N] and T0 [degC] to which the parameters of the models refer; 0 N: the load of the machine.
  double reference_load = 0, reference_temperature = 0;
};

/// A run of a machine as the stages before any fit have it.
struct SimulatedRun {
  Motion motion;
  Segmentation segmentation;
};

/// machine: at the conditions of its record, parameters and rig drawn. Throws InputError for numbers that cannot be
/// simulated, and Stopped.
SimulatedRun simulate_run(Machine machine, const RunConditions& run, const RecordToContinue& record,
                          std::uint64_t seed);

}  // namespace tribofit
