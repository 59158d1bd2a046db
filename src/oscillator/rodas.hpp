#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tribofit::oscillator {

/// A step of RODAS for stiff problems y' = f(t, y) (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II,
/// 1996, IV.7 and IV.10; the program rodas.f): six stages, order 4 with an estimate of order 3, L-stable, no iteration,
/// with an interpolant of order 3. Its order needs the exact derivatives of f, by y and by t. T: numbers or dual
/// numbers.
template <class T, std::size_t kSize>
class RodasStep {
 public:
  using State = std::array<T, kSize>;
  static constexpr double gamma = 0.25;
  /// Of each stage: its place in the step, and the part of h df/dt that it adds to f.
  static constexpr std::array<double, 6> place = {0, 0.386, 0.21, 0.63, 1, 1},
                                         by_time = {0.25, -0.1043, 0.1035, -0.0362, 0, 0};

  /// From `begin` over h. rates(s, y): f at the place of stage s, and by_time[s] h df/dt; first: that of stage 0;
  /// solve(r): x of (I/(gamma h) - df/dy) x = r at the begin of the step.
  template <class Rates, class Solve>
  void take(const State& begin, double h, const State& first, const Rates& rates, const Solve& solve) {
    before = begin;
    for (std::size_t s = 0; s < stages_.size(); ++s) {
      State right = first;
      after = before;
      if (s > 0) {
        for (std::size_t j = 0; j < s; ++j) add(kStates[s][j], stages_[j], after);
        right = rates(s, after);
        for (std::size_t j = 0; j < s; ++j) add(kRights[s][j] / h, stages_[j], right);
      }
      stages_[s] = solve(right);
    }
    add(1, error(), after);
  }

  State before = {}, after = {};
  const State& error() const { return stages_.back(); }
  /// Terms of the interpolant (1-s) before + s after + s (1-s) (first + s second) at the part s of the step.
  std::pair<State, State> bends() const {
    std::pair<State, State> out = {};
    for (std::size_t j = 0; j < kBends.size(); ++j) {
      add(kBends[j][0], stages_[j], out.first);
      add(kBends[j][1], stages_[j], out.second);
    }
    return out;
  }
  /// Within the step, at the part s of it.
  State at(double s) const {
    const auto [first, second] = bends();
    State y = before;
    for (std::size_t i = 0; i < kSize; ++i) y[i] += s * (after[i] - before[i] + (1 - s) * (first[i] + s * second[i]));
    return y;
  }

 private:
  static void add(double factor, const State& x, State& to) {
    for (std::size_t i = 0; i < kSize; ++i) to[i] += factor * x[i];
  }

  /// Row s: by which the stages before are added to the state, and to the right side of stage s.
  static constexpr std::array<std::array<double, 5>, 6> kStates = {{
      {},
      {1.544},
      {0.9466785280815826, 0.2557011698983284},
      {3.314825187068521, 2.896124015972201, 0.9986419139977817},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1},
  }};
  static constexpr std::array<std::array<double, 5>, 6> kRights = {{
      {},
      {-5.6688},
      {-2.430093356833875, -0.2063599157091915},
      {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
      {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
      {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054},
  }};
  static constexpr std::array<std::array<double, 2>, 5> kBends = {{{10.12623508344586, -0.6762803392801253},
                                                                   {-7.487995877610167, 6.087714651680015},
                                                                   {-34.80091861555747, 16.43084320892478},
                                                                   {-7.992771707568823, 24.76722511418386},
                                                                   {1.025137723295662, -6.594389125716872}}};

  std::array<State, 6> stages_ = {};
};

/// By how much a step may grow, or must shrink, after one that errs by `error` of what it may.
inline double next_step_over_this(double error) {
  constexpr double kSafety = 0.9, kLeastChange = 0.1, kMostChange = 6;
  if (!std::isfinite(error)) return kLeastChange;
  return std::clamp(kSafety / std::sqrt(std::sqrt(std::max(error, 1e-8))), kLeastChange, kMostChange);
}

}  // namespace tribofit::oscillator
