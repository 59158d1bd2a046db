#pragma once

#include <string>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/report/chart.hpp"
#include "tribofit/segmentation/slip_branches.hpp"

namespace tribofit {

/// Fits that are drawn.
struct DrawnLaws {
  std::vector<const Fit*> models = {};  ///< beside the samples, the one to look at first
  std::vector<const Fit*> curves = {};  ///< whose law is drawn over speed: the models, and others
};

/// What the charts of one trace share: its samples, and what each model says of every one of them.
struct DrawnTrace : DrawnLaws {
  const Identification& trace;
  std::string id;                                ///< begins the ids of the charts
  double share;                                  ///< part of the points of a page that this trace may have
  std::vector<std::vector<double>> predictions;  ///< of each model, NaN outside slips
  std::vector<SlipBranch> pieces;                ///< of the slips
  double fastest = 0, slowest = 0;               ///< |v_r| of them, and of all samples [mm/s]; 0 where nothing slips
  int threads;                                   ///< that draw side by side

  DrawnTrace(const Identification& identification, const DrawnLaws& laws, std::string prefix, double part = 1,
             std::size_t record = 0, int draw_on = 1);
  /// Points that a series of this trace may have where a trace alone has `whole`.
  std::size_t bins(std::size_t whole) const;
};

/// Three cycles with stick and slip shaded, and what happens within a tenth of a slip of a break-away and a re-stick;
/// the whole record where there are no three cycles. All series are reduced so that no peak is lost.
std::vector<Chart> cycle_charts(const DrawnTrace& drawn);
/// Friction levels, peak velocities and durations of each cycle, the spectrum of v_r, and behind three cycles the whole
/// record.
std::vector<Chart> measure_charts(const DrawnTrace& drawn);

/// Friction over |v_r|: branches as bands over cycles, laws with their 95 % bands, residuals in units of the noise
/// floor. Of steady points each is a symbol with its standard error; over the logarithm of the speed where they reach
/// over two decades. Shows nothing where nothing slips.
Chart law_chart(const DrawnTrace& drawn);
/// Relative errors ([D] Eq 5) over speed and time (points have none), and the map of residuals over cycle and phase of
/// the slip.
std::vector<Chart> error_charts(const DrawnTrace& drawn);
/// Profile likelihoods of the parameters of a fit, where they were asked for.
std::vector<Chart> profile_charts(const Fit& fit, const Motion& motion, const std::string& id);

/// Axis of friction levels; part: see ChartAxis.
ChartAxis friction_axis(const Motion& motion, double part = 1);

}  // namespace tribofit
