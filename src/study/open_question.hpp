#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulated_run.hpp"
#include "tribofit/study/identified.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Machines that a record leaves possible.
///
/// The covariance of a fit is no guide to them where a record hardly fixes an effect: of a heating of h = 0.08 +- 0.46
/// over tau = 20 s +- infinity the one that warms nothing is drawn as often as the one that is there, though without
/// one the record is not described. So parameters are drawn as the likelihood allows them, within their bounds, those
/// that are positive uniformly in their logarithm; weakened by kTemper, as the odds between models are.
class PlausibleDraws {
 public:
  PlausibleDraws() = default;
  /// known: of `record`; fit: says to which load and temperature its parameters refer. Cost: several hundred passes
  /// over some values of each slip.
  PlausibleDraws(const IdentifiedMachine& known, const Record& record, const Fit& fit);

  /// One machine; the same for the same seed. Its rig is drawn by the covariance of its fit.
  Machine draw(std::uint64_t seed) const;

 private:
  IdentifiedMachine known_;
  std::shared_ptr<const std::vector<std::vector<double>>> parameters_;  ///< that are possible; none: by covariance
};

/// What a diagnosis leaves open, with what it takes to simulate every answer.
struct OpenQuestion {
  const DiagnosedTraces& diagnosed;
  PlanOptions options;
  QuestionKind kind = QuestionKind::nothing;
  Law law = ExponentialLaw{};
  std::vector<Effect> beside = {};               ///< effects found that are not asked about
  std::vector<Effect> asked = {};                ///< one is there; of QuestionKind::possible one or none
  std::vector<ModelInQuestion> models = {};      ///< for each asked; where possible, the last without any
  std::vector<IdentifiedMachine> machines = {};  ///< for each model
  std::vector<PlausibleDraws> draws = {};        ///< the same
  RecordToContinue record = {};
  std::size_t trace = 0;              ///< whose conditions the runs go on from
  std::string reason = {};            ///< why nothing can be simulated
  std::vector<double> p_values = {};  ///< of effects that are possible, the least first
  /// Held-out squares of each model behind the best by the records so far, over the noise of a difference (see Ruling);
  /// 0 where they are possible.
  std::vector<double> behind = {};

  bool without(std::size_t model) const { return kind == QuestionKind::possible && model == asked.size(); }
  const Identification& own() const { return diagnosed.traces[trace]; }
  std::vector<Record> records() const;  ///< all that were diagnosed
  /// Those of the record that the runs go on from.
  RunConditions own_conditions() const;
};

/// The first group of the ladder that is open, else an effect that is possible.
OpenQuestion open_question(const DiagnosedTraces& diagnosed, const PlanOptions& options);

/// Every experiment that the means allow about a question.
std::vector<Experiment> experiments_for(const OpenQuestion& question, const Means& means);
/// The means of a person who said nothing of them.
Means usual_means(const Identification& trace, double longest);

/// Chance that what is measured by hand tells this answer from all others, beyond three standard uncertainties as for
/// what an instruments file declares. A tap recorded at some rate [Hz] shows an edge that is shifted, or one that is
/// slower than a filter of a quarter of the rate makes it, which a few samples show; the block lifted off the disc
/// shows the zero of the force sensor. truth: index of the model.
double chance_by_hand(const OpenQuestion& question, std::size_t truth, const Experiment& experiment);
/// What it shows, within what can be read off it.
std::vector<Prediction> predict_by_hand(const OpenQuestion& question, const Experiment& experiment);
/// Chance that a value so many of its standard uncertainties from nothing is beyond three of them when it is measured.
double chance_beyond(double sigmas);

/// The runs of an experiment with one machine drawn of the truth; empty where they cannot be simulated. truth: index of
/// the model; draw: which one of its posterior.
std::vector<SimulatedRun> runs_of(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                  std::uint64_t draw);

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
Evidence weigh_draw(const OpenQuestion& question, const Experiment& experiment, std::size_t truth, std::uint64_t draw);

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

/// What a full diagnosis of the records with a simulated one of the experiment comes to. Nothing where they have more
/// than `most_cycles`: a draw whose friction falls far slips many times as often, and takes as many times as long.
enum class Answer { named, open, wrong };
std::optional<Answer> diagnose_simulated(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                         std::uint64_t draw, double most_cycles);

/// What each model predicts to be seen in an experiment: the predictions that are furthest apart first and, where they
/// are asked for, curves.
void predict_seen(const OpenQuestion& question, PlannedExperiment& one, std::vector<PredictedCurves>* curves);

}  // namespace tribofit
