#include "diagnosis_run.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "report/diagnosis_parts.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit::workbench {

namespace {

/// The last rung, with what was asked for beside it.
WorkbenchChoice found_by(const DiagnosedTraces& result, const WorkbenchChoice& part) {
  WorkbenchChoice out = part;
  out.law = result.diagnosis.law;
  out.formulas.clear();
  if (result.fits.empty()) return out;
  for (const Effect& effect : result.fits[result.best].model.effects()) {
    const auto* formula = std::get_if<Formula>(&effect);
    if (formula == nullptr) {
      out.effects.push_back(describe(effect).spelled());
      continue;
    }
    for (const std::string& text : part.formulas) {
      if (Formula(text).same_as(*formula)) out.formulas.push_back(text);
    }
  }
  return out;
}

}  // namespace

DiagnosisRun::~DiagnosisRun() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

bool DiagnosisRun::begin(DiagnosisRequest request, const std::string& command) {
  const std::lock_guard lock(mutex_);
  if (status_.state == WorkbenchDiagnosis::State::running) return false;
  if (thread_.joinable()) thread_.join();  // it has said its last word
  status_ = {};
  cancelled_ = false;
  request_ = std::move(request);
  // May throw where the machine gives no more threads: then nothing runs. The thread waits for the mutex before it
  // reports.
  thread_ = std::thread([this] { run(); });
  status_.state = WorkbenchDiagnosis::State::running;
  status_.command = command;
  status_.doing = "reading slips";
  return true;
}

bool DiagnosisRun::begin_plan() {
  const std::lock_guard lock(mutex_);
  if (status_.state != WorkbenchDiagnosis::State::done || !status_.leaves_open) return false;
  if (thread_.joinable()) thread_.join();
  cancelled_ = false;
  thread_ = std::thread([this] { plan(); });
  status_.state = WorkbenchDiagnosis::State::running;
  status_.doing = "what is open";
  status_.part = 0;
  return true;
}

WorkbenchDiagnosis DiagnosisRun::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void DiagnosisRun::say(std::string_view doing, double part) {
  const std::lock_guard lock(mutex_);
  status_.doing = doing;
  status_.part = part;
}

void DiagnosisRun::end_as(WorkbenchDiagnosis::State state, const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  status_.sentence = sentence;
  status_.state = state;
}

void DiagnosisRun::run() {
  DiagnoseOptions more;
  more.diagnosis.progress = [this](std::string_view doing, double done) { say(doing, done); };
  try {
    const StopScope scope([this] { return cancelled_.load(); });
    result_ = diagnose({request_.input}, request_.options, more);
    const Diagnosis& found = result_.diagnosis;
    {
      const std::lock_guard lock(mutex_);
      status_.found = found_by(result_, request_.part);
      status_.ladder = found.ladder;
      for (const Rung& rung : found.ladder) status_.leaves_open |= !rung.equivalent.empty();
      for (const EffectFinding& effect : found.effects) {
        status_.leaves_open |= effect.status == EffectStatus::possible;
      }
      // A plan does not know formulas of the user: it would simulate the runs without them.
      const std::vector<Effect>& asked = request_.options.effects;
      const bool any =
          std::any_of(asked.begin(), asked.end(), [](const Effect& e) { return std::holds_alternative<Formula>(e); });
      status_.leaves_open = status_.leaves_open && !any;
      status_.floor_rmse = found.floor_rmse;
      status_.part = 1;
    }
    end_as(WorkbenchDiagnosis::State::done, diagnosis_verdict(result_));
  } catch (const Stopped&) {
    end_as(WorkbenchDiagnosis::State::cancelled, "the diagnosis was cancelled");
  } catch (const std::exception& error) {
    end_as(WorkbenchDiagnosis::State::failed, error.what());
  }
}

void DiagnosisRun::plan() {
  const IdentifyOptions& options = request_.options;
  PlanOptions more;
  more.threads = options.threads;
  more.instruments = options.instruments;
  more.fit = options.fit;
  more.laws = options.laws;
  more.progress = [this](std::string_view doing, double done) { say(doing, done); };
  // The diagnosis stands, whatever comes of the plan.
  using State = WorkbenchDiagnosis::State;
  try {
    const StopScope scope([this] { return cancelled_.load(); });
    const auto section =
        std::make_shared<const ReportSection>(plan_section(result_, plan_runs(result_, more), request_.terminal));
    {
      const std::lock_guard lock(mutex_);
      status_.plan = section;
    }
    end_as(State::done, diagnosis_verdict(result_));
  } catch (const Stopped&) {
    end_as(State::done, diagnosis_verdict(result_) + " The plan was cancelled.");
  } catch (const std::exception& error) {
    end_as(State::done, diagnosis_verdict(result_) + " Nothing could be planned: " + error.what());
  }
}

}  // namespace tribofit::workbench
