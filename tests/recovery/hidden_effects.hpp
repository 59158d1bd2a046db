#pragma once

/// The benchmark of hidden effects: records in which effects of the catalogue are hidden, diagnosed and judged against
/// what was hidden.
///
/// Every case is made from its own seed, which follows from its name: a case that failed is rerun by name alone, and
/// results do not depend on the number of threads or on which other cases are run.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/friction/model.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"

namespace recovery {

/// How the rig is driven and what is recorded.
enum class Setting {
  fast,                 ///< 12 s at 10 kHz, constant speed: for what happens within a slip
  slow,                 ///< 40 s at 5 kHz, constant speed: for what changes over the record
  both_directions,      ///< 24 s at 10 kHz, the disc swings forth and back; its speed is recorded
  load_swings,          ///< slow, with a load that swings and is recorded
  temperature_swings,   ///< slow, with a temperature that swings and is recorded
  four_speeds,          ///< four records of 20 s at 5 kHz: 1, 2, 4 and 8 rpm, diagnosed together
  pauses,               ///< 60 s at 5 kHz with standstills of different length
  load_both_directions  ///< as load_swings, with a disc that swings forth and back
};
std::string_view to_string(Setting setting);

/// How the disc is driven beyond that.
enum class Programme {
  stick_slip,  ///< as the setting says, on a rig that sticks and slips
  // Speed-controlled sliding, 60 s at 200 Hz: a rig too stiff to stick, the block at rest, the speed of the disc
  // recorded.
  steps,      ///< twelve speeds of 5 s between 1.5 and 90 mm/s
  ramps,      ///< up and down between 5 and 85 mm/s in straight lines
  sines,      ///< as sines
  reversals,  ///< sines about zero, up to 90 mm/s
  strokes,    ///< forth and back at speeds of 10 to 90 mm/s with dwells between them
  constant,   ///< one speed of 9 to 90 mm/s
  points      ///< steady friction at 60 speeds in each direction, no record over time
};

/// What a case is meant to show.
enum class Kind {
  single,      ///< one effect: to be named
  pair,        ///< two effects: both to be named
  triple,      ///< three effects: all to be named
  nothing,     ///< none: nothing to be named
  alien,       ///< what no catalogue holds: to be called unexplained, over the right variable
  unknowable,  ///< an effect that these data cannot show: not to be named
  look_alike,  ///< one effect, to be named apart from one that looks like it after the experiment that tells them apart
  base_law     ///< none, but a law that is not tried first: to be chosen, with nothing beside it
};
std::string_view to_string(Kind kind);

/// An effect that is hidden, and how large.
struct Ingredient {
  std::string key;                           ///< of the catalogue; "hump", "swing" for those of no catalogue
  double size = 0;                           ///< of its first parameter, in the unit of the catalogue
  std::vector<double> values;                ///< of all its parameters in those units
  std::vector<std::size_t> main_parameters;  ///< those that tell
};

/// One case, before it is simulated.
struct Case {
  std::string name;  ///< group and number: "frictional-lag:2:0"
  std::string group;
  Kind kind = Kind::single;
  Setting setting = Setting::fast;
  std::vector<Ingredient> hidden;
  std::string variable;  ///< aliens: the one over which they show
  tribofit::Law law = tribofit::ExponentialLaw{};
  std::vector<double> friction = {0, 0, 0};  ///< parameters of the law [SI]
  tribofit::Rig rig;
  double radius = 0;               ///< [m]
  double speed = 0;                ///< [rad/s]
  double load = 0;                 ///< [N]
  double colour = 0;               ///< AR(1) coefficient of the noise
  bool flicker = false;            ///< noise of friction with a spectrum as 1/f instead
  double scatter = 0, wander = 0;  ///< of mu_s from cycle to cycle [1], its correlation
  double level_scatter = 0;        ///< of all friction of a cycle, as a part of it; then the truth of tests/kinematics
                                   ///< is integrated instead of the library's rig
  std::uint64_t seed = 0;
  std::string record_kind;  ///< of plan_record_kinds(); empty in the others
  Programme programme = Programme::stick_slip;
  double slowness = 1;  ///< of the rig over that of [D]: times grow by it, speeds fall
  double length = 1;    ///< of the record over that of its setting
  double noise = 1;     ///< of the channels over the usual one
  std::string partner;  ///< look-alikes: the one to distinguish it from
};

/// How many cases of each kind.
struct PlanOptions {
  std::size_t runs = 10;      ///< of each effect and size
  std::size_t pairs = 10;     ///< of each pair
  std::size_t triples = 0;    ///< of each three
  std::size_t nothing = 800;  ///< with nothing hidden
  std::size_t aliens = 40;    ///< of each of those in no catalogue
  std::size_t unknowable = 20;
  std::size_t look_alikes = 1;  ///< of each pair and each of its effects
  bool largest_only = false;    ///< of the sizes of an effect
  std::uint64_t seed = 1;
};

std::vector<Case> plan_cases(const PlanOptions& options);

/// The same cases with records half as long, but for those that must turn twice or change slowly: for tests.
std::vector<Case> halved(std::vector<Case> cases);

/// Kinds of record beside those of [D]: programmes of sliding, slow and fast rigs, kinds of noise.
std::vector<std::string> record_kinds();

/// Of each of these kinds (all of them: empty) `empty` records with nothing hidden and `loaded` ones that walk through
/// the effects which the kind can show, in all their sizes (none: no such records). Throws std::invalid_argument for an
/// unknown kind.
std::vector<Case> plan_record_kinds(const std::vector<std::string>& kinds, std::size_t empty, std::size_t loaded,
                                    std::uint64_t seed = 1);

/// Of each of these kinds of sliding (all of them: empty) `records` ones that walk through what is asked of sliding:
/// viscous friction beside Coulomb's and beside Stribeck curves, drift, asymmetry where the record reverses, and a
/// logarithmic law. Throws std::invalid_argument for a kind in which the block sticks.
std::vector<Case> plan_asked_of_sliding(const std::vector<std::string>& kinds, std::size_t records,
                                        std::uint64_t seed = 1);

/// A record of a case.
struct Run {
  Setting setting = Setting::fast;
  double speed = 1;      ///< of that of the case
  double radius = 0;     ///< [m]; 0: that of the case
  double duration = 0;   ///< [s]; 0: that of the setting
  double rate = 0;       ///< [Hz]; 0: that of the setting
  double stiffness = 1;  ///< of that of the rig, whose damping ratio stays
  double load = 1;       ///< of that of the case
  double more_mass = 0;  ///< on the block [kg]
  double reversing = 0;  ///< frequency at which the disc turns forth and back [Hz]; 0: as the setting says
  std::vector<tribofit::Pause> pauses = {};  ///< of the disc

