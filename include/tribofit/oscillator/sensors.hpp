#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tribofit/friction/model.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/instruments/static_response.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// What stands between a motion and its record. Applied in the order of the members; zero (gain: one) means absent.
struct Sensors {
  // The friction channel.
  double mass_below = 0;                  ///< m_s below the force sensor [kg]: mu - m_s a_b/N
  double force_bandwidth = 0;             ///< corner of a second-order low-pass [Hz]
  double force_damping = 0.7;             ///< its damping ratio [1]
  double friction_low_pass = 0;           ///< corner of a first-order low-pass [Hz]
  double friction_delay = 0;              ///< later than the velocity [s]; negative: earlier
  StaticResponse friction_response = {};  ///< its full scale is the largest of the record
  // The velocity channel.
  double velocity_gain = 1;               ///< reading over true velocity [1]
  double velocity_high_pass = 0;          ///< first-order corner [Hz]: dv_m/dt + 2 pi f_c v_m = dv_b/dt
  StaticResponse velocity_response = {};  ///< its full scale is the fastest of the record
  double velocity_low_pass = 0;           ///< first-order corner [Hz]
  double velocity_zero = 0;               ///< reading at rest [m/s]
  double clock_drift = 0;                 ///< by which it runs ahead of friction, over time [1]
  // Both.
  double friction_noise = 0;       ///< standard deviation on mu [1]
  double velocity_noise = 0;       ///< standard deviation on v_b [m/s]
  double noise_colour = 0;         ///< AR(1) coefficient from sample to sample [1], 0 (white) <= colour < 1
  double friction_resolution = 0;  ///< readings are rounded to multiples of it [1]
  double velocity_resolution = 0;  ///< [m/s]
  std::uint64_t seed = 1;
};

/// A record and the noise that went into it.
struct Recording {
  Trace trace;  ///< friction coefficient and block velocity; load, temperature, disc speed where they vary
  std::vector<double> friction_noise, velocity_noise;  ///< [1, m/s]; empty: none
};

/// Records a motion: the effects of the model that belong to the instruments over the whole record, then `sensors`.
/// Radius and a constant speed are stated as the drive states them; the load channel shows the load at the contact.
/// Output depends on the seed only, not on the standard library (mt19937_64, Boost.Random normal).
/// Throws InputError for a negative noise, bandwidth or mass, a gain of zero, a colour outside [0, 1).
Recording record(const SimulatedMotion& motion, const FrictionModel& model, std::span<const double> p,
                 const Sensors& sensors = {});

/// The trace of record(), of a motion that nobody needs any more: its channels become those of the trace.
Trace recorded_trace(SimulatedMotion motion, const FrictionModel& model, std::span<const double> p,
                     const Sensors& sensors = {});

/// What the true law leaves over slip [1]: root mean square of noise and break-away scatter, the noise floor that no
/// law can beat. The law sees the true velocity plus its noise; instruments that distort a channel are not counted. 0
/// where there is no slip sample.
double floor_rmse(const SimulatedMotion& motion, const Recording& recording, const FrictionModel& model,
                  std::span<const double> p);

}  // namespace tribofit
