#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "low_pass.hpp"
#include "plateau.hpp"
#include "plateau_search.hpp"
#include "rest_model.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// What became of the high-pass search. `declared` is the declared corner, if any.
HealthItem check_sagging(const RestModel& rest, std::optional<double> declared, bool undone, bool sticks);

/// Frequency up to which friction and velocity rise above their floor, and whether they are filtered above it.
/// velocity: where it was measured; restick: what it showed where it comes to rest.
HealthItem check_bandwidth(const Motion& motion, std::span<const double> velocity, const LowPass& restick);

/// Friction brakes what slides: where it is negative though its sign is right, its zero is wrong.
HealthItem check_friction_zero(const Motion& motion);

HealthItem check_revolutions(const Motion& motion);

/// What became of the search for a ripple of the disc's speed.
HealthItem check_speed_ripple(const Motion& motion, const RestModel& rest);

/// v_r as measured against rest in stick and, on average, omega r.
HealthItem check_measured_velocity(const Motion& motion, const Plateaus& plateaus, std::size_t factor);

HealthItem check_run_up(const Motion& motion, bool trim, std::size_t found);

/// Plateau of v_b against the stated omega r, or against the recorded one.
HealthItem check_plateau_speed(const Motion& motion, double plateau, bool speed_was_stated, bool radius_known,
                               const std::optional<RecordedPlateau>& recorded);

}  // namespace tribofit::kinematics
