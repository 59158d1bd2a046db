#pragma once

#include <optional>
#include <span>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::diagnosis {

/// Whether the relative distance of a plateau from where it should be calls for a correction.
bool is_gap(double gap, double std_error);

/// The plateau is not where the stated speed and radius put it, nor within what the declared gain leaves open.
bool plateau_is_off(const Motion& motion, const Instruments& instruments);

/// Two runs at the same stated radius and speed have plateaus that no common radius or gain explains.
bool plateaus_disagree(const Motion& a, const Motion& b);

/// A load that follows friction within every cycle would pass for friction that follows the load.
void remove_load_coupling(Identification& trace);

/// Puts what was found in the motion and in the load channel of the first record, and undone, into a diagnosis: rungs
/// below all others, a finding each, and the test that tells radius and gain apart; for effects of the motion that were
/// not found, why. load_coupling: taken out of the load channel, 0: none. uncorrected: the base law where nothing was
/// undone.
void add_motion(std::span<const Record> records, const Estimate& load_coupling, const Instruments& instruments,
                const std::optional<Fit>& uncorrected, Diagnosis& diagnosis);

}  // namespace tribofit::diagnosis
