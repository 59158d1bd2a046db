#pragma once

#include <vector>

#include "motion_measures.hpp"
#include "simulated_run.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// What a person sees in a run: loop of friction over v_r in time and in distance, break-away, break-away after the
/// longest sticks, least friction in slip, speed of creep in stick, change of friction over the record, swing of
/// friction over a revolution, peak v_r, and frequency.
const std::vector<MotionMeasureInfo>& run_measures();
/// One value each [SI]; NaN where the run does not show it.
std::vector<double> measure_run(const SimulatedRun& run);

/// Friction of one run over a variable, on a grid that all models share.
enum class RunView { loop, stick_time, time };
struct RunCurve {
  std::vector<double> x, y;
};
/// loop: friction over v_r of the mean slip, at equal parts of it; stick_time: break-away over the stick before it;
/// time: mean friction of the slips over time.
RunCurve curve_of_run(const SimulatedRun& run, RunView view);

}  // namespace tribofit
