#pragma once

#include <optional>
#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// The runs of an experiment with one machine drawn of the truth; empty where they cannot be simulated. truth: index of
/// the model; draw: which one of its posterior.
std::vector<SimulatedRun> runs_of(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                  std::uint64_t draw, const PlanOptions& options);

/// What the rule of evidence says of the records with a simulated run of one draw of the truth.
struct Evidence {
  bool simulated = true;   ///< false: no run of it could be simulated
  double known = -1;       ///< chance of an experiment that is not simulated; below 0: it is
  double p_value = 1;      ///< of the true effect; where nothing is there, the least of those that are possible
  bool ruled_out = false;  ///< it would not be named though its p-value is small enough: implausible, or too small
  /// By how much the held-out squares of each rival are behind those of the truth, over the noise of a difference (see
  /// Ruling); infinite for a rival that would not be named anyway, and for the truth itself.
  std::vector<double> ahead = {};
  double least_by_size = 0;  ///< see Ruling
};
Evidence weigh_draw(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment,
                    std::size_t truth, std::uint64_t draw, const PlanOptions& options);

/// Runs that are longer than those that were simulated: what they add to a difference grows with them.
struct Lengthening {
  double of_runs = 1;    ///< their length over that of the simulated ones
  double of_cycles = 1;  ///< cycles of all records, over those with the simulated ones
};

/// Chance that all rivals are distinguished, from that of each. Every difference is what a rival leaves less what the
/// true model leaves: they have that in common, half of their variance. One alone counts as it is.
double chance_of_all(const std::vector<double>& chances);

/// Chance that the rule of evidence names the true answer, and it alone, from some draws of it (see plan_runs()).
double chance_to_name(const OpenQuestion& question, std::size_t truth, const std::vector<Evidence>& draws,
                      const Lengthening& lengthening = {});

/// Share of the runs with that expected chance that do name the true effect alone.
double calibrated_chance(double expected);

/// Chance that a value so many of its standard uncertainties from nothing is beyond three of them when it is measured.
double chance_beyond(double sigmas);

/// What a full diagnosis of the records with a simulated one of the experiment comes to. Nothing where they have more
/// than `most_cycles`: a draw whose friction falls far slips many times as often, and takes as many times as long.
enum class Answer { named, open, wrong };
std::optional<Answer> diagnose_simulated(const DiagnosedTraces& diagnosed, const OpenQuestion& question,
                                         const Experiment& experiment, std::size_t truth, std::uint64_t draw,
                                         double most_cycles, const PlanOptions& options);

}  // namespace tribofit
