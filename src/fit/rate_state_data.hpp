#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/fit/rate_state.hpp"

namespace tribofit::fit {

/// The samples of velocity steps, and how the load point moved.
struct RateStateData {
  std::vector<LoadPointPhase> phases;
  std::vector<double> phase_displacement;  ///< of the load point at the begin of each phase [m]
  std::vector<VelocityStep> steps;
  std::vector<std::size_t> before;   ///< of each step: the phase of sliding before it, or the longest of several
  std::vector<std::size_t> leaving;  ///< the first phase that is not of that sliding
  std::vector<std::size_t> behind;   ///< the first phase of sliding behind it
  double reference_speed = 0;        ///< v0 [m/s]
  bool is_force = false;             ///< friction is in newtons

  /// Values, each the mean of `count` samples, in order of time; those of step s begin at begins[s]. scatter: squares
  /// of the samples about their mean, summed.
  std::vector<double> time, displacement, friction, count, scatter;
  std::vector<std::size_t> begins;

  std::size_t size() const { return time.size(); }
  std::size_t end_of(std::size_t step) const { return step + 1 < begins.size() ? begins[step + 1] : size(); }
  void set_phase_displacements();  ///< from the phases
  /// Of the load point at a time [m].
  double displacement_at(double t) const;
};

/// The shorter sliding beside a step, as far as its samples lie in it [s].
double shorter_beside(const VelocityStep& step);

/// Steps of a record with their samples. most: values of each step; neighbours are put together where there are more,
/// the closer to a change of speed the fewer. What cannot be used is said in `messages`.
RateStateData rate_state_data(const Motion& motion, const RateStateOptions& options, std::size_t most,
                              std::vector<std::string>& messages);

/// The same steps with fewer values, for a first search.
RateStateData thinned(const RateStateData& data, std::size_t most);

}  // namespace tribofit::fit
