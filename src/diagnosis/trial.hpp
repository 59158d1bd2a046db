#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "candidates.hpp"
#include "fit/cycle_evidence.hpp"
#include "fit/starts.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// About ten blocks of at least five cycles: neighbours share slow scatter.
std::vector<std::size_t> blocks_to_hold_out(const Observations& observations);

double sum(const std::vector<double>& x);

/// A model fitted to the observations, with what it leaves.
///
/// Squares are whitened against the scatter of break-away as this model sees it, and every cycle pays noise log(1 + s^2
/// g'g/noise) for that scatter: minus twice the logarithm of the likelihood in units of the noise, so that models that
/// see less scatter are the better ones. Models that let the block creep in stick are judged there too: their squares
/// are those of the slips plus what v_r in stick leaves, less what a rigid stick would leave there. Models of rigid
/// stick are thus what they were without that evidence.
struct Trial {
  FrictionModel model{ExponentialLaw{}};
  std::vector<double> p;             ///< SI
  std::vector<bool> at_bound, free;  ///< of each parameter: whether a bound holds it, or the data do
  bool usable = false;               ///< finite
  double places = 1;                 ///< independent places that were looked at to find it
  ModelResiduals::Whitening whitening;
  CycleEvidence evidence;           ///< at p
  std::vector<double> held_out;     ///< squares of each cycle, from parameters that the other blocks suggest
  double squares = 0;               ///< of all cycles, at p
  double row_squares = 0;           ///< the same without what is paid for scatter: of the rows of `evidence`,
  double row_held_out_squares = 0;  ///< and on held-out cycles
  double plain_squares = 0;         ///< the same not whitened: scatter of break-away counts in full
  double held_out_squares = 0;      ///< sum of held_out
  CycleEvidence plain;              ///< not whitened, stepped to its own minimum
  double plain_minimum = 0, plain_held_out = 0;  ///< squares there, and on held-out cycles
  std::vector<double> plain_cycles;  ///< squares on held-out cycles, of each cycle, without those of the stick
  /// Of all sticks; zero where the model is rigid there, and where it explains so little of what v_r shows in stick
  /// that something else moves the block: it is then judged by the slips alone.
  ModelResiduals::StickSquares stick;
};

/// The observations at one resolution.
struct Level {
  const Observations& observations;
  double values = 0;                        ///< rows of friction, over which the noise of a row is taken
  double samples = 0;                       ///< behind them
  std::vector<GivenParameter> known = {};   ///< bounds that the user gave
  std::vector<double> velocity_noise = {};  ///< that is left of each value of v_r [m/s]; empty: not looked at

  explicit Level(const Observations& given);
  /// Of a model's parameters: those of the catalogue on the scale of the record, or the user's.
  Bounds bounds_of(const FrictionModel& model) const;
};

/// What all trials of one diagnosis share.
struct DiagnosisContext {
  std::span<const Record> records;
  Level fine;    ///< what models are judged by
  Level coarse;  ///< fewer values a slip: where a search begins, and where the hopeless are found out
  std::vector<std::size_t> blocks;  ///< of every cycle: contiguous ones that are held out in turn
  double noise = 0;                 ///< sensor noise of a sample [1 or N]
  double scatter = 0;               ///< of break-away from cycle to cycle [1 or N]
  double shared = 0;  ///< of its squares, what sampling and corrections leave: no chance, and no structure either

  int threads = 1;  ///< over candidates

  /// As many values a slip as tell models that come near each other, with v_r as quiet as it can be; made when it is
  /// first asked for.
  const Level& finest() const;

  DiagnosisContext(std::span<const Record> given, const Observations& finely, const Observations& coarsely,
                   double sensor_noise, double break_away_scatter);
  /// For each of so many tasks that are done side by side.
  int threads_each(std::size_t tasks) const { return tasks == 1 ? threads : 1; }
  /// Squares that sensor noise leaves.
  double noise_squares() const { return fine.samples * noise * noise; }
  /// Squares that noise and scatter leave together, in slips whose friction follows break-away as the whitening says.
  double floor_squares(const ModelResiduals::Whitening& whitening) const;

