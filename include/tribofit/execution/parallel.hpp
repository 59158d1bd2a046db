#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "tribofit/execution/stop.hpp"

namespace tribofit {

/// Processors of this machine, of which there is at least one. Asked for once: the system opens files to know.
inline int available_threads() {
  static const int count = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return count;
}

/// Threads that do the same work beside the caller's, under its StopScope, and are joined at the end of its life. One
/// that the system does not start is one thread less.
class HelperThreads {
 public:
  template <class Work>
  HelperThreads(std::size_t count, Work work) {
    threads_.reserve(count);
    const auto help = [work, scope = StopScope::current()] {
      StopScope::take_over(scope);
      work();
    };
    try {
      while (threads_.size() < count) threads_.emplace_back(help);
    } catch (const std::system_error&) {  // the caller works in any case
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

/// Runs task(0) ... task(count-1) on up to `threads` threads (0: as many as there are).
/// Every task writes its own result, so results do not depend on the number of threads. The exception of the lowest
/// failing task is thrown on; Stopped, where the work is to stop.
template <class Task>
void run_tasks(std::size_t count, int threads, Task&& task) {
  const auto available = static_cast<std::size_t>(threads > 0 ? threads : available_threads());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::size_t failed = count;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        stop_point();
        task(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < failed) {
          failed = i;
          failure = std::current_exception();
        }
      }
    }
  };
  {
    const HelperThreads others(std::max<std::size_t>(1, std::min(available, count)) - 1, work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Runs task(begin, end) for parts of 0 ... count-1 that lie in the cache of a core, as run_tasks() does.
template <class Task>
void run_over_parts(std::size_t count, int threads, Task&& task) {
  constexpr std::size_t kPart = std::size_t{1} << 15;
  run_tasks((count + kPart - 1) / kPart, threads,
            [&](std::size_t k) { task(k * kPart, std::min(count, (k + 1) * kPart)); });
}

}  // namespace tribofit
