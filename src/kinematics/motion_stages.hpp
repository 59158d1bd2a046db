#pragma once

#include <optional>
#include <vector>

#include "clock_drift.hpp"
#include "corrections.hpp"
#include "health_checks.hpp"
#include "high_pass.hpp"
#include "low_pass.hpp"
#include "net_displacement.hpp"
#include "plateau.hpp"
#include "plateau_search.hpp"
#include "recorded_samples.hpp"
#include "rest_model.hpp"
#include "speed_steps.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// A trace on its way to a motion. Each stage reads what the stages before it have settled.
class MotionStages {
 public:
  MotionStages(Trace trace, const Instruments& instruments, const MotionOptions& options);

  void look_at_recording();
  void correct_declared();
  void find_disc();
  void find_plateau();
  void find_direction();
  void read_at_rest();
  void undo_high_pass();
  void undo_distortions();
  void find_speed_steps();
  void take_speed_from_plateau();
  void follow_disc();
  void check_clipping();
  void add_sensor_mass();
  void measure_ratio();
  void make_relative_motion();
  void settle_signs_and_levels();
  void check_health();
  void compare_plateau();
  Motion take() { return std::move(motion_); }

 private:
  bool is_block() const { return trace_.velocity_kind == VelocityKind::block; }
  bool speed_is_constant() const { return disc_.varying.empty(); }
  std::optional<LevelRange> plateau_as_recorded() const;
  void undo_zero_drift();
  void find_zero();
  void undo_zero();
  void undo_velocity_response();
  void undo_friction_response();
  void undo_stated_low_pass();
  void undo_low_pass();
  void undo_clock_drift();
  void compare_channels();
  void find_friction_filter();
  void take_disc_off_high_pass();
  std::size_t run_up() const;
  Plateaus plateaus_in_motion() const { return plateaus_within(search_, motion_.trimmed, motion_.size()); }
  HealthItem check_band() const;
  HealthItem check_delay() const;
  HealthItem check_level() const;

  Trace trace_;
  const Instruments& instruments_;
  const MotionOptions& options_;
  int threads_;
  Motion motion_;

  // Of the channels as recorded.
  std::optional<RecordedSamples> samples_;
  HealthItem clipping_, drop_outs_;
  Ends lost_;  ///< to corrections
  Disc disc_;
  bool speed_was_stated_ = false;
  PlateauSearch search_;
  bool is_reversed_ = false;
  std::optional<double> declared_high_pass_;
  RestModel rest_;      ///< of the velocity as recorded
  double plateau_ = 0;  ///< of v_b (v_r where that was measured), towards which the record tends [m/s]
  std::optional<RecordedPlateau> recorded_;
  BlockPositions positions_;  ///< of the block, until the velocity is changed
  Estimate zero_drift_;       ///< that was taken off v_b [m/s^2]
  BlockZero zero_;
  LowPass low_pass_;          ///< of the velocity as recorded
  double friction_fall_ = 0;  ///< see FrictionLowPass::fall
  ClockDriftEstimate clocks_;
  std::vector<SpeedLevel> speed_levels_;  ///< of a disc whose speed steps, unsaid
  RestModel disc_at_rest_;                ///< of a velocity that is put right, with the speed of the disc
  std::vector<double> disc_factor_;       ///< omega r over its level, every sample; empty: one speed
  Estimate ratio_;                        ///< of the reading at rest to omega r; 0: not known
  Estimate net_velocity_;                 ///< of the block along omega r, behind a high-pass that was undone [m/s]
  std::size_t run_up_ = 0;
};

}  // namespace tribofit::kinematics