  bool operator==(const Run&) const = default;
};

/// What a person does at the rig beside the record that was made.
struct Experiment {
  std::vector<Run> runs;              ///< diagnosed together with the first record
  std::vector<std::string> measured;  ///< effects of the instruments measured by hand, for the instruments file
  bool empty() const { return runs.empty() && measured.empty(); }
};
Experiment& operator+=(Experiment& all, const Experiment& more);

/// The experiment that discriminating_experiment() of the catalogue names for two effects; empty where it names none.
/// The order of the keys does not matter.
Experiment discriminating_runs(std::string_view key_a, std::string_view key_b);

/// Every pair that has one.
std::vector<std::pair<std::string, std::string>> look_alike_pairs();

/// What the hand finds: the truth of the case within the uncertainty that is declared with it.
tribofit::Instruments measured_by_hand(const Case& c, const std::vector<std::string>& keys);

/// A case as recorded.
struct Simulated {
  tribofit::FrictionModel model{tribofit::ExponentialLaw{}};
  std::vector<double> truth;  ///< parameters of `model` [SI]
  std::vector<std::shared_ptr<const tribofit::Trace>> traces;
  double floor_rmse = 0;  ///< what the true law leaves over slip, all traces together [1]
  tribofit::Instruments instruments = {};
};
/// more: done with the same rig beside the records of the case.
Simulated simulate_case(const Case& c, const Experiment& more = {});

/// A rung of the ladder as it counts here: what was added, and what does as well.
struct Name {
  std::string added;
  std::vector<std::string> equivalent;
};

struct Recovered {
  std::string key, parameter;
  double truth = 0, value = 0, lower95 = 0, upper95 = 0;  ///< in the unit of the catalogue
  double std_error = 0;

