#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/slip.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/segmentation/stick_motion.hpp"

namespace tribofit {

/// The scales of a motion, in which bounds and windows are stated: medians over the slips that begin in stick; where
/// nothing sticks, the sixth part of a piece of the record, as a slip is of a cycle. The values given here are those of
/// the rig of [D] (a pad on a disc, 15 mm, 4 rpm, 50 N), for which the catalogue states its bounds.
struct RecordScales {
  double slip_time = 1.0 / 30;   ///< [s]
  double slip_length = 1.25e-3;  ///< [m]
  double top_speed = 0.1;        ///< largest |v_r| [m/s]
  double stick_time = 0.15;      ///< [s]; a slip time of this record where no stick is known
  double duration = 40;          ///< of the longest record [s]
  double distance = 0.25;        ///< slid in the longest record [m]
  double stroke = 0.1;           ///< of a motion back and forth [m]; [D] has none
  double mass = 4;               ///< largest friction force over the acceleration that one value in twenty exceeds [kg]
};

/// 1/f noise of friction as it shows over times in which no law changes it but as a parabola: in stick, and where
/// nothing sticks in stretches of the sliding. No law has to be right for it.
struct FlickerNoise {
  double power = 0;    ///< a of the spectrum a/f: half the variance in every e-fold of time; 0: none shows
  double samples = 0;  ///< length of the stretches that it was taken over
};

/// Noise of a sample of friction about parabolas, in stick where there is enough of it, else in slip; of points what
/// their standard errors or neighbours say. From the spread itself and not from differences, so that coloured noise is
/// not underestimated.
struct SensorNoise {
  double rmse = 0;     ///< standard deviation [1 or N]
  double between = 0;  ///< what friction between two samples is off a straight line, over the slips [1 or N]
  std::string source;  ///< how rmse was found: "stick", "slip", "standard errors" or "neighbours"
  double any() const { return between > rmse ? between : rmse; }
};

class LinesOfRecord;

/// The noise of a record, as it shows without any model: a property of the data that all models share.
struct RecordNoise {
  SensorNoise sensor;
  double scatter = 0;        ///< standard deviation of the break-away level from cycle to cycle [1 or N]
  double level_scatter = 0;  ///< the same of all friction, in proportion [1]
  FlickerNoise flicker;
  double line = 0;         ///< frequency of a line that makes most of the noise in stick [Hz]; 0: none was looked for
  double beside_line = 0;  ///< sensor noise without it [1 or N]
  std::shared_ptr<LinesOfRecord> lines = {};  ///< about the mean curve, sought by the first fit that asks for them
};

/// Cost: linear in samples, and as much as that of a fit: found once for all models.
RecordNoise noise_of(const Motion& motion, const Segmentation& segmentation, int threads = 1);

/// The samples over which an error is taken: those of every slip, and one break-away per cycle.
///
/// This is the definition for the whole library: rigid-stick laws are judged over the slip samples plus one break-away
/// residual per cycle (in rigid stick mu is set by the spring, not by the law). The unit of evidence is the cycle, or a
/// stretch of equal length where nothing sticks; of points each is one, in an order that goes with nothing.
///
/// Samples may be means over `samples_per_value` neighbours. Each carries the variance of v_r within it, so that the
/// bare laws are averaged over it as the samples are (mean_friction of a law): at 80 values a slip their parameters
/// move by less than 1e-5.
struct Observations {
  /// Where its beginning was not recorded, stick_time is the median of the others (NaN where none was); and it is
  /// without what its own break-away level made of it.
  struct SlipObservation : SlipFacts {
    std::size_t begin = 0, end = 0;  ///< values of this slip
    SampleRange samples;             ///< the same in samples of the Motion
    std::size_t law_end = 0;  ///< from this sample on friction is the spring's again, if v_r is late; no evidence
    std::size_t cycle = 0;    ///< unit of evidence it belongs to, from 0, in order of time
    std::size_t segment = 0;  ///< index in Segmentation::cycles
    double break_away_friction = 0;                                    ///< |mu| at break-away; NaN when there is none
    double creep_friction = std::numeric_limits<double>::quiet_NaN();  ///< |mu| read where the lead ends; NaN: no lead
    double break_away_root_weight = 1;  ///< of its residual beside that of a sample: less where its time is not known
    std::size_t lead_begin = 0, lead_end = 0;        ///< of the lead channels below
    std::size_t strokes_begin = 0, strokes_end = 0;  ///< of earlier_strokes
    std::size_t earlier_begin = 0, earlier_end = 0;  ///< values of the slip before its stick; none: not recorded
    std::size_t stick = npos;                        ///< index in `sticks` of the stick before it; npos: none

    /// What break_away_level() of a model is compared with. creeps: it acts in stick.
    double read_at_break_away(bool creeps) const {
      return creeps && std::isfinite(creep_friction) ? creep_friction : break_away_friction;
    }
  };
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

