#pragma once

#include <span>

#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/health.hpp"

namespace tribofit::kinematics {

/// Steps in which a channel was recorded, in its unit: all values are whole numbers of them. 0 where none show.
double find_resolution(std::span<const double> channel);

/// What rounding to steps of q leaves in a mean level, as a standard deviation: q/sqrt(12) where the noise sigma is far
/// below a step, and exp(-2 pi^2 sigma^2/q^2) of it where noise dithers (B. Widrow, I. Kollar, Quantization Noise,
/// 2008). `spread`: standard deviation of the rounded values.
double rounding_of_level(double step, double spread);

/// Whether values are repeated at uneven places, again and again, that no steps make: the channel was taken through a
/// running median, or from a recorder with a slower clock of its own.
bool repeats_unevenly(std::span<const double> channel);

/// Steps of both channels, 0 where none show, the range of friction and the largest |velocity|.
struct RecordedSteps {
  double friction = 0, velocity = 0, friction_range = 0, largest_velocity = 0;
  bool friction_repeats = false, velocity_repeats = false;
};

/// `noise`: of the velocity in stick [m/s].
HealthItem check_resolution(const RecordedSteps& steps, FrictionKind kind, double noise);

}  // namespace tribofit::kinematics
