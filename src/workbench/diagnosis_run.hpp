#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// What a diagnosis is asked for with.
struct DiagnosisRequest {
  TraceInput input;
  IdentifyOptions options;
  WorkbenchChoice part;    ///< selection and formulas, which the model found keeps
  ReportOptions terminal;  ///< the same as a command line has it
};

/// One diagnosis at a time, beside the fits that pages ask for.
class DiagnosisRun {
 public:
  DiagnosisRun() = default;
  ~DiagnosisRun();
  DiagnosisRun(const DiagnosisRun&) = delete;
  DiagnosisRun& operator=(const DiagnosisRun&) = delete;

  /// command: that makes the same diagnosis. False where one runs already.
  bool begin(DiagnosisRequest request, const std::string& command);
  /// Plans the runs that settle what the diagnosis left open (study/plan.hpp), with the usual means. False where it
  /// left nothing open, or something runs already.
  bool begin_plan();
  /// Has it give up; it does so within a trial.
  void cancel() { cancelled_ = true; }
  WorkbenchDiagnosis status() const;

 private:
  void run();
  void plan();
  void say(std::string_view doing, double part);
  void end_as(WorkbenchDiagnosis::State state, const std::string& sentence);

  mutable std::mutex mutex_;
  WorkbenchDiagnosis status_;
  DiagnosisRequest request_;  ///< of the last diagnosis
  DiagnosedTraces result_;    ///< of a diagnosis that is done; the thread's own while one runs
  std::atomic<bool> cancelled_{false};
  std::thread thread_;
};

}  // namespace tribofit::workbench
