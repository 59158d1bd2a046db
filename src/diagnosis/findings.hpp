#pragma once

#include <string>
#include <vector>

#include "probes.hpp"
#include "stepwise.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// What became of every candidate, from the ladder and the fits of its rungs.
/// fits: one a step of the ladder.
std::vector<EffectFinding> findings_of(const DiagnosisContext& context, const Ladder& ladder,
                                       const std::vector<Candidate>& all, const std::vector<Fit>& fits, double floor);

/// Shares of the probes, largest first; those that chance would make too are left out.
/// above: the squares above the noise floor.
std::vector<Share> shares_of(const std::vector<Probe>& probes, double above);

/// Adds the share that goes with the stick, where the last rung explains how the block moves there.
void add_share_of_stick(const Ladder& ladder, double above, std::vector<Share>& shares);

/// What to do next: the test that splits the groups of the ladder, or what remains to be looked at.
std::string next_experiment(const Ladder& ladder, const std::vector<Candidate>& all,
                            const std::vector<Probe>& structure);

/// A closed form of what a probe found, as --formula takes it; empty where none fits.
std::string closed_form(const DiagnosisContext& context, const Trial& top, const Probe& probe);

}  // namespace tribofit::diagnosis
