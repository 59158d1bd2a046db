#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// One diagnosis at a time, beside the fits that pages ask for.
class DiagnosisRun {
 public:
  DiagnosisRun() = default;
  ~DiagnosisRun();
  DiagnosisRun(const DiagnosisRun&) = delete;
  DiagnosisRun& operator=(const DiagnosisRun&) = delete;

  /// part: selection and formulas, which the model found keeps. False where one runs already.
  bool begin(const TraceInput& input, const IdentifyOptions& options, const WorkbenchChoice& part,
             const std::string& command);
  /// Has it give up; it does so within a trial.
  void cancel() { cancelled_ = true; }
  WorkbenchDiagnosis status() const;

 private:
  void run(const TraceInput& input, const IdentifyOptions& options, const WorkbenchChoice& part);

  mutable std::mutex mutex_;
  WorkbenchDiagnosis status_;
  std::atomic<bool> cancelled_{false};
  std::thread thread_;
};

}  // namespace tribofit::workbench
