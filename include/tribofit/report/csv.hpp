#pragma once

#include <string>

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp
struct Identification;

/// Writes a result as CSV files for plotting, all of them or none; the folder is made when it is missing.
///
/// samples.csv  every sample with the best fit: time_s, relative_velocity_mm_s, mu, mu_model (empty outside slip),
///              phase (stick|slip), cycle, held_out_fold (both from 0; empty outside the cycles that were fitted)
/// cycles.csv   the measures of each cycle
/// curves.csv   mu(v) of every fit with its 95 % band, to a quarter beyond the fastest slip
/// errors.csv   residual and relative error ([D] Eq 5) of the best fit against time and v_r, slip samples only
///
/// Of velocity steps and holds two others:
/// response.csv the values that were fitted: step_number, time_s, load_point_um, mu, mu_model, mu_other (the other law)
/// steps.csv    each step: its time, speeds and hold, mu_0 and trend, and the parameters of its own fit with their
///              standard errors
///
/// Where friction is a force, mu and mu_model are in newtons, as "friction_unit" in the JSON says; other columns carry
/// their unit in the name. Throws WriteError when the disc is full or the folder cannot be written. Cost: linear in
/// samples.
void write_csv_folder(const std::string& folder, const Identification& result);

/// The same for the final model of a diagnosis. Of several traces each has a folder of its own in `folder`, named like
/// its file (with -2, -3 behind the name where files of several folders share it).
void write_csv_folder(const std::string& folder, const DiagnosedTraces& result);

}  // namespace tribofit
