#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/fit/residual_variable.hpp"

namespace tribofit {

struct DiagnosisOptions {
  int threads = 0;                          ///< 0: as many as there are; the result does not depend on it
  int most_effects = 4;                     ///< rungs beyond the base law
  std::vector<Effect> from_the_start = {};  ///< of the catalogue, in every model beside the base law
  /// Called now and then with what is being done and the part done (0 to 1), from one thread at a time.
  std::function<void(std::string_view, double)> progress;
  /// When the search for effects ends where it stands. What is known by then is fitted and reported (a moment more),
  /// and the verdict is Verdict::unfinished.
  std::optional<std::chrono::steady_clock::time_point> until = {};
};

/// What the diagnosis says in one word.
enum class Verdict {
  sufficient,       ///< these data ask for no effect more
  effect_found,     ///< effects were added and what remains is noise
  unexplained,      ///< structure remains that no effect explains, or that one may explain but is not proven to
  unconfirmed,      ///< a run that was held back does not bear out the law or the effects that were added
  not_enough_data,  ///< too few cycles to hold any out
  unfinished,       ///< the time was over before every effect was tried (DiagnosisOptions::until)
};
/// "sufficient", "effect-found", "unexplained", "unconfirmed", "not-enough-data", "unfinished".
std::string_view to_string(Verdict verdict);

/// What became of one effect of the catalogue.
enum class EffectStatus {
  found,          ///< it was added to the model
  equivalent,     ///< it fits as well as one that was added; these data cannot distinguish them
  possible,       ///< it would take away much of what remains, and these data do not prove it
  superseded,     ///< it would help alone, but not beside what was added
  not_supported,  ///< the data do not ask for it
  untestable,     ///< the data cannot show it; `reason` says why
  untried,        ///< the time was over before it was tried beside the last rung
};
/// The words of the JSON: "missing" (for found), "equivalent", "possible", "superseded", "unsupported", "untestable",
/// "untried".
std::string_view to_string(EffectStatus status);
/// The same as people read it: "found", "not supported by the data", "not tried".
std::string_view status_text(EffectStatus status);

/// A share of the error above the noise floor that goes with one variable.
struct Share {
  ResidualVariable variable = ResidualVariable::velocity;
  double share = 0;  ///< of the held-out squares above the noise floor that a free function of the variable takes away
  double p_value = 1;  ///< of that fall, over held-out blocks of cycles, corrected for the number of variables
};

/// What the diagnosis found out about one effect.
struct EffectFinding {
  std::string key;
  EffectStatus status = EffectStatus::not_supported;
  double held_out_rmse = 0;    ///< with the effect, at the rung where it was judged last [1 or N]; NaN: not fitted
  double error_reduction = 0;  ///< share of the squares above the noise floor that it takes away there; NaN: not fitted
  double p_value = 1;          ///< that it takes away nothing, corrected for the number of candidates; NaN: not fitted
  std::vector<FitParameter> parameters;  ///< of the last model that held it; empty where not fitted
  std::string reason;                    ///< one sentence
  double held_out_std_error = std::numeric_limits<double>::quiet_NaN();  ///< of held_out_rmse, from cycle to cycle
};

/// One rung of the ladder: the model after an effect was added.
struct Rung {
  std::string added;         ///< key; empty for the base law
  double held_out_rmse = 0;  ///< [1 or N]
  double held_out_std_error = 0;
  double rmse = 0;                      ///< on all data [1 or N]
  std::vector<std::string> equivalent;  ///< effects that fit as well, without `added`
};

/// A finding tried on a run that was not fitted, with every parameter frozen but those that belong to a record (phases,
/// the time of a change), which are found anew.
struct Confirmation {
  std::string path;
  double base_rmse = 0;                                          ///< what the base law leaves there [1 or N]
  double final_rmse = 0;                                         ///< what the last rung leaves there
  double p_value = 1;                                            ///< that the last rung is no better
  double floor_rmse = std::numeric_limits<double>::quiet_NaN();  ///< noise floor of the run itself
};

/// Where a law fails, which effects it needs, and whether it is then enough.
///
/// The rule of evidence. Every effect of the catalogue that the data can excite is added to the model, fitted within
/// bounds on the scale of the record, and judged by the squares it leaves on held-out contiguous blocks of cycles, with
/// the scatter of break-away as a random effect (likelihood); where nothing sticks, forty stretches of the record are
/// the cycles. It is named when both held-out errors fall, that of the likelihood and that of plain squares, when the
/// fall is at least 2 % of what sensor noise leaves, when no decisive parameter sits on a bound, and when p < 0.01. The
/// p-value is the smallest of up to three, times their number, times the number of candidates and of places looked at
/// (Bonferroni): of the fall of the squares (F test whose noise is that between cycles), of the held-out losses cycle
/// by cycle (paired, with a long-run variance; not for spectral lines), and for what goes with the stick time of the
/// levels of break-away. It is the one that is reported. No p-value is smaller than slow noise makes it: what the level
/// of friction does from cycle to cycle beside the model is taken for 1/f noise or an autoregression (slow_noise()), is
/// no less than the 1/f noise that the record shows where no law has to be right (flicker_power()), and counts in the F
/// test as it would move the effect. The best one is added, with those that do as well as its group, until none is
/// left. Where none passes, or one that explains little, candidates are tried two at a time, since each of two slow
/// effects leaves the other as what looks like slow noise: both must pass, each beside the other, and their p-values
/// are multiplied by the number of pairs as well. Every law of the list stands beside the effects found so far at every
/// step, and effects compete beside each: the law is chosen anew with every effect, and an effect is dropped without
/// which some law does as well. The level of all friction, as that of break-away, may differ from cycle to cycle
/// (random effects). Free functions of each variable say where the error is, before and after.
struct Diagnosis {
  Verdict verdict = Verdict::sufficient;
  Law law = ExponentialLaw{};
  /// Laws that these data do not distinguish from it: with the effects of the last rung they predict held-out cycles as
  /// well (p >= 0.05). None beside Coulomb friction, which is a special case of all. Over them the parameters of the
  /// last rung have a range (FitParameter::range).
  std::vector<Law> rival_laws = {};
  std::vector<std::string> from_the_start = {};  ///< effects beside the law on every rung, as the command line has them
  std::vector<Share> where;                      ///< of the base law, largest first
  std::vector<Share> remaining;                  ///< of the last rung, largest first
  std::vector<EffectFinding> effects;            ///< every effect of the catalogue, in its order, then the user's own
  std::vector<Rung> ladder;                      ///< base law first
  double floor_rmse = 0;                         ///< [1 or N]
  bool floor_is_sampling = false;                ///< sensor noise is less than what is not known between two samples
  std::vector<Confirmation> confirmations;
  std::string next_experiment;  ///< one or two sentences
  std::string formula;          ///< a closed form of what remains, as --formula takes it; empty: none
  std::vector<std::string> messages;
  bool runs_differ = false;  ///< the law differs from run to run; the first message says how
};

/// A diagnosis with the fits of its rungs, the base law first.
struct Diagnosed {
  Diagnosis diagnosis;
  std::vector<Fit> fits;
};

struct DiagnoseOptions {
  DiagnosisOptions diagnosis;
  std::vector<TraceInput> confirm;  ///< runs that are held back and on which the finding is tried
};

/// A diagnosis of one trace, or of several together with shared parameters; see pipeline.hpp.
struct DiagnosedTraces {
  std::vector<Identification> traces;  ///< as given; their `fits` are of each trace alone and empty where several are
                                       ///< diagnosed together
  std::vector<Fit> fits;   ///< the bare laws, then the last rung of the ladder where it holds more; all traces together
  std::size_t best = 0;    ///< index in `fits`
  std::vector<Fit> rungs;  ///< the models of the ladder, the base law first
  Diagnosis diagnosis;
  bool analysed = true;  ///< false: some trace cannot carry the analysis, its warnings say why
};

/// Variables a free function of which lowers what a fit leaves on held-out cycles beyond chance, the largest first: an
/// effect is not modelled, whatever the noise floor. Empty too where there are too few cycles to tell. Cost: that of a
/// fit, about. Throws Stopped.
std::vector<ResidualVariable> remaining_over(std::span<const Record> records, const Fit& fit, int threads = 1);

/// Diagnoses one record, or several together with all parameters shared.
/// laws: base laws to start from; own: the user's effects, candidates beside the catalogue.
/// Cost: about 1 s for 100 slips, on two threads. Throws Stopped within a StopScope that says so.
Diagnosed diagnose(std::span<const Record> records, const std::vector<Law>& laws, const std::vector<Effect>& own = {},
                   const Instruments& instruments = {}, const FitOptions& fit = {},
                   const DiagnosisOptions& options = {});

}  // namespace tribofit
