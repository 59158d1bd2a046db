#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {

/// The slips of the records, sample by sample, with the channels a model needs. Slips point into the Motions.
class FullRecord {
 public:
  FullRecord(std::span<const Record> records, const Observations& observations, const Channels& needs);
  /// What of a slip stands in no record.
  struct Made {
    SlipMotion motion;
    std::vector<double> load;
  };
  /// Valid until `made` is given to the next call.
  Slip slip(const Observations::SlipObservation& range, Made& made) const;
  /// Measured friction of a slip, signed.
  std::span<const double> friction(const Observations::SlipObservation& range) const;
  /// Whether a fault of the recording spoilt sample i of a slip.
  bool is_spoilt(const Observations::SlipObservation& range, std::size_t i) const;
  /// Weight of its square: 1, of a point as the observations weigh it.
  double weight(const Observations::SlipObservation& range, std::size_t i) const;

 private:
  struct Channel {
    std::vector<double> angle, distance, reversal_distance;
  };
  std::span<const Record> records_;
  const Observations& observations_;
  Channels needs_;
  std::vector<Channel> channels_;  // of each record
};

/// Slips that one thread takes at a time.
inline constexpr std::size_t kSlipsOfPart = 32;

/// Samples of a slip, or of a piece of one, over which friction can be a parabola and noise is taken about it.
std::size_t noise_stretch(std::size_t samples);

SensorNoise sensor_noise(const Motion& motion, const Segmentation& segmentation);

/// Noise of friction (SampleFault::friction) or v_r (SampleFault::velocity) about parabolas within the sticks; none
/// where no stick is long enough.
CorrelatedNoise noise_in_sticks(std::uint8_t channel, const Motion& motion, const Segmentation& segmentation);

/// Standard deviation of the level of all friction from cycle to cycle, in proportion, where no law has to be right:
/// what friction at break-away and in fast slip of neighbouring cycles change by together. Their covariance is taken by
/// medians (R. Gnanadesikan, J. R. Kettenring, Biometrics 28 (1972) 81, doi:10.2307/2528963): a few large steps are
/// changes of friction, no scatter. 0 where few cycles show both.
double level_scatter(const Motion& motion, const Segmentation& segmentation);

FlickerNoise flicker_noise(const Motion& motion, const Segmentation& segmentation);
/// Writes the noise of a record to its observations, with the power of its slow part in proportion to friction.
void add_noise(const RecordNoise& noise, Observations& out);

/// Parameters refer to N0 and T0 of their fit, whatever the record has that they are tried on.
void refer_to_conditions_of(const Fit& fit, Observations& observations);

/// observe() without noise but what weighs a break-away: enough to evaluate a model, not to fit one.
Observations observe_motion(const Motion& motion, const Segmentation& segmentation, const SensorNoise& noise,
                            const Channels& needs, std::size_t values_per_slip = 80);

/// What a model leaves on every sample.
struct SampleErrors {
  ErrorFigures figures;         ///< held_out_rmse not set
  std::vector<double> squares;  ///< sum of squares of each cycle, break-away included
  std::vector<double> counts;   ///< residuals of each cycle
  double constant_rmse = 0;     ///< what a constant |friction| would leave
};
SampleErrors sample_errors(const FrictionModel& model, const std::vector<double>& p, const FullRecord& record,
                           const Observations& observations, int threads = 1);

}  // namespace tribofit
