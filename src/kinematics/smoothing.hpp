#pragma once

#include <cstddef>
#include <span>

// Over how many samples the derivatives of a position, or of a pull, are taken.

namespace tribofit::kinematics {

/// Half of the samples over which derivatives are taken where the signal has this natural frequency [rad/s].
std::size_t half_window(double frequency, double step);

/// The natural frequency as the steepest falls of a signal show it [rad/s]: of windows that are not far wider than the
/// frequency found over them calls for, that over which it changes least with the window. Narrower ones see noise,
/// wider ones round the fall. 0 where nothing falls.
double frequency_of_falls(std::span<const double> signal, double step);

}  // namespace tribofit::kinematics