  /// How v_r scatters over the parts of a stick in one record.
  struct StickNoise {
    /// Covariance of the parts: half the mean product of what neighbouring sticks differ by [m^2/s^2], row by row;
    /// empty where there are too few sticks to know it.
    std::vector<double> covariance;
    std::vector<double> mean;  ///< of v_r in each part [m/s]
    double sticks = 0;         ///< behind them
    bool ramps = false;  ///< v_r may also change evenly over a stick: a high-pass was undone, never to the last bit
  };

  std::vector<double> time, velocity, friction;  ///< [s], [m/s], [1 or N]
  std::vector<double> velocity_variance;         ///< of v_r within each value [m^2/s^2]; empty when values are samples
  std::vector<double> weight, root_weight;       ///< samples behind each value (of points: as their standard errors
                                                 ///< say, one on average), and its square root
  /// Empty when not needed or absent.
  std::vector<double> acceleration, angle, distance, reversal_distance, load, temperature;
  std::vector<double> earlier_strokes;           ///< that the slips remember [m], where there is a reversal_distance
  std::vector<double> lead_time, lead_velocity;  ///< the last samples of each stick; empty when not needed
  std::vector<SlipObservation> slips;
  std::vector<StickCreep> sticks;       ///< creep as evidence; empty unless add_stick_evidence() filled it
  std::vector<StickNoise> stick_noise;  ///< of each record
  std::vector<RecordNoise> noise;       ///< of each record
  double stick_unit = 0;                ///< residual that stands for one standard deviation of v_r in stick [1 or N]
  std::size_t cycles = 0;               ///< units of evidence
  std::size_t samples_per_value = 1;
  double mean_load = 1;         ///< N0 [N]
  double mean_temperature = 0;  ///< T0 [degC]
  double fastest = 0;           ///< largest |v_r| [m/s]
  double stroke = 0;            ///< median length [m]; 0: not needed, or no strokes
  double slowest = 0;           ///< least |v_r| [m/s]; 0 where a slip begins in stick
  double largest_friction = 0;  ///< largest |mu|
  double friction_scale = 1;    ///< of coefficients at least 1; of forces twice the median, of points the largest [N]
  double flicker = 0;           ///< power of 1/f noise in the first record, in squared parts of friction
  RecordScales scales;
  std::vector<RecordScales> scales_of_records = {};  ///< of each by itself, where there are several

  std::size_t size() const { return time.size(); }
  /// A slip as friction/ takes it.
  Slip slip(const SlipObservation& range) const;
};

/// Builds the observations of a trace with the channels `needs` names.
/// values_per_slip: means are taken so that the median slip has about this many; 0 keeps every sample.
Observations observe(const Motion& motion, const Segmentation& segmentation, const Channels& needs = {},
                     std::size_t values_per_slip = 80);
/// The same with the noise of the record, which is known: noise_of().
Observations observe(const Motion& motion, const Segmentation& segmentation, const RecordNoise& noise,
                     const Channels& needs, std::size_t values_per_slip);

/// Adds how the block moves in stick to the observations of one record, as evidence for what lets it creep there.
///
/// Compared are the differences between the parts of a stick: what all of them share says nothing of creep (a wrong
/// radius or gain, a speed that is not quite the stated one), and where a high-pass was undone nor does what changes
/// evenly with time. Their noise, with its colour, is what neighbouring sticks differ by.
/// unit: weight of one standard deviation of that noise beside residuals of friction [1 or N]: the sensor noise.
void add_stick_evidence(const Motion& motion, const Segmentation& segmentation, double unit, Observations& out);

/// The observations of several records as one; channels that not all of them have are dropped, and N0 and T0 are the
/// means of all.
Observations join(std::vector<Observations> records);

/// Block of every cycle when each record is cut into `count` contiguous blocks of about equally many cycles; block k of
/// one record belongs together with block k of the others.
std::vector<std::size_t> blocks_of(const Observations& observations, std::size_t count);

/// How the block moves in a slip, a value for each of its samples.
struct SlipMotion {
  std::vector<double> velocity;      ///< v_r [m/s]
  std::vector<double> acceleration;  ///< of the block [m/s^2]
};

/// Savitzky-Golay parabolas, over at most 6 % of the slip for the velocity (3 to 41 samples) and 3 % for its slope (3
/// to 21), less where the wider window would flatten what the velocity does above its noise (O. V. Lepski, Theory
/// Probab. Appl. 35 (1991) 454). Windows stop at re-stick, where the acceleration jumps. A law is evaluated at a
/// velocity without its noise: the noise of a regressor biases what is fitted to it (W. A. Fuller, Measurement Error
/// Models, 1987). Points, velocities made of other channels and motions that never stick keep v_r as it is.
SlipMotion slip_motion(const Motion& motion, const SampleRange& samples);

}  // namespace tribofit