 private:
  struct Finest;
  std::shared_ptr<Finest> finest_;
};

/// Residuals of all slips as a trial has them. scatter: whether that of break-away is taken out; threads: that share
/// its slips.
ModelResiduals residuals_of(const Observations& observations, const FrictionModel& model,
                            const ModelResiduals::Whitening& whitening, int threads = 1, bool scatter = true);

/// Sums over all sticks.
ModelResiduals::StickSquares all_sticks(const std::vector<ModelResiduals::StickSquares>& sticks);

/// Variance of a row of friction beside the model of a trial.
double noise_of(const Level& level, const Trial& trial);

/// Fits a model from a start, with the scatter of break-away as the model sees it there. threads: that share its slips.
Trial try_model(const DiagnosisContext& context, const Level& level, const FrictionModel& model,
                std::vector<double> start, int threads = 1);

/// The start from which a few steps lead lowest, after those steps.
Solution nearest(const Level& level, const FrictionModel& model, const ModelResiduals::Whitening& whitening,
                 const std::vector<std::vector<double>>& starts);

/// The same, but a single start as it is.
std::vector<double> nearest_if_several(const Level& level, const FrictionModel& model,
                                       const ModelResiduals::Whitening& whitening,
                                       const std::vector<std::vector<double>>& starts);

/// Fits a model from the data alone.
Trial try_base(const DiagnosisContext& context, const Level& level, const FrictionModel& model, int threads = 1);

/// What the model of a trial leaves at each value of the fine observations [1 or N].
std::vector<double> residual_of(const DiagnosisContext& context, const Trial& trial);

/// Where one effect more begins to lower what a trial leaves.
struct SearchStart {
  std::vector<std::vector<double>> starts;  ///< of all parameters [SI], the most promising first; empty: none promises
                                            ///< a fall of the squares
  double places = 1;                        ///< independent places that were looked at
  double promised = 0;  ///< fall of the whitened squares that a linear step from the best start says
  double squares = 0;   ///< of all rows that are left then
};

/// Falls of the squares of which one must be promised; of any size, where nothing is said.
struct LeastFalls {
  double whitened = -std::numeric_limits<double>::infinity();
  double plain = -std::numeric_limits<double>::infinity();
};

/// Starts beside one where nothing sticks: the law falls at other speeds. None where a break-away holds it.
std::vector<std::vector<double>> falling_elsewhere(const Observations& observations, const FrictionModel& model,
                                                   const std::vector<double>& start);

/// The best two of the starts of an effect beside the model of `base`, a trial at `level`. residual: see residual_of.
SearchStart search_start_of(const DiagnosisContext& context, const Level& level, const Trial& base,
                            const Candidate& candidate, std::span<const double> residual, const LeastFalls& least);

/// The model of a trial with one effect more.
FrictionModel with_effect(const FrictionModel& model, const Effect& effect);

/// The trial's model with one effect more, fitted from the best of its starts.
Trial try_with(const DiagnosisContext& context, const Level& level, const Trial& base, const Candidate& effect);

/// Model, parameters and whitening of a trial without one of its effects; nothing is fitted anew.
Trial without_effect(const Trial& full, std::string_view key);

/// Squares that the noise left of v_r adds to those of a trial. What it does to friction at single values is an error
/// of every model but those that smooth what they predict, as a filter does: they would be ahead by it.
double squares_of_velocity_noise(const Level& level, const Trial& trial);

/// A start of a wave (an effect with an amplitude first and one phase) with the amplitude and phase that fit there.
///
/// A cos(wt + phase) is linear in A cos(phase) and A sin(phase), and not in A and phase: from a small amplitude a step
/// in these turns the phase round, and a search ends far away. Here the step is taken in the former; the start is
/// returned as it was where that leaves more, and for every other effect. Cost: three passes over the values.
std::vector<double> with_amplitude_and_phase(const ModelResiduals& residuals, const FrictionModel& model,
                                             const EffectInfo& effect, const Bounds& bounds, std::vector<double> start);

}  // namespace tribofit::diagnosis
