#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// What a user of the workbench has switched on.
struct WorkbenchChoice {
  Law law = ExponentialLaw{};
  std::vector<std::string> effects;   ///< as the command line names them: "viscous", "rate-state:healing"
  std::vector<std::string> formulas;  ///< as --formula takes them
  std::vector<GivenParameter> given;  ///< starts and bounds; the law's models without such a parameter take no notice
  Selection selection;
};

/// Why one of them cannot be meant: bounds from high to low, a start beyond the bounds given with it, a value too
/// large to compute with; empty where all can. Asked at both boundaries, the command line and the pages.
std::string contradiction_in(const std::vector<GivenParameter>& given);

/// A model that was visited.
struct WorkbenchRung {
  static constexpr std::size_t passed_by = static_cast<std::size_t>(-1);
  std::size_t number = passed_by;  ///< from 0, in the order of first visits; passed_by: not kept
  WorkbenchChoice choice;
  FitDetail detail = FitDetail::quick;  ///< how finely it has been fitted so far
  Fit fit;
  std::string command;  ///< that fits the same model; at full detail it gives the same numbers
};

/// What a page shows of a rung.
struct WorkbenchPicture {
  WorkbenchRung rung;
  Report report;
};

/// What a diagnosis asked for by a page has come to.
struct WorkbenchDiagnosis {
  enum class State { none, running, done, cancelled, failed };
  State state = State::none;
  std::string doing;      ///< while it runs
  double part = 0;        ///< done, 0 to 1
  std::string sentence;   ///< the verdict, or why it failed
  std::string command;    ///< that makes the same diagnosis
  WorkbenchChoice found;  ///< the last rung of its ladder
  std::vector<Rung> ladder;
  double floor_rmse = 0;                      ///< [1 or N]
  bool leaves_open = false;                   ///< effects are not distinguishable, or one is possible: a run may tell
  std::shared_ptr<const ReportSection> plan;  ///< of the runs that would, once it was asked for
};

/// What pages say of the trace before anything is fitted.
struct WorkbenchRecord {
  std::string path;
  std::size_t cycles = 0;
  bool sticks = false;  ///< it sticks and slips
  std::string json;     ///< what `identify --json` has under "trace"
};

/// What the workbench is begun with.
struct WorkbenchOptions {
  TraceInput input;
  IdentifyOptions identify;  ///< of `effects` none: they are in `begin`
  WorkbenchChoice begin;
  std::vector<std::string> arguments;        ///< options of the command line that are no part of a choice
  std::vector<std::string> notes, warnings;  ///< of the input, beside those of the trace
  bool instruments_declared = false;
};

/// One trace under study: read, moved and segmented once, then fitted again for every choice. Knows nothing of pages
/// and servers. Every function may be called from any thread; fits go on side by side and share the motion.
///
/// A fit is that of identify() for the same choice: from the data and not from what was shown before, so that coming
/// back to a rung gives the same numbers. FitDetail::quick is a look (FitOptions::starts == 0);
/// FitDetail::full is what the command line does, to the last bit.
class WorkbenchSession {
 public:
  /// Reads the trace. Throws InputError, also where the trace cannot carry an analysis.
  explicit WorkbenchSession(WorkbenchOptions options);
  ~WorkbenchSession();  ///< cancels a diagnosis
  WorkbenchSession(const WorkbenchSession&) = delete;
  WorkbenchSession& operator=(const WorkbenchSession&) = delete;

  WorkbenchChoice begin() const;
  /// The whole trace as it was prepared, without corrections and fits.
  const WorkbenchRecord& record() const;
  const Motion& motion() const;

  /// Fits a choice and adds it to the rungs; one that was visited is not fitted again unless more detail is asked for.
  /// Throws InputError that says why it cannot be fitted; the session goes on.
  /// wanted: asked while it waits for its turn and while it fits; where it says no, Stopped is thrown. Empty: yes.
  /// keep: false for what is passed by on the way, as a slider is dragged: it becomes no rung.
  WorkbenchPicture show(const WorkbenchChoice& choice, FitDetail detail, const std::function<bool()>& wanted = {},
                        bool keep = true);

  /// The law of a choice that was shown, over |v_r|, with some of its parameters set by hand: name and value [as tables
  /// show it]. Nothing is fitted. Throws InputError for a choice that was not shown and a parameter that it does not
  /// have.
  Curve curve(const WorkbenchChoice& choice, const std::vector<std::pair<std::string, double>>& values) const;

  /// Every rung visited, without pictures.
  std::vector<WorkbenchRung> rungs() const;

  /// The command that fits the choice.
  std::string command_of(const WorkbenchChoice& choice) const;

  /// Begins a diagnosis of the selected part of the record, with its formulas as candidates beside the catalogue.
  /// False where one is running already.
  bool begin_diagnosis(const WorkbenchChoice& choice);
  void cancel_diagnosis();
  /// Plans the runs that settle what that diagnosis left open; false where it left nothing open, or one runs.
  bool begin_plan();
  WorkbenchDiagnosis diagnosis() const;

  /// The session as JSON: trace with its checksum, options, choices in order.
  std::string save() const;
  /// Visits the choices of a saved session again. Throws InputError where it is of another trace or no session.
  void load(std::string_view json, const std::string& file);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a saved session says of its beginning: options and trace, for the command line. Throws InputError.
struct SavedWorkbench {
  std::vector<std::string> arguments;
  std::string trace;
};
SavedWorkbench saved_workbench(std::string_view json, const std::string& file);

}  // namespace tribofit