  /// false: the data do not bound it, and no interval is given.
  bool has_interval() const { return std::isfinite(std_error); }
  bool is_covered() const { return lower95 <= truth && truth <= upper95; }
};

/// How well what was hidden was named. Of groups larger than four nothing counts as named.
enum class Naming {
  alone,   ///< everything hidden named, each by itself, and nothing else
  group,   ///< everything named, alone or in groups of at most four, and nothing else
  beside,  ///< everything named, but something else too
  partly,  ///< of several, some
  wrong,   ///< only something else
  missed   ///< nothing named
};
std::string_view to_string(Naming naming);

/// The names that a diagnosis gives: its ladder beyond the base law. Effects that show in the motion and not in the
/// error count as named when they were found there, those that correct the plateau as one group.
std::vector<Name> names_of(const tribofit::Diagnosis& diagnosis);

/// What came of a case.
struct Outcome {
  Case tested;
  std::vector<Name> names;  ///< rungs beyond the base law, and effects of the motion that were found
  tribofit::Verdict verdict = tribofit::Verdict::sufficient;
  tribofit::Law law = tribofit::ExponentialLaw{};
  std::string remaining;  ///< variable of the largest remaining share; empty: none
  double remaining_share = 0;
  std::string status;      ///< of the first hidden effect of the catalogue
  std::string experiment;  ///< the next one, as suggested
  Naming naming = Naming::missed;
  std::size_t group_size = 0;             ///< of the largest group that holds a hidden effect
  bool right = false;                     ///< what the kind of the case asks for
  double first = 0, last = 0, floor = 0;  ///< held-out error of the base law and of the last rung; see Simulated [1]
  std::vector<Recovered> parameters;      ///< main parameters of hidden effects that were added
  std::vector<Recovered> known;           ///< the same, all of them, where law and effects are known; if asked for
  std::vector<Recovered> of_law;          ///< of the true law, where it was chosen
  std::vector<std::string> partners;      ///< that the experiment is to distinguish it from; empty: none was made
  std::vector<Name> after;                ///< names after the experiment
  bool split = false;                     ///< it is named apart from all of them then
  double seconds = 0;                     ///< of one processor, for the diagnosis alone
  std::string failure;                    ///< what was thrown
};

struct RunOptions {
  bool experiments = false;  ///< where a single effect was named in a group, the discriminating runs are simulated too
  bool known = false;        ///< the fit with law and effects known is made too
  bool diagnose = true;      ///< false: only that
};

/// Sets naming, group_size and right from what was named.
void judge(Outcome& out);

/// Simulates, diagnoses on one thread and judges. Never throws: what is thrown is in `failure`.
Outcome run_case(const Case& c, const RunOptions& options = {});

/// The diagnosis alone, as run_case() does it.
tribofit::DiagnosedTraces diagnose_case(const Simulated& simulated);

/// Runs cases side by side. done: called after each with the number done, from one thread at a time.
std::vector<Outcome> run_cases(const std::vector<Case>& cases, int threads, const RunOptions& options = {},
                               const std::function<void(const Outcome&, std::size_t)>& done = {});

/// The tables of data/validation/hidden-effects.md, as Markdown.
std::string tables(const std::vector<Outcome>& outcomes);

/// How often intervals of the effects that were named hold the truth: by the number of effects hidden, by noise, by
/// parameter, and overall, as Markdown.
std::string coverage_table(const std::vector<Outcome>& outcomes);

/// A case fitted with the law and the effects it was made with (those of friction), started at the truth.
struct KnownFit {
  tribofit::Fit fit;
  std::vector<double> truth;  ///< of its parameters [SI]
};
/// What the fit does where nothing had to be found first.
KnownFit fit_known(const Simulated& simulated);

}  // namespace recovery
