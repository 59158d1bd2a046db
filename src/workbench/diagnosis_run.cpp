#include "diagnosis_run.hpp"

#include <algorithm>
#include <exception>
#include <string_view>
#include <utility>

#include "report/diagnosis_sentences.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/statistics/stop.hpp"

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

bool DiagnosisRun::begin(const TraceInput& input, const IdentifyOptions& options, const WorkbenchChoice& part,
                         const std::string& command) {
  const std::lock_guard lock(mutex_);
  if (status_.state == WorkbenchDiagnosis::State::running) return false;
  if (thread_.joinable()) thread_.join();  // it has said its last word
  status_ = {};
  cancelled_ = false;
  // May throw where the machine gives no more threads: then nothing runs. The thread waits for the mutex before it
  // reports.
  thread_ = std::thread([this, input, options, part] { run(input, options, part); });
  status_.state = WorkbenchDiagnosis::State::running;
  status_.command = command;
  status_.doing = "reading slips";
  return true;
}

WorkbenchDiagnosis DiagnosisRun::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void DiagnosisRun::run(const TraceInput& input, const IdentifyOptions& options, const WorkbenchChoice& part) {
  DiagnoseOptions more;
  more.diagnosis.progress = [this](std::string_view doing, double done) {
    const std::lock_guard lock(mutex_);
    status_.doing = doing;
    status_.part = done;
  };
  const auto end_as = [this](WorkbenchDiagnosis::State state, const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    status_.sentence = sentence;
    status_.state = state;
  };
  try {
    const StopScope scope([this] { return cancelled_.load(); });
    const DiagnosedTraces result = diagnose({input}, options, more);
    {
      const std::lock_guard lock(mutex_);
      status_.found = found_by(result, part);
      for (const Rung& rung : result.diagnosis.ladder) {
        status_.ladder.push_back({rung.added, rung.held_out_rmse, rung.held_out_std_error, rung.rmse});
      }
      status_.floor_rmse = result.diagnosis.floor_rmse;
      status_.part = 1;
    }
    end_as(WorkbenchDiagnosis::State::done, diagnosis_verdict(result));
  } catch (const Stopped&) {
    end_as(WorkbenchDiagnosis::State::cancelled, "the diagnosis was cancelled");
  } catch (const std::exception& error) {
    end_as(WorkbenchDiagnosis::State::failed, error.what());
  }
}

}  // namespace tribofit::workbench
