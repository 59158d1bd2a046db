#pragma once

#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

#include "tribofit/statistics/stop.hpp"

namespace tribofit {

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

}  // namespace tribofit
