#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

namespace tribofit {

/// Thrown where work is given up because a StopScope said so. What it was to make is not made.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "the work was stopped before its end"; }
};

/// While it lives, the work of its thread, and of the threads that help it (HelperThreads), can be stopped: fits,
/// diagnoses and simulations ask it every few milliseconds, and throw Stopped once it says yes. Scopes are nested as
/// blocks are; each of them can stop the work within.
///
///     const StopScope scope([&] { return cancelled.load(); });
///     diagnose(...);  // throws Stopped soon after cancelled became true
class StopScope {
 public:
  /// asked: called from any thread that works within; once it has said yes it must not say no. Empty: never.
  explicit StopScope(std::function<bool()> asked) : asked_(std::move(asked)), outer_(innermost_) { innermost_ = this; }
  ~StopScope() { innermost_ = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  bool says_stop() const { return (asked_ && asked_()) || (outer_ != nullptr && outer_->says_stop()); }

  /// The innermost scope of this thread; nullptr: nothing stops it.
  static const StopScope* current() { return innermost_; }
  /// Puts a thread that helps another under the scope of that other, which outlives it.
  static void take_over(const StopScope* scope) { innermost_ = scope; }

 private:
  static inline thread_local const StopScope* innermost_ = nullptr;
  std::function<bool()> asked_;
  const StopScope* outer_;
};

/// Whether the work of this thread is to stop.
inline bool stop_asked() {
  return StopScope::current() != nullptr && StopScope::current()->says_stop();
}

/// Throws Stopped where it is.
inline void stop_point() {
  if (stop_asked()) throw Stopped();
}

/// Does the work, and says whether it came to its end before `until` (none: it has all the time). What it had begun is
/// as it left it. Throws Stopped where an outer scope says so.
inline bool done_before(const std::optional<std::chrono::steady_clock::time_point>& until,
                        const std::function<void()>& work) {
  try {
    const StopScope scope([&until] { return until && std::chrono::steady_clock::now() >= *until; });
    work();
    return true;
  } catch (const Stopped&) {
    stop_point();
    return false;
  }
}

}  // namespace tribofit
