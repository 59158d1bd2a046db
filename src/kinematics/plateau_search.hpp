#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plateau.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// The one that is known, the first before the second.
const Condition& first_known(const Condition& a, const Condition& b);

/// Largest magnitude; 0 when empty.
double largest_of(std::span<const double> values);

/// omega r of every sample, or one value for all.
struct Disc {
  bool known = false;
  double constant = 0;
  std::vector<double> varying;  ///< empty when constant
  double largest = 0;           ///< |omega r|
};

/// omega r as stated for the trace or its steps, or from the recorded speed of the disc.
Disc disc_of(const Trace& trace);

/// The velocity in blocks, where it rests, and what its noise is.
struct PlateauSearch {
  BlockMeans blocks;  ///< of v_b, or of v_r where that was measured
  BlockMeans disc;    ///< of omega r, where it varies
  Plateaus plateaus;  ///< of blocks minus disc where that varies, else of blocks
  double noise = 0;   ///< [m/s]
  bool sticks = false;
};

/// What is merely slow is no plateau: where v_r was measured, or the speed of the disc varies, the block must be at
/// rest on the disc (within its noise, or moving with it by half at least), or friction must load up as a spring loads
/// it. stick: what the user says of it.
PlateauSearch search_plateaus(const Trace& trace, const Disc& disc, double step, const StickRule& stick);

/// Whether the plateau runs against the disc, or against friction where the direction of the disc is not known.
bool points_the_other_way(const Trace& trace, const Disc& disc, const PlateauSearch& search);

/// Where v_b rests, and what the recorded speed says there [m/s].
struct RecordedPlateau {
  double block = 0, disc = 0;
};

/// Where v_b rests beside a recorded speed; nothing where there is none, or no plateau. A record whose plateaus follow
/// the recorded speed is compared there; where none do, or far from it, the plateaus of v_b alone tell what the disc
/// did.
std::optional<RecordedPlateau> recorded_plateau(const PlateauSearch& search, const Disc& disc, VelocityKind kind);

/// The level towards which the plateaus tend: median over the second half of the record [m/s].
double final_level(const Plateaus& plateaus);

/// The plateaus that samples [trimmed, trimmed + size) still hold, in blocks from there.
Plateaus plateaus_within(const PlateauSearch& search, std::size_t trimmed, std::size_t size);

/// The one stated speed of the whole record [rad/s], NaN where there are several or it was recorded.
double steady_speed(const Trace& trace);

/// Makes the blocks and plateaus those that a disc at one speed would have shown. factor: of its speed, every sample.
void flatten(PlateauSearch& search, std::span<const double> factor);

/// Gives omega r, and speed and angle of the disc where they are known, a factor.
void impose(std::vector<double> factor, double omega, Trace& trace, Disc& disc);

/// Blocks before the plateau comes within 2 % of its final value and stays there.
std::size_t run_up_blocks(const PlateauSearch& s);

}  // namespace tribofit::kinematics
