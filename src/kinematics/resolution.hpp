#pragma once

#include <span>

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

}  // namespace tribofit::kinematics
