#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/oscillator/drive.hpp"

namespace tribofit {

/// What can be done at a rig beside what was done.
struct Means {
  std::vector<double> speeds = {};   ///< of the disc [rad/s]
  std::vector<double> radii = {};    ///< [m]
  std::vector<double> loads = {};    ///< [N]
  std::vector<double> springs = {};  ///< their stiffness [N/m]
  std::vector<double> rates = {};    ///< of sampling [Hz]
  double longest = 0;                ///< all runs of one experiment together [s]; 0: kUsualLongest
  double mass_below = 0;             ///< that can be put below the force sensor [kg]; 0: none
  double longest_pause = 0;          ///< for which the disc can be stopped between slides [s]; 0: it cannot
  bool reversing = false;            ///< the disc can turn forth and back
  bool tap = false;                  ///< the block can be tapped
  bool lift = false;                 ///< the block can be lifted off the disc
  bool accelerometer = false;        ///< there is one for the block

  /// Nothing was said but how long a run may take.
  bool empty() const {
    return speeds.empty() && radii.empty() && loads.empty() && springs.empty() && rates.empty() && !(mass_below > 0) &&
           !(longest_pause > 0) && !reversing && !tap && !lift && !accelerometer;
  }
};
inline constexpr double kUsualLongest = 600;  ///< of an experiment where nobody says [s]

/// Conditions of one run.
struct RunConditions {
  double radius = 0, speed = 0, load = 0;  ///< [m], [rad/s], [N]
  double stiffness = 0;                    ///< of the spring [N/m]
  double mass_below = 0;                   ///< put below the force sensor and declared [kg]
  double duration = 0, rate = 0;           ///< [s], [Hz]
  double reversing = 0;                    ///< frequency at which the disc turns forth and back [Hz]; 0: it does not
  std::vector<Pause> pauses = {};          ///< of the disc

  bool operator==(const RunConditions&) const = default;
};

/// Runs that are diagnosed together with what is there, or something that is measured by hand.
struct Experiment {
  std::vector<RunConditions> runs = {};
  /// Rate at which both channels are recorded while the block is tapped; what that shows of them is declared [Hz]. 0:
  /// it is not tapped.
  double tap = 0;
  bool lift = false;           ///< the force sensor is read without contact; its zero is declared
  bool accelerometer = false;  ///< it shows the gain of the vibrometer, which is declared

  bool is_by_hand() const { return runs.empty(); }
  double duration() const;  ///< of all runs [s]
};

/// What the data leave open.
enum class QuestionKind {
  nothing,   ///< one model is left, and nothing is possible beside it
  group,     ///< effects that are not distinguishable
  possible,  ///< an effect that may be there or not
  plateau,   ///< what moves the plateau of stick
};
/// "nothing", "group", "possible", "plateau".
std::string_view to_string(QuestionKind kind);

/// One of the answers.
struct ModelInQuestion {
  std::string name;         ///< the effect that makes it, as the command line has it; empty: nothing more
  Fit fit = {};             ///< to all records
  double probability = 0;   ///< that it is the true one of these, by the held-out errors so far
  std::string reason = {};  ///< why it cannot be simulated; empty where it can
};

/// A value with the range in which 95 % of the records of a model lie.
struct PredictedValue {
  double value = 0, lower95 = 0, upper95 = 0;  ///< SI; NaN: there is none
};

/// What each model predicts to be seen.
struct Prediction {
  std::string name;  ///< "loop of friction over v_r"
  std::string unit;  ///< as people read it
  double si = 1;     ///< value of one unit
  double apart = 0;  ///< by how many of their spreads the models are apart that are furthest
  std::vector<PredictedValue> models = {};
};

/// What each model predicts over a variable, with bands.
struct PredictedCurves {
  std::string name, unit;  ///< of the variable
  double si = 1;
  std::string quantity;  ///< over it; friction [1 or N]
  struct OfModel {
    std::vector<double> x, y, lower95, upper95;
  };
  std::vector<OfModel> models;
};

/// An experiment that was weighed.
struct PlannedExperiment {
  Experiment experiment;
  double probability = 0;                    ///< that it names the true effect, and it alone
  double expected = 0;                       ///< the same from the expected difference of the models, not calibrated
  std::vector<double> of_models = {};        ///< probability if that model is the true one; NaN: not simulated
  std::size_t simulated = 0;                 ///< records of it that were diagnosed in full
  std::size_t named = 0;                     ///< of these, with the true effect alone
  std::size_t wrong = 0;                     ///< of these, with something else
  std::vector<Prediction> predictions = {};  ///< those that are furthest apart first
  std::string reason = {};                   ///< why it shows nothing; empty where it does

