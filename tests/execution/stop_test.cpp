#include "tribofit/execution/stop.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "tribofit/execution/parallel.hpp"

namespace {

using namespace tribofit;

TEST(Stop, ActsWithinItsScopeAlone) {
  EXPECT_FALSE(stop_asked());
  EXPECT_NO_THROW(stop_point());
  {
    const StopScope outer([] { return true; });
    EXPECT_TRUE(stop_asked());
    EXPECT_THROW(stop_point(), Stopped);
    const StopScope inner([] { return false; });
    EXPECT_THROW(stop_point(), Stopped) << "the outer scope holds within the inner one";
  }
  EXPECT_FALSE(stop_asked());
  const StopScope never({});
  EXPECT_FALSE(stop_asked());
}

TEST(Stop, EndsTheTasksOfEveryThread) {
  for (const int threads : {1, 2, 8}) {
    std::atomic<int> begun{0};
    const auto run = [&] {
      const StopScope scope([&] { return begun >= 20; });
      run_tasks(100000, threads, [&](std::size_t) {
        ++begun;
        stop_point();
      });
    };
    EXPECT_THROW(run(), Stopped);
    EXPECT_GE(begun, 20);
    EXPECT_LE(begun, 20 + threads) << "each thread may be in a task";
    EXPECT_NO_THROW(run_tasks(3, threads, [](std::size_t) { stop_point(); }));
  }
}

TEST(Stop, LeavesAFailureOfATaskInFront) {
  std::atomic<bool> failed{false};
  const StopScope scope([&] { return failed.load(); });
  const auto run = [&] {
    run_tasks(100, 2, [&](std::size_t i) {
      if (i != 0) return stop_point();
      failed = true;
      throw 5;
    });
  };
  EXPECT_THROW(run(), int);
}

}  // namespace
