#include "tribofit/workbench/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <utility>

#include "diagnosis_run.hpp"
#include "fit/assessment.hpp"
#include "prepared.hpp"
#include "report/numbers.hpp"
#include "report/report_parts.hpp"
#include "session_json.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

using namespace workbench;

namespace {

constexpr std::size_t kMostRungs = 200;
/// Fits at the same time: more would only take memory from each other.
constexpr int kMostFits = 16;
/// Motions with corrections that are kept: who compares a few effects goes to and fro between them.
constexpr std::size_t kMostCorrected = 3;

/// uncorrected: its motion without corrections, once it is known.
Identification whole_trace(const WorkbenchOptions& options, IdentifyOptions identify, const Motion* uncorrected) {
  identify.selection = {};
  Identification out = uncorrected != nullptr ? prepare_trace(options.input, identify, *uncorrected)
                                              : prepare_trace(options.input, identify);
  out.notes.insert(out.notes.end(), options.notes.begin(), options.notes.end());
  out.warnings.insert(out.warnings.begin(), options.warnings.begin(), options.warnings.end());
  return out;
}

/// Corrections of the motion, whatever the order in which they were switched on.
std::vector<std::string> corrections_of(const std::vector<Effect>& effects) {
  std::vector<std::string> names;
  for (const Effect& effect : effects) {
    if (is_kinematic(effect)) names.push_back(describe(effect).spelled());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// What is drawn beside a rung: the law alone, from the data, fitted to the same part of the record.
const WorkbenchRung* beside(const WorkbenchRung& rung, const std::vector<WorkbenchRung>& rungs) {
  if (rung.fit.model.effects().empty()) return nullptr;
  for (const WorkbenchRung& other : rungs) {
    const bool bare = other.choice.law == rung.choice.law && other.choice.effects.empty() &&
                      other.choice.formulas.empty() && other.choice.given.empty();
    if (bare && selection_json(other.choice.selection) == selection_json(rung.choice.selection)) return &other;
  }
  return nullptr;
}

/// Waits until it is there; who waits can be stopped. try_for: waits so long, and says whether it is.
template <class TryFor>
void wait_for(TryFor&& try_for) {
  do stop_point();
  while (!try_for(std::chrono::milliseconds(5)));
}

/// A fit among a few at the same time.
class FitPlace {
 public:
  using Places = std::counting_semaphore<kMostFits>;
  explicit FitPlace(Places& places) : places_(places) {
    wait_for([&](auto time) { return places.try_acquire_for(time); });
  }
  ~FitPlace() { places_.release(); }
  FitPlace(const FitPlace&) = delete;
  FitPlace& operator=(const FitPlace&) = delete;

 private:
  Places& places_;
};

}  // namespace

struct WorkbenchSession::State {
  WorkbenchOptions options;
  std::shared_ptr<Prepared> uncorrected;  ///< the whole trace; set once, so that it needs no lock
  /// With corrections of its motion: those that were asked for last, the very last at the end.
  std::vector<std::pair<std::vector<std::string>, std::shared_ptr<Prepared>>> corrected;
  std::timed_mutex correcting;  ///< guards them
  FitPlace::Places places{kMostFits};
  WorkbenchRecord record;
  std::vector<WorkbenchRung> rungs;
  mutable std::mutex visited;  ///< guards the rungs and options.begin
  DiagnosisRun diagnosis;

  IdentifyOptions identify_options(const WorkbenchChoice& choice, FitDetail detail) const {
    IdentifyOptions out = options.identify;
    out.laws = {choice.law};
    out.effects = effects_of(choice);
    out.published_protocol = false;
    out.selection = choice.selection;
    out.fit.given = choice.given;
    if (detail == FitDetail::quick) out.fit.starts = 0;
    return out;
  }

  /// What a command line says of a choice.
  ReportOptions terminal(const std::vector<std::string>& verb, const WorkbenchChoice& choice) const {
    ReportOptions out;
    out.arguments = joined(joined(verb, options.arguments), arguments_of(choice));
    out.instruments_declared = options.instruments_declared;
    return out;
  }

  /// The trace with the corrections that the effects ask for.
  std::shared_ptr<Prepared> prepared(const IdentifyOptions& identify) {
    std::vector<std::string> asked = corrections_of(identify.effects);
    if (asked.empty()) return uncorrected;
    std::unique_lock lock(correcting, std::defer_lock);
    wait_for([&](auto time) { return lock.try_lock_for(time); });
    const auto known =
        std::find_if(corrected.begin(), corrected.end(), [&](const auto& one) { return one.first == asked; });
    if (known != corrected.end()) {
      std::rotate(known, known + 1, corrected.end());
    } else {
      if (corrected.size() >= kMostCorrected) corrected.erase(corrected.begin());
      corrected.emplace_back(std::move(asked),
                             std::make_shared<Prepared>(whole_trace(options, identify, &uncorrected->motion())));
    }
    return corrected.back().second;
  }

  std::optional<WorkbenchRung> visited_rung(const WorkbenchChoice& choice) const {
    const std::lock_guard lock(visited);
    for (const WorkbenchRung& rung : rungs) {
      if (same(rung.choice, choice)) return rung;
    }
    return std::nullopt;
  }

  /// Puts a rung into its place among those visited, another page may have been there meanwhile.
  void note(WorkbenchRung& rung) {
    const std::lock_guard lock(visited);
    for (WorkbenchRung& other : rungs) {
      if (!same(other.choice, rung.choice)) continue;
      rung.number = other.number;
      if (other.detail == FitDetail::full) {
        rung = other;
      } else {
        other = rung;
      }
      return;
    }
    if (rungs.size() >= kMostRungs) {
      throw InputError(fmt::format("{} models have been visited; no more are kept", kMostRungs),
                       "save the session and start a new one");
    }
    rung.number = rungs.size();
    rungs.push_back(rung);
  }

  WorkbenchRung fitted(const WorkbenchChoice& choice, const IdentifyOptions& identify, FitDetail detail,
                       const Motion& motion, TracePart& part) const;
};

WorkbenchRung WorkbenchSession::State::fitted(const WorkbenchChoice& choice, const IdentifyOptions& identify,
                                              FitDetail detail, const Motion& motion, TracePart& part) const {
  const std::size_t said = part.warnings.size();
  fit_trace(identify, motion, part);
  WorkbenchRung rung;
  const bool fits = part.analysed && !part.fits.empty() && !part.fits[0].parameters.empty();
  if (!fits) {
    std::string why = "no fit is possible";
    if (part.warnings.size() > said) {
      why = part.warnings.back();
    } else if (!part.fits.empty() && !part.fits[0].messages.empty()) {
      why = part.fits[0].messages.front();
    }
    throw InputError(why, "choose another effect, or more of the record");
  }
  rung.choice = choice;
  rung.detail = detail;
  rung.fit = part.fits[0];
  return rung;
}

WorkbenchSession::WorkbenchSession(WorkbenchOptions options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = std::move(options);
  s.options.identify.effects.clear();
  s.options.identify.selection = {};
  s.options.identify.fit.given.clear();
  s.options.input.trace = read_input(s.options.input, s.options.identify);
  Identification trace = whole_trace(s.options, s.options.identify, nullptr);
  if (!trace.analysed) {
    throw InputError("the data were read but cannot carry an analysis: " + trace.warnings.back(),
                     "`identify` without 'explore' says more", {trace.path, 0, ""});
  }
  if (is_driven_in_steps(trace.motion.kind)) {
    throw InputError("the workbench adds effects to laws of sliding speed; velocity steps and holds have none",
                     "`identify` with --report draws the fitted response", {trace.path, 0, ""});
  }
  if (trace.motion.is_points()) {
    throw InputError("the workbench follows a record over time, and points have none",
                     "`identify` and `identify diagnose` with --report draw them", {trace.path, 0, ""});
  }
  model_of(s.options.begin);
  s.record = {trace.path, trace.segmentation.cycles.size(), trace.segmentation.kind == MotionKind::stick_slip,
              trace_json(trace).dump()};
  s.uncorrected = std::make_shared<Prepared>(std::move(trace));
}

WorkbenchSession::~WorkbenchSession() {
  cancel_diagnosis();
}

WorkbenchChoice WorkbenchSession::begin() const {
  const std::lock_guard lock(state_->visited);
  return state_->options.begin;
}

const WorkbenchRecord& WorkbenchSession::record() const {
  return state_->record;
}

const Motion& WorkbenchSession::motion() const {
  return state_->uncorrected->motion();
}

WorkbenchPicture WorkbenchSession::show(const WorkbenchChoice& choice, FitDetail detail,
                                        const std::function<bool()>& wanted, bool keep) {
  State& s = *state_;
  const StopScope scope(wanted ? [&wanted] { return !wanted(); } : std::function<bool()>());
  const FitPlace place(s.places);
  const IdentifyOptions identify = s.identify_options(choice, detail);
  const std::optional<WorkbenchRung> known = s.visited_rung(choice);
  const std::shared_ptr<Prepared> prepared = s.prepared(identify);
  TracePart part = prepared->part(choice.selection, identify.threads);
  WorkbenchPicture picture;
  if (known && (known->detail == FitDetail::full || detail == FitDetail::quick)) {
    picture.rung = *known;
  } else {
    picture.rung = s.fitted(choice, identify, detail, prepared->motion(), part);
    picture.rung.command = command_of(choice);
    if (keep) s.note(picture.rung);
  }
  part.fits = {picture.rung.fit};  // what note() left, which another page may have fitted more finely meanwhile
  part.best = 0;
  {
    const std::lock_guard visited(s.visited);
    if (const WorkbenchRung* other = beside(picture.rung, s.rungs)) part.fits.push_back(other->fit);
  }
  stop_point();
  ReportOptions report = s.terminal({}, picture.rung.choice);
  report.threads = identify.threads;
  picture.report = prepared->draw(std::move(part), choice.selection, std::move(report));
  return picture;
}

Curve WorkbenchSession::curve(const WorkbenchChoice& choice,
                              const std::vector<std::pair<std::string, double>>& values) const {
  constexpr std::size_t kPoints = 121;
  std::optional<Fit> fit;
  for (WorkbenchRung& rung : rungs()) {
    // What is dragged is a start or a bound of the choice; the fit it is drawn from is of the same model.
    const bool alike = rung.choice.law == choice.law && rung.choice.effects == choice.effects &&
                       rung.choice.formulas == choice.formulas;
    if (alike) fit = std::move(rung.fit);
  }
  if (!fit) throw InputError("this model was not fitted yet", "choose the model first");
  std::fill(fit->covariance.begin(), fit->covariance.end(), 0.0);  // no band about values that were set by hand
  for (const auto& entry : values) {
    const std::string& name = entry.first;
    const auto known = std::find_if(fit->parameters.begin(), fit->parameters.end(),
                                    [&](const FitParameter& p) { return full_name(p) == name; });
    if (known == fit->parameters.end()) {
      throw InputError("the model has no parameter '" + name + "'", "choose the model first");
    }
    known->value = entry.second * known->parameter.si;
  }
  return curve_of(*fit, kPoints);
}

std::vector<WorkbenchRung> WorkbenchSession::rungs() const {
  const std::lock_guard lock(state_->visited);
  return state_->rungs;
}

std::string WorkbenchSession::command_of(const WorkbenchChoice& choice) const {
  return command_line(state_->terminal({}, choice).arguments, {state_->options.input.path});
}

bool WorkbenchSession::begin_diagnosis(const WorkbenchChoice& choice) {
  State& s = *state_;
  WorkbenchChoice part;
  part.formulas = choice.formulas;
  part.selection = choice.selection;
  IdentifyOptions identify = s.options.identify;
  identify.selection = choice.selection;
  identify.effects = effects_of(part);
  for (const Effect& effect : effects_of(choice)) {  // corrections of the motion stay as they are
    if (!is_kinematic(effect)) continue;
    identify.effects.push_back(effect);
    part.effects.push_back(describe(effect).spelled());
  }
  ReportOptions terminal = s.terminal({"diagnose"}, part);
  const auto law = std::find(terminal.arguments.begin(), terminal.arguments.end(), "--law");
  terminal.arguments.erase(law, law + 2);  // both climb
  const std::string command = command_line(terminal.arguments, {s.options.input.path});
  terminal.arguments.erase(terminal.arguments.begin());  // a plan says its own verb
  terminal.inputs = {s.options.input.path};
  return s.diagnosis.begin({s.options.input, identify, part, terminal}, command);
}

bool WorkbenchSession::begin_plan() {
  return state_->diagnosis.begin_plan();
}

void WorkbenchSession::cancel_diagnosis() {
  state_->diagnosis.cancel();
}

WorkbenchDiagnosis WorkbenchSession::diagnosis() const {
  return state_->diagnosis.status();
}

std::string WorkbenchSession::save() const {
  const State& s = *state_;
  Json json = {{"kind", "tribofit workbench"},
               {"tool", tool_json({})},
               {"trace", s.options.input.path},
               {"checksum", fmt::format("{:016x}", s.options.input.trace->checksum)},
               {"arguments", s.options.arguments}};
  json["rungs"] = Json::array();
  for (const WorkbenchRung& rung : rungs()) {
    json["rungs"].push_back({{"choice", choice_json(rung.choice)},
                             {"held_out_rmse", number(rung.fit.error.held_out_rmse)},
                             {"rmse", number(rung.fit.error.rmse)},
                             {"command", rung.command}});
  }
  return text_of(json);
}

namespace {

Json session_json(std::string_view text, const std::string& file) {
  Json json;
  try {
    json = parsed(text, "the session");
  } catch (const InputError& error) {
    throw InputError(error.problem(), error.advice(), {file, 0, ""});
  }
  const bool whole = json.is_object() && json.value("kind", Json()) == "tribofit workbench" &&
                     json.value("trace", Json()).is_string() && json.value("arguments", Json()).is_array() &&
                     json.value("rungs", Json()).is_array() && json.value("checksum", Json()).is_string();
  if (!whole)
    throw InputError("is not a saved session of the workbench", "give a file that its page saved", {file, 0, ""});
  return json;
}

}  // namespace

void WorkbenchSession::load(std::string_view text, const std::string& file) {
  const Json json = session_json(text, file);
  if (json["checksum"] != fmt::format("{:016x}", state_->options.input.trace->checksum)) {
    throw InputError("is a session of another trace: the data differ from those it was saved with",
                     "give the trace it names, " + json["trace"].get<std::string>() + ", as it was", {file, 0, ""});
  }
  for (const Json& rung : json["rungs"]) {
    if (!rung.is_object() || !rung.contains("choice")) continue;
    const WorkbenchChoice choice = choice_from(rung["choice"]);
    show(choice, FitDetail::quick);
    const std::lock_guard lock(state_->visited);
    state_->options.begin = choice;
  }
}

SavedWorkbench saved_workbench(std::string_view text, const std::string& file) {
  const Json json = session_json(text, file);
  SavedWorkbench out;
  out.trace = json["trace"].get<std::string>();
  for (const Json& argument : json["arguments"]) {
    if (!argument.is_string()) throw InputError("holds options that are not texts", "save it again", {file, 0, ""});
    out.arguments.push_back(argument.get<std::string>());
  }
  return out;
}

}  // namespace tribofit
