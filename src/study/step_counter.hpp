#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace tribofit {

/// Counts what several threads have done and reports the part, from one of them at a time.
class StepCounter {
 public:
  StepCounter(std::size_t steps, std::function<void(double)> progress)
      : steps_(steps), progress_(std::move(progress)) {}
  void step() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_(static_cast<double>(++done_) / static_cast<double>(steps_));
  }

 private:
  std::size_t steps_, done_ = 0;
  std::function<void(double)> progress_;
  std::mutex mutex_;
};

}  // namespace tribofit
