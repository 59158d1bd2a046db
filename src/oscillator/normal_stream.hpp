#pragma once

#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <random>

namespace tribofit {

/// Standard normal numbers of one purpose. Streams of one seed are independent of each other, and the same on every
/// machine: the standard fixes the engine but not its distributions, so those come from Boost.
class NormalStream {
 public:
  enum class Purpose : std::uint32_t { scatter = 1, friction = 2, velocity = 3 };

  NormalStream(std::uint64_t seed, Purpose purpose) {
    std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                        static_cast<std::uint32_t>(purpose)};
    engine_.seed(words);
  }
  double operator()() { return normal_(engine_); }

 private:
  std::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

/// Stationary AR(1) numbers: deviation and correlation of neighbours as given (0: independent).
class CorrelatedStream {
 public:
  CorrelatedStream(double deviation, double correlation, std::uint64_t seed, NormalStream::Purpose purpose)
      : correlation_(correlation),
        fresh_(std::sqrt(1 - correlation * correlation) * deviation),
        normal_(seed, purpose),
        value_(deviation * normal_()) {}

  double value() const { return value_; }
  void next() { value_ = correlation_ * value_ + fresh_ * normal_(); }

 private:
  double correlation_, fresh_;
  NormalStream normal_;
  double value_;
};

}  // namespace tribofit
