#include "tribofit/workbench/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "choice_json.hpp"
#include "diagnosis_run.hpp"
#include "report/report_parts.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/statistics/stop.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

using namespace workbench;

namespace {

constexpr std::size_t kMostRungs = 200;

/// A trace with one set of corrections of its motion, and what it said before any part of it was excluded or fitted.
struct Prepared {
  explicit Prepared(Identification prepared)
      : trace(std::move(prepared)),
        notes(trace.notes),
        warnings(trace.warnings),
        segmentation_notes(trace.segmentation.notes),
        analysed(trace.analysed) {}

  Identification trace;
  std::vector<std::string> notes, warnings, segmentation_notes;
  bool analysed;

  /// The trace with the part that is selected, as before any fit.
  Identification& with(const Selection& selection) {
    trace.notes = notes;
    trace.warnings = warnings;
    trace.analysed = analysed;
    trace.segmentation.notes = segmentation_notes;
    trace.segmentation.left_out.clear();
    trace.fits.clear();
    exclude(selection, trace.motion, trace.segmentation);
    const auto said = trace.segmentation.notes.begin() + static_cast<std::ptrdiff_t>(segmentation_notes.size());
    trace.notes.insert(trace.notes.end(), said, trace.segmentation.notes.end());
    return trace;
  }
};

Identification whole_trace(const WorkbenchOptions& options, IdentifyOptions identify) {
  identify.selection = {};
  Identification out = prepare_trace(options.input, identify);
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

bool same_part(const Selection& a, const Selection& b) {
  const auto ends = [](const Selection::Cycles& c) { return std::pair(c.first, c.last); };
  const auto alike = [](const Selection::Stretch& x, const Selection::Stretch& y) {
    return x.from == y.from && x.to == y.to;
  };
  const bool cycles = a.cycles && b.cycles ? ends(*a.cycles) == ends(*b.cycles) : !a.cycles && !b.cycles;
  return cycles && std::equal(a.excluded.begin(), a.excluded.end(), b.excluded.begin(), b.excluded.end(), alike);
}

/// What is drawn beside a rung: the law alone, from the data, fitted to the same part of the record.
const WorkbenchRung* beside(const WorkbenchRung& rung, const std::vector<WorkbenchRung>& rungs) {
  if (rung.fit.model.effects().empty()) return nullptr;
  for (const WorkbenchRung& other : rungs) {
    const bool bare = other.choice.law == rung.choice.law && other.choice.effects.empty() &&
                      other.choice.formulas.empty() && other.choice.given.empty();
    if (bare && same_part(other.choice.selection, rung.choice.selection)) return &other;
  }
  return nullptr;
}

/// The lock, once it is free; who waits for it can be stopped.
std::unique_lock<std::mutex> turn_in(std::mutex& mutex) {
  std::unique_lock lock(mutex, std::try_to_lock);
  while (!lock) {
    stop_point();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    lock.try_lock();
  }
  stop_point();
  return lock;
}

}  // namespace

struct WorkbenchSession::State {
  WorkbenchOptions options;
  std::shared_ptr<const Identification> uncorrected;  ///< the whole trace; set once, so that it needs no lock
  /// Traces prepared for fits of one kind, which are made one at a time. A full fit may take a while; quick ones go on
  /// beside it.
  struct Lane {
    std::mutex fitting;
    std::optional<Prepared> plain, corrected;
    std::vector<std::string> corrections;  ///< of `corrected`, the last that were asked for
  };
  Lane quick, full;
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

