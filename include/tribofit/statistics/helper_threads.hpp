#pragma once

#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace tribofit {

/// Threads that do the same work beside the caller's, and are joined at the end of its life. One that the system does
/// not start is one thread less.
class HelperThreads {
 public:
  template <class Work>
  HelperThreads(std::size_t count, Work work) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back(work);
    } catch (const std::system_error&) {  // the caller works in any case
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

}  // namespace tribofit
