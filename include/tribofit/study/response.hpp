#pragma once

#include <vector>

#include "tribofit/study/settled.hpp"

namespace tribofit {

/// One line of the spectra of settled motion.
struct ResponseLine {
  double frequency = 0;     ///< [Hz]
  double force = 0;         ///< amplitude of the friction force N mu [N]
  double displacement = 0;  ///< amplitude of x [m]
  double velocity = 0;      ///< amplitude of x' [m/s]
};

/// What the rig makes of a force, and the spectra of the motion that friction drives it into.
struct Response {
  double natural_frequency = 0;         ///< sqrt(k/m)/(2 pi) [Hz]
  double damped_natural_frequency = 0;  ///< sqrt(1 - D^2) times that, D the damping ratio [C] [Hz]; 0 where D >= 1
  double force = 0;                     ///< F of the curve: amplitude of the fundamental of the friction force [N]
  std::vector<double> frequency;        ///< of the curve [Hz]
  std::vector<double> amplitude;        ///< A(omega) = F/sqrt((k - m omega^2)^2 + (c omega)^2) [C] [m]
  double amplitude_at_rest = 0;         ///< A(0) [m]
  double amplitude_at_natural = 0;      ///< A(sqrt(k/m)) [m]
  Settled settled;
  std::vector<ResponseLine> harmonics;  ///< fundamental first; empty where nothing vibrates
};

/// The spectra are those of whole settled cycles, so their lines stand at multiples of the response frequency and
/// nothing leaks between them; displacement and force of each line are bound by A(omega), which tests the simulation.
/// Without settled cycles F is N (mu_s - mu_k)/2. Throws as settle() does.
Response study_response(const Machine& machine, std::size_t harmonics = 20, const SettleOptions& options = {});

/// A motion in the plane of displacement and velocity.
struct Portrait {
  double velocity = 0;  ///< omega r [m/s]
  Settled settled;
  SimulatedMotion start;  ///< from where it begins, over the first cycles (natural periods where nothing sticks)
  SimulatedMotion cycle;  ///< one settled cycle, break-away first; empty where nothing repeats
};

struct PortraitOptions {
  std::size_t cycles = 6;      ///< of the start
  std::size_t samples = 1000;  ///< a cycle; of the start fewer where that would be more than a million
  SettleOptions settle = {};
};

/// Portraits at speeds omega r [m/s]. Throws as settle() does.
std::vector<Portrait> study_phase(const Machine& machine, const std::vector<double>& velocity,
                                  const PortraitOptions& options = {});

}  // namespace tribofit
