#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tribofit/report/study.hpp"

namespace tribofit {

/// What is said of studies on a terminal and on a page alike.

/// "6.283 mm/s (4.000 rpm)".
std::string velocity_text(double velocity, const Machine& machine);

/// A measure in the unit of the files: one less thing to mistake.
std::string measure_text(const Settled& settled, const MeasureInfo& measure);

/// "[1.2, 1.4]" in `unit`; empty where it is not known.
std::string range_text(const Range& range, double unit);

/// "+0.512", "-" where there is none.
std::string elasticity_text(double elasticity);

/// "smoothed by an arctangent of sharpness 10 s/mm".
std::string sharpness_text(const StudiedMachine& of);

/// The numbers of rig and drive, then those of friction, a sentence each.
std::vector<std::string> machine_sentences(const StudiedMachine& of);

/// Where sliding gains or loses its stability, where stick vanishes and comes back, with their 95 % ranges.
std::vector<std::string> critical_sentences(const StudiedMachine& of, const SpeedStudy& study);

/// What is between the two speeds where they differ; empty where they do not.
std::string bistable_sentence(const CriticalSpeed& critical);

/// A(omega) at rest and at the natural frequency.
std::string response_sentence(const StudiedMachine& of, const Response& study);

/// Why a motion did not settle; empty where it did.
std::string seen_sentence(const Settled& settled);

/// What matters most for one measure (an index in measures()): "stiffness (-0.512), mass (+0.5)".
std::string ranking_sentence(const std::vector<Sensitivity>& study, std::size_t measure);

/// At most `most` of `count` rows, evenly, the ends among them.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

}  // namespace tribofit
