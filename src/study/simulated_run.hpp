#pragma once

#include <cstdint>
#include <vector>

#include "motion_measures.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Noise of the channels of a record as its sensors show it: standard deviations of friction (see Floor) and of v_b,
/// and the correlation of friction in stick from sample to sample, which stands for both channels as Sensors has one.
Sensors noise_of_record(const Motion& motion, const Segmentation& segmentation, const Floor& floor);

/// A record as a machine on its drive makes it, by these sensors. sticks: set to whether the block sticks in it.
Trace record_machine(const Machine& machine, const Drive& drive, SimulationOptions options, const Sensors& sensors,
                     bool* sticks = nullptr);
/// Its motion, with nothing to be found out about its channels.
Motion plain_motion(Trace trace, const StickRule& stick);

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

/// Friction of one run over a variable, on a grid that all models share.
enum class RunView { loop, stick_time, time };
struct RunCurve {
  std::vector<double> x, y;
};
/// loop: friction over v_r of the mean slip, at equal parts of it; stick_time: break-away over the stick before it;
/// time: mean friction of the slips over time.
RunCurve curve_of_run(const SimulatedRun& run, RunView view);

/// What a person sees in a run: loop of friction over v_r in time and in distance, break-away, break-away after the
/// longest sticks, least friction in slip, speed of creep in stick, change of friction over the record, swing of
/// friction over a revolution, peak v_r, and frequency.
const std::vector<MotionMeasureInfo>& run_measures();
/// One value each [SI]; NaN where the run does not show it.
std::vector<double> measure_run(const SimulatedRun& run);

}  // namespace tribofit
