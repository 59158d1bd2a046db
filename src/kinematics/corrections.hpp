#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Samples at either end that a correction has left without meaning.
struct Ends {
  std::size_t head = 0, tail = 0;
};

/// Four-point Lagrange interpolation between b (u = 0) and c (u = 1).
double interpolated(double a, double b, double c, double d, double u);

/// Shifts a signal in place so that it reads `delay` seconds earlier (cubic interpolation); both ends are held.
void shift_earlier(std::span<double> signal, double delay, double step);

/// Sign, gain, delay and low-pass of the vibrometer; zero, gain, crosstalk and bandwidth of the force sensor, in place.
/// (The high-pass and the mass below the sensor need the plateau and come later.) Says what it did in `notes`.
Ends correct_declared(Trace& trace, const Instruments& instruments, double step, std::vector<std::string>& notes);

/// Adds m_s a_b (over N, for a coefficient) that hangs below the force sensor; `block_velocity` is v_b.
void add_sensor_mass(Trace& trace, std::span<const double> block_velocity, double mass, double step,
                     std::vector<std::string>& notes);

/// Friction opposes sliding: where it is recorded with the other sign throughout, the sign is settled once. `scale`: of
/// the velocity [m/s].
void settle_friction_sign(Motion& motion, double scale);

}  // namespace tribofit::kinematics