  /// The trace with the corrections that the effects ask for and the part that is selected, as before any fit.
  Identification& fresh(const IdentifyOptions& identify, Lane& lane) {
    std::vector<std::string> corrections = corrections_of(identify.effects);
    if (corrections.empty()) {
      if (!lane.plain) lane.plain.emplace(*uncorrected);
      return lane.plain->with(identify.selection);
    }
    if (!lane.corrected || lane.corrections != corrections) {
      lane.corrected.reset();
      lane.corrected.emplace(whole_trace(options, identify));
      lane.corrections = std::move(corrections);
    }
    return lane.corrected->with(identify.selection);
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
                       Identification& trace) const;
};

WorkbenchRung WorkbenchSession::State::fitted(const WorkbenchChoice& choice, const IdentifyOptions& identify,
                                              FitDetail detail, Identification& trace) const {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t said = trace.warnings.size();
  fit_trace(identify, trace);
  WorkbenchRung rung;
  rung.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const bool fits = trace.analysed && !trace.fits.empty() && !trace.fits[0].parameters.empty();
  if (!fits) {
    std::string why = "no fit is possible";
    if (trace.warnings.size() > said) {
      why = trace.warnings.back();
    } else if (!trace.fits.empty() && !trace.fits[0].messages.empty()) {
      why = trace.fits[0].messages.front();
    }
    throw InputError(why, "choose another effect, or more of the record");
  }
  rung.choice = choice;
  rung.detail = detail;
  rung.fit = trace.fits[0];
  return rung;
}

WorkbenchSession::WorkbenchSession(WorkbenchOptions options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = std::move(options);
  s.options.identify.effects.clear();
  s.options.identify.selection = {};
  s.options.identify.fit.given.clear();
  s.options.input.trace = read_input(s.options.input, s.options.identify);
  s.uncorrected = std::make_shared<const Identification>(whole_trace(s.options, s.options.identify));
  const Identification& trace = *s.uncorrected;
  if (!trace.analysed) {
    throw InputError("the data were read but cannot carry an analysis: " + trace.warnings.back(),
                     "`identify` without 'explore' says more", {trace.path, 0, ""});
  }
  if (trace.motion.is_points()) {
    throw InputError("the workbench follows a record over time, and points have none",
                     "`identify` and `identify diagnose` with --report draw them", {trace.path, 0, ""});
  }
  model_of(s.options.begin);
}

WorkbenchSession::~WorkbenchSession() {
  cancel_diagnosis();
}

WorkbenchChoice WorkbenchSession::begin() const {
  const std::lock_guard lock(state_->visited);
  return state_->options.begin;
}

const Identification& WorkbenchSession::trace() const {
  return *state_->uncorrected;
}

WorkbenchPicture WorkbenchSession::show(const WorkbenchChoice& choice, FitDetail detail,
                                        const std::function<bool()>& wanted, bool keep) {
  State& s = *state_;
  State::Lane& lane = detail == FitDetail::full ? s.full : s.quick;
  const StopScope scope(wanted ? [&wanted] { return !wanted(); } : std::function<bool()>());
  const std::unique_lock lock = turn_in(lane.fitting);
  const IdentifyOptions identify = s.identify_options(choice, detail);
  const std::optional<WorkbenchRung> known = s.visited_rung(choice);
  Identification& trace = s.fresh(identify, lane);
  WorkbenchPicture picture;
  if (known && (known->detail == FitDetail::full || detail == FitDetail::quick)) {
    picture.rung = *known;
  } else {
    picture.rung = s.fitted(choice, identify, detail, trace);
    picture.rung.command = command_of(choice);
    if (keep) s.note(picture.rung);
  }
  trace.fits = {picture.rung.fit};  // what note() left, which another page may have fitted more finely meanwhile
  trace.best = 0;
  {
    const std::lock_guard visited(s.visited);
    if (const WorkbenchRung* other = beside(picture.rung, s.rungs)) trace.fits.push_back(other->fit);
  }
  ReportOptions report;
  report.arguments = s.options.arguments;
  const std::vector<std::string> own = arguments_of(picture.rung.choice);
  report.arguments.insert(report.arguments.end(), own.begin(), own.end());
  report.instruments_declared = s.options.instruments_declared;
  picture.report = report_of(trace, report);
  return picture;
}

std::vector<WorkbenchRung> WorkbenchSession::rungs() const {
  const std::lock_guard lock(state_->visited);
  return state_->rungs;
}

std::string WorkbenchSession::command_of(const WorkbenchChoice& choice) const {
  ReportOptions terminal;
  terminal.arguments = state_->options.arguments;
  const std::vector<std::string> own = arguments_of(choice);
  terminal.arguments.insert(terminal.arguments.end(), own.begin(), own.end());
  return command_line(terminal, {}, state_->options.input.path);
}

bool WorkbenchSession::begin_diagnosis(const WorkbenchChoice& choice) {
  State& s = *state_;
  IdentifyOptions identify = s.options.identify;
  identify.selection = choice.selection;
  WorkbenchChoice candidates;
  candidates.formulas = choice.formulas;
  identify.effects = effects_of(candidates);
  for (const std::string& name : choice.effects) {  // corrections of the motion stay as they are
    if (const Effect effect = make_effect(name); is_kinematic(effect)) identify.effects.push_back(effect);
  }
  ReportOptions terminal;
  terminal.arguments = {"diagnose"};
  const auto add = [&](const std::vector<std::string>& more) {
    terminal.arguments.insert(terminal.arguments.end(), more.begin(), more.end());
  };
  add(s.options.arguments);
  WorkbenchChoice part;
  part.formulas = choice.formulas;
  part.selection = choice.selection;
  for (const Effect& effect : identify.effects) {
    if (is_kinematic(effect)) part.effects.push_back(describe(effect).spelled());
  }
  std::vector<std::string> own = arguments_of(part);
  own.erase(own.begin(), own.begin() + 2);  // the law: both climb
  add(own);
  return s.diagnosis.begin(s.options.input, identify, part, command_line(terminal, {}, s.options.input.path));
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
