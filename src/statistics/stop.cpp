#include "tribofit/statistics/stop.hpp"

#include <utility>

namespace tribofit {

namespace {

thread_local const StopScope* innermost = nullptr;

}  // namespace

StopScope::StopScope(std::function<bool()> asked) : asked_(std::move(asked)), outer_(innermost) {
  innermost = this;
}

StopScope::~StopScope() {
  innermost = outer_;
}

const StopScope* StopScope::current() {
  return innermost;
}

void StopScope::take_over(const StopScope* scope) {
  innermost = scope;
}

bool stop_asked() {
  return innermost != nullptr && innermost->says_stop();
}

}  // namespace tribofit