  double minutes() const { return experiment.duration() / 60; }
};

/// Which runs settle what a diagnosis leaves open.
struct RunPlan {
  QuestionKind kind = QuestionKind::nothing;
  std::vector<ModelInQuestion> models;         ///< the leader first
  std::vector<PlannedExperiment> experiments;  ///< the best first
  RunConditions own;                           ///< of the record that the runs go on from
  bool usual_means = false;                    ///< none were given
  bool hopeless = false;                       ///< none of the experiments is likely to settle it
  std::vector<PredictedCurves> curves;         ///< for the first experiment
  std::vector<std::string> not_asked;          ///< effects that these records cannot show
  std::vector<std::string> messages;
  std::string reason;  ///< why nothing could be planned; empty where it could, or where nothing is to be settled

  bool answered() const { return reason.empty(); }
};

struct PlanOptions {
  Means means;
  int threads = 0;  ///< 0: as many as there are; the result does not depend on it
  std::uint64_t seed = 1;
  double effort = 1;  ///< of the usual number of records diagnosed in full; 0: none
  Instruments instruments = {};
  FitOptions fit = {};
  std::vector<Law> laws = {};  ///< to start from, as the diagnosis did
  /// Called now and then with what is being done and the part done (0 to 1), from one thread at a time.
  std::function<void(std::string_view, double)> progress = {};
  /// When no more runs are simulated; what is known by then is reported.
  std::optional<std::chrono::steady_clock::time_point> until = {};
};

/// Below this probability, as it is stated, an experiment is not expected to settle anything.
inline constexpr double kHopeless = 0.2;

/// Plans the runs that settle what a diagnosis leaves open.
///
/// Each experiment that the means allow is simulated with every model in question: law and effects drawn as the
/// likelihood of the record allows them within their bounds, the rig by the covariance of its fit, with the noise, the
/// colour of the noise and the scatter of break-away of the records. The simulated runs are judged together with the
/// records by the rule of evidence of the diagnosis. For all experiments the expected difference of the held-out
/// squares between the models (twice a log likelihood ratio, W. G. Hunter, A. M. Reiner, Technometrics 7 (1965) 307,
/// doi:10.2307/1266591; G. E. P. Box, W. J. Hill, Technometrics 9 (1967) 57, doi:10.2307/1266318) gives the chance that
/// the rule distinguishes them, by a normal approximation: with the right one known, what a run adds to that difference
/// has a variance of four times its mean, which grows with the run; each is made as long as is worth it. For the best
/// few the mean is that of several draws. Such a chance is calibrated by what came of the runs of simulated
/// investigations: a few name the effect, or do not, whatever was expected (guesses and lapses of F. A. Wichmann,
/// N. J. Hill, Percept. Psychophys. 63 (2001) 1293, doi:10.3758/bf03194544). Records of the best are diagnosed in full:
/// what is named counts beside the calibrated chance as a beta prior, and the chances of the others are lowered by as
/// much as full diagnoses named less than was expected, until the best of all has been diagnosed in full.
/// Experiments are ranked by probability less a cost for each minute.
///
/// Only stick-slip on a rig that can be identified is simulated; `reason` says why where it cannot be.
/// Cost: some 30 judgements of a few models each and a dozen diagnoses, 10 to 20 s of two processors for a record of
/// 20 s. Throws Stopped within a StopScope that says so.
RunPlan plan_runs(const DiagnosedTraces& diagnosed, const PlanOptions& options = {});

}  // namespace tribofit
