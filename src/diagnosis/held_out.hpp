#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "fit/model_residuals.hpp"
#include "limits.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit::diagnosis {

/// Contiguous blocks of cycles that are held out in turn.
///
/// Neighbouring cycles share slow scatter, so a block is at least five of them; about ten blocks.
class Blocks {
 public:
  explicit Blocks(const Observations& observations)
      : count_(std::clamp<std::size_t>(observations.cycles / limits::kCyclesOfBlock, limits::kFewestBlocks,
                                       limits::kMostBlocks)),
        of_(blocks_of(observations, count_)) {}
  /// From the block of every cycle.
  explicit Blocks(std::vector<std::size_t> block_of_cycle)
      : count_(block_of_cycle.empty() ? 0 : *std::max_element(block_of_cycle.begin(), block_of_cycle.end()) + 1),
        of_(std::move(block_of_cycle)) {}
  std::size_t count() const { return count_; }
  std::size_t of(std::size_t cycle) const { return of_[cycle]; }

 private:
  std::size_t count_;
  std::vector<std::size_t> of_;
};

/// A model as the data see it near one point: whitened rows [J r] of every cycle, compressed.
struct Linearised {
  std::vector<Eigen::MatrixXd> rows;  ///< of each cycle
  std::vector<bool> free;             ///< parameters that may move
  Eigen::VectorXd level = {};         ///< change of the parameters that raises all friction alike; empty: none known
  double known_flicker = 0;           ///< power of 1/f noise of that level, which the record shows without any model

  bool finite() const { return !rows.empty(); }
  std::size_t parameters() const { return free.size(); }
};

/// Step of the parameters that minimises the squares of the cycles that are kept, but only along directions about which
/// they know at least a tenth of what all cycles know; the rest stays as it is.
/// kept: one flag a cycle; empty: all of them.
Eigen::VectorXd gauss_newton_step(const Linearised& model, const std::vector<bool>& kept = {});

/// The same for all cycles within bounds on the step: parameters that would leave them go to their bound and the others
/// follow.
Eigen::VectorXd bounded_step(const Linearised& model, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// Whitened squares of each cycle after a step of the parameters.
std::vector<double> squares_after(const Linearised& model, const Eigen::VectorXd& step);

/// Whitened squares of each cycle, with the parameters that the other blocks suggest.
std::vector<double> held_out_squares(const Linearised& model, const Blocks& blocks);

/// What the level of friction does slowly from cycle to cycle beside the model.
SlowNoise slow_noise_of(const Linearised& model);

/// How much larger the variance of a parameter is than independent residuals of one variance would make it.
struct DesignEffect {
  double of_cycles = 1;  ///< correlation within and between cycles, as the cycles themselves show it. At least 1
  double of_slow = 1;    ///< the same where all correlation is that of slow noise. At least 1
};
/// Of `count` parameters from `first` on. noise: variance of a residual.
std::vector<DesignEffect> design_effects(const Linearised& model, std::size_t first, std::size_t count, double noise,
                                         const SlowNoise& slow);
/// Of parameter k.
inline DesignEffect design_effect(const Linearised& model, std::size_t k, double noise, const SlowNoise& slow) {
  return design_effects(model, k, 1, noise, slow)[0];
}

/// p-value of a fall of the squares by `fall` for `parameters` more parameters, when independent residuals of variance
/// `noise` count for 1/design_effect each and the variance is known with `freedom` degrees of freedom (F test).
double fall_p_value(double fall, std::size_t parameters, double noise, double design_effect, double freedom);

/// Degrees of freedom of a variance of what correlates between cycles: see standard_error_of_mean().
double few_frequencies(double cycles);

double sum(const std::vector<double>& x);

}  // namespace tribofit::diagnosis
