#pragma once

#include <span>

#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Writes what Fig 5 to 12 of [D] show, from the runs of a campaign, into figures/ in the folder of its results:
///
/// 05-rms-velocity.csv          RMS of the velocity of the block: mean over repeats and its standard error
/// 06-08-three-cycles.csv       v_r and friction over time
/// 07-spectrum.csv              amplitude spectrum of v_r
/// 07-harmonics.csv             amplitude of the fundamental of v_r and of its multiples
/// 09-static-kinetic.csv        mu_s, mu_k and their difference: mean over repeats and its standard error, each law and
///                              protocol
/// 10-12-over-velocity.csv      measured and fitted friction and relative error (Eq 5) in bins of v_r, each law and
///                              protocol
/// 12-relative-error.csv        the same over all slip samples, with the share below 0.08
///
/// A row begins with the run (or the number of runs) and its conditions; units stand in the names of the columns.
/// Each file appears whole or not at all. `runs` are those of `results`, `groups` their repeats. Throws WriteError.
/// Cost: linear in runs; memory does not grow with them.
void write_figures(const ResultReader& results, std::span<const RunResult> runs, std::span<const PooledGroup> groups);

}  // namespace tribofit
