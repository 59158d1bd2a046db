#include "tribofit/kinematics/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "corrections.hpp"
#include "disc_ripple.hpp"
#include "health_checks.hpp"
#include "high_pass.hpp"
#include "motion_channels.hpp"
#include "net_displacement.hpp"
#include "plateau.hpp"
#include "plateau_ratio.hpp"
#include "plateau_search.hpp"
#include "points.hpp"
#include "resolution.hpp"
#include "ripple.hpp"
#include "speed_steps.hpp"
#include "spoilt_samples.hpp"
#include "spring_slider.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

using kinematics::Disc;
using kinematics::LevelRange;
using kinematics::Plateaus;
using kinematics::PlateauSearch;
using kinematics::StickPlateau;

/// A trace on its way to a motion. Each stage reads what the stages before it have settled.
class MotionStages {
 public:
  MotionStages(Trace trace, const Instruments& instruments, const MotionOptions& options);

  void look_at_recording();
  void correct_declared();
  void find_disc();
  void find_plateau();
  void find_direction();
  void undo_high_pass();
  void find_zero();
  void find_speed_steps();
  void take_speed_from_plateau();
  void undo_ripple();
  void check_clipping();
  void add_sensor_mass();
  void make_relative_motion();
  void settle_signs_and_levels();
  void check_health();
  void compare_plateau();
  Motion take() { return std::move(motion_); }

 private:
  bool is_block() const { return trace_.velocity_kind == VelocityKind::block; }
  bool speed_is_constant() const { return disc_.varying.empty(); }
  std::optional<LevelRange> plateau_as_recorded() const;
  void undo_ripple_in_high_pass();
  std::size_t run_up() const;
  Plateaus plateaus_in_motion() const { return kinematics::plateaus_within(search_, motion_.trimmed, motion_.size()); }
  HealthItem check_level() const;
  double taken_off() const { return zero_.kind == kinematics::BlockZero::Kind::zero ? zero_.mean.value : 0; }

  Trace trace_;
  const Instruments& instruments_;
  const MotionOptions& options_;
  Motion motion_;

  // Of the channels as recorded.
  std::optional<kinematics::SpoiltSamples> spoilt_;
  kinematics::RangeEnds range_ends_;
  kinematics::RecordedSteps steps_;  ///< of a coarse converter
  HealthItem clipping_, drop_outs_;
  kinematics::Ends lost_;  ///< to corrections
  Disc disc_;
  bool speed_was_stated_ = false;
  PlateauSearch search_;
  bool is_reversed_ = false;
  std::optional<double> declared_high_pass_;
  kinematics::HighPassEstimate sag_;
  double plateau_ = 0;  ///< of v_b (v_r where that was measured), towards which the record tends [m/s]
  std::optional<kinematics::RecordedPlateau> recorded_;
  kinematics::BlockZero zero_;
  std::vector<kinematics::SpeedLevel> speed_levels_;  ///< of a disc whose speed steps, unsaid
  kinematics::RippleEstimate ripple_;
  bool undoes_ripple_ = false;
  std::size_t run_up_ = 0;
};

MotionStages::MotionStages(Trace trace, const Instruments& instruments, const MotionOptions& options)
    : trace_(std::move(trace)), instruments_(instruments), options_(options) {
  kinematics::require_channels(trace_);
  kinematics::take_conditions_from_instruments(trace_.conditions, instruments.rig);
  if (trace_.steps.empty()) trace_.steps.push_back({0, trace_.size(), "", {}});
  motion_.step = trace_.interval();
  kinematics::take_kinds(trace_, options.stick, motion_);
  motion_.clock_offset_std_error = trace_.clock_offset_std_error;
}

/// What the recorder did: its range and its gaps.
void MotionStages::look_at_recording() {
  spoilt_.emplace(trace_);
  spoilt_->add_unsure(kinematics::unsure_velocities(trace_));
  range_ends_ = kinematics::range_ends(trace_, chunks_of(trace_.friction), chunks_of(trace_.velocity));
  steps_ = {kinematics::find_resolution(trace_.friction), kinematics::find_resolution(trace_.velocity),
            range_ends_.friction[1].at - range_ends_.friction[0].at, range_ends_.largest_velocity};
}

void MotionStages::correct_declared() {
  lost_ = kinematics::correct_declared(trace_, instruments_, motion_.step, motion_.notes);
  if (lost_.head + lost_.tail + 2 > trace_.size()) lost_ = {};
}

void MotionStages::find_disc() {
  disc_ = kinematics::disc_of(trace_);
  speed_was_stated_ = disc_.known;
  if (trace_.velocity_kind != VelocityKind::fixed_block) return;
  if (!disc_.known) {
    throw InputError("v_r cannot be made: the block stands still and omega or r is not known",
                     "give --radius and --speed, or a column with the speed of the disc", {trace_.path, 0, ""});
  }
  trace_.velocity.assign(trace_.size(), disc_.constant);
  if (!speed_is_constant()) trace_.velocity = disc_.varying;
}

void MotionStages::find_plateau() {
  search_ = kinematics::search_plateaus(trace_, disc_, motion_.step, motion_.stick);
}

/// A vibrometer that points the other way.
void MotionStages::find_direction() {
  is_reversed_ = kinematics::points_the_other_way(trace_, disc_, search_);
  if (!is_reversed_) return;
  for (double& v : trace_.velocity) v = -v;
  motion_.notes.push_back("velocity: sign reversed, the plateau runs against the disc");
  find_plateau();
}

void MotionStages::undo_high_pass() {
  const std::optional<Declared>& stated = instruments_.vibrometer.high_pass;
  if (is_block() && stated) declared_high_pass_ = stated->value;
  if (is_block() && search_.sticks) {
    sag_ = kinematics::estimate_high_pass(search_.blocks, search_.plateaus, kinematics::disc_slopes(search_));
  }
  if (!declared_high_pass_ && !(sag_.significant && options_.undo_high_pass)) return;
  motion_.high_pass = declared_high_pass_ ? *declared_high_pass_ : sag_.corner;
  motion_.high_pass_std_error = declared_high_pass_ ? stated->uncertainty : sag_.std_error;
  const double level = disc_.known && speed_is_constant() ? disc_.constant : disc_.known ? 0 : std::nan("");
  kinematics::restore(
      trace_.velocity, motion_.step,
      kinematics::restoring_terms(search_.blocks, search_.plateaus, motion_.high_pass, level, search_.disc.mean));
  find_plateau();
}

/// A block on a spring goes nowhere: what v_b is on average is an error of the reading.
void MotionStages::find_zero() {
  if (!speed_is_constant() || motion_.high_pass > 0 || spoilt_->any()) return;
  if (is_block() && search_.sticks) zero_ = kinematics::find_zero(trace_, search_, disc_, steps_.velocity);
  if (trace_.velocity_kind == VelocityKind::relative && !search_.sticks)
    zero_ = kinematics::find_zero_of_relative(trace_, search_, disc_);
  if (zero_.kind != kinematics::BlockZero::Kind::zero) return;
  for (double& v : trace_.velocity) v -= zero_.mean.value;
  motion_.notes.push_back(fmt::format("velocity: its zero was off by {:.4g} mm/s, taken off", 1e3 * zero_.mean.value));
  find_plateau();
}

/// A disc that changes its speed at once, which no channel and no condition says.
void MotionStages::find_speed_steps() {
  if (!is_block() || !search_.sticks || !speed_is_constant() || trace_.disc_speed.size() == trace_.size()) return;
  speed_levels_ = kinematics::find_speed_levels(search_);
  if (speed_levels_.empty()) return;
  disc_.varying = kinematics::stepped_speed(speed_levels_, search_.blocks.length, trace_.size());
  disc_.known = true;
  disc_.largest = kinematics::largest_of(disc_.varying);
  for (const kinematics::SampleSpan& change : kinematics::changes_between(speed_levels_, search_.blocks.length)) {
    spoilt_->add_unknown(change);
  }
  if (trace_.conditions.radius.known()) {
    trace_.disc_speed = disc_.varying;
    for (double& w : trace_.disc_speed) w /= trace_.conditions.radius.value;
  }
  find_plateau();
}

/// Speed from the plateau where nobody said it.
void MotionStages::take_speed_from_plateau() {
  plateau_ = search_.sticks ? kinematics::final_level(search_.plateaus) : 0;
  if (!is_block() || disc_.known) return;
  const bool unknown = !search_.sticks || trace_.disc_speed.size() == trace_.size();
  if (unknown && !kinematics::is_useless(trace_)) {
    throw InputError("v_r cannot be made: the block never sticks, so that no plateau shows the speed of the disc",
                     "give --radius and --speed, or a column with v_r", {trace_.path, 0, ""});
  }
  if (unknown) motion_.notes.push_back("the speed of the disc is not known and no plateau shows it: v_r is -v_b");
  disc_.known = true;
  disc_.constant = unknown ? 0 : plateau_;
  disc_.largest = std::abs(disc_.constant);
  if (!unknown && trace_.conditions.radius.known()) {
    trace_.conditions.speed = {plateau_ / trace_.conditions.radius.value, "plateau"};
  }
}

void MotionStages::undo_ripple() {
  ripple_ = kinematics::find_ripple(trace_, search_, disc_, speed_was_stated_);
  undoes_ripple_ = ripple_.significant && options_.undo_speed_ripple;
  if (!undoes_ripple_) return;
  const DiscRipple& ripple = motion_.speed_ripple = ripple_.ripple;
  if (motion_.high_pass > 0) undo_ripple_in_high_pass();
  kinematics::flatten(search_, ripple_, kinematics::steady_speed(trace_), trace_.time);
  plateau_ = kinematics::final_level(search_.plateaus);
  motion_.notes.push_back(
      fmt::format("disc: its speed follows its angle by {:.2f} +- {:.2f} %, {} a revolution ({} plateaus); omega r "
                  "follows it",
                  100 * ripple.amplitude, 100 * ripple.amplitude_std_error,
                  ripple.order == 1 ? "once" : fmt::format("{} times", ripple.order), ripple_.plateaus));
}

/// The integration constants of an undone high-pass came from plateaus with the ripple on them.
void MotionStages::undo_ripple_in_high_pass() {
  const double shift = disc_.constant - ripple_.level;
  for (std::size_t i = 0; i < trace_.size(); ++i) {
    trace_.velocity[i] += shift - ripple_.drift * (trace_.time[i] - ripple_.middle);
  }
  find_plateau();
}

void MotionStages::check_clipping() {
  recorded_ = kinematics::recorded_plateau(search_, disc_, trace_.velocity_kind);
  if (is_block() && search_.sticks && speed_is_constant()) spoilt_->add_standstill(search_, plateau_, trace_);
  clipping_ = kinematics::check_clipping(range_ends_, trace_, instruments_,
                                         {plateau_as_recorded(), is_block() && search_.sticks}, *spoilt_);
  const bool was_recorded = trace_.velocity_std_error.empty();  // else it was made from another channel
  const bool can_jump = was_recorded && search_.sticks && clipping_.status == HealthItem::Status::ok;
  const auto lost = can_jump ? kinematics::find_lost_samples(trace_, std::max(search_.noise, steps_.velocity))
                             : kinematics::LostSamples{};
  drop_outs_ = kinematics::check_drop_outs(trace_, *spoilt_, lost, search_.plateaus.runs.size());
  motion_.faults = spoilt_->take();
}

/// Where the velocity as recorded repeats in stick when there is no noise, and crowds when there is.
std::optional<LevelRange> MotionStages::plateau_as_recorded() const {
  LevelRange levels;  // of v_r
  if (is_block()) {
    const bool unknown =
        speed_is_constant() ? !search_.sticks || (is_reversed_ && !speed_was_stated_) : !recorded_.has_value();
    if (unknown) return std::nullopt;
    // Where radius, speed or gain are not as stated the block rests beside omega r.
    const Extremes rest = speed_is_constant()
                              ? Extremes{std::min(disc_.constant, plateau_), std::max(disc_.constant, plateau_)}
                              : extremes(disc_.varying);
    levels = {rest.low + taken_off(), rest.high + taken_off()};
  }
  const auto& vibrometer = instruments_.vibrometer;
  const double reading = vibrometer.sign * (vibrometer.gain ? vibrometer.gain->value : 1) * (is_reversed_ ? -1 : 1);
  return reading > 0 ? LevelRange{reading * levels.low, reading * levels.high}
                     : LevelRange{reading * levels.high, reading * levels.low};
}

void MotionStages::add_sensor_mass() {
  const auto& mass = instruments_.force_sensor.mass_below;
  if (is_block() && mass)
    kinematics::add_sensor_mass(trace_, trace_.velocity, mass->value, motion_.step, motion_.notes);
}

/// Samples before the disc has come to its speed; looked for only where that is taken as constant.
std::size_t MotionStages::run_up() const {
  if (!is_block() || !search_.sticks || !speed_is_constant()) return 0;
  const std::size_t samples = kinematics::run_up_blocks(search_) * search_.blocks.length;
  return samples + 2 > trace_.size() ? 0 : samples;
}

/// v_r, without the run-up and the ends that a correction has lost.
void MotionStages::make_relative_motion() {
  run_up_ = run_up();
  const std::size_t head = std::max(lost_.head, options_.trim ? run_up_ : 0);
  if (undoes_ripple_) kinematics::impose_ripple(trace_, disc_, ripple_, kinematics::steady_speed(trace_));
  if (is_block()) kinematics::make_relative(trace_.velocity, disc_);
  const std::pair<std::vector<double>*, std::vector<double>*> channels[] = {
      {&trace_.time, &motion_.time},
      {&trace_.friction, &motion_.friction},
      {&trace_.velocity, &motion_.relative_velocity},
      {&trace_.friction_std_error, &motion_.friction_std_error},
      {&trace_.velocity_std_error, &motion_.velocity_std_error},
      {&trace_.load, &motion_.load},
      {&trace_.temperature, &motion_.temperature},
      {&trace_.disc_speed, &motion_.disc_speed},
      {&trace_.disc_angle, &motion_.disc_angle},
      {&disc_.varying, &motion_.disc_velocity}};
  for (const auto& [from, to] : channels) {
    kinematics::drop_ends(*from, head, lost_.tail);
    *to = std::move(*from);
  }
  kinematics::drop_ends(motion_.faults, head, lost_.tail);
  motion_.trimmed = head;
  motion_.conditions = trace_.conditions;
  motion_.steps = kinematics::steps_within(trace_.steps, head, motion_.size());
}

void MotionStages::settle_signs_and_levels() {
  const bool constant = disc_.known && (motion_.disc_velocity.empty() || undoes_ripple_);
  motion_.constant_disc_velocity = constant ? disc_.constant : 0;
  motion_.sticks = search_.sticks;
  motion_.velocity_noise = std::max(search_.noise, steps_.velocity / std::sqrt(12.0));
  motion_.velocity_noise = std::max(motion_.velocity_noise, kinematics::usual_error(motion_.velocity_std_error));
  if (search_.sticks) {
    const double level = search_.plateaus.level;
    motion_.plateau_velocity = is_block() ? motion_.constant_disc_velocity - level : level;
  }
  double scale = search_.plateaus.depth;
  if (scale == 0) scale = kinematics::largest_of(motion_.relative_velocity);
  if (disc_.largest > 0 || !is_block()) kinematics::settle_friction_sign(motion_, scale);
}

void MotionStages::check_health() {
  const bool velocity_was_measured = motion_.velocity_kind != VelocityKind::fixed_block;
  const std::span<const double> velocity =
      velocity_was_measured ? std::span<const double>(motion_.relative_velocity) : std::span<const double>();
  const auto restick =
      motion_.sticks && velocity_was_measured && motion_.velocity_std_error.empty()
          ? kinematics::find_low_pass(velocity, motion_.plateau_velocity, motion_.velocity_noise, motion_.step)
          : kinematics::LowPass{};
  motion_.health = {
      std::move(clipping_),
      std::move(drop_outs_),
      kinematics::check_sagging(sag_, declared_high_pass_, motion_.high_pass > 0, search_.sticks),
      kinematics::check_bandwidth(motion_.friction, velocity, motion_.step, restick),
      kinematics::check_channel_delay(motion_, plateaus_in_motion(), search_.blocks.length),
      kinematics::check_revolutions(motion_),
      kinematics::check_speed_ripple(motion_, ripple_),
      kinematics::check_run_up(motion_, options_.trim, run_up_),
      check_level(),
      kinematics::check_resolution(steps_, motion_.friction_kind, search_.noise),
  };
}

HealthItem MotionStages::check_level() const {
  const bool can_be_held = motion_.sticks || motion_.constant_disc_velocity != 0;
  if (motion_.velocity_kind == VelocityKind::relative && can_be_held) {
    HealthItem item = kinematics::check_measured_velocity(motion_, plateaus_in_motion(), search_.blocks.length);
    kinematics::add_zero(zero_, true, item);
    return item;
  }
  const double stated = speed_was_stated_ ? disc_.constant : 0;
  if (!speed_levels_.empty()) return kinematics::check_speed_steps(motion_, speed_levels_, search_.blocks, stated);
  HealthItem item = kinematics::check_plateau_speed(motion_, plateau_, speed_was_stated_,
                                                    motion_.conditions.radius.known(), recorded_);
  kinematics::add_zero(zero_, speed_was_stated_, item);
  return item;
}

void MotionStages::compare_plateau() {
  if (!is_block() || !speed_was_stated_ || !search_.sticks) return;
  kinematics::PlateauRatio ratio = plateau_ratio(motion_, plateaus_in_motion(), search_.blocks.length);
  const double rounding = kinematics::rounding_of_level(steps_.velocity, search_.noise);
  if (disc_.largest > 0) ratio.std_error = std::hypot(ratio.std_error, rounding / disc_.largest);
  motion_.plateau_ratio = ratio.value;
  motion_.plateau_ratio_std_error = ratio.std_error;
  correct_plateau(motion_, ratio, options_.plateau);
}

}  // namespace

Motion compute_motion(Trace trace, const Instruments& instruments, const MotionOptions& options) {
  if (trace.kind == RecordKind::points) return kinematics::motion_of_points(std::move(trace), instruments, options);
  std::vector<std::string> notes;
  MotionOptions own = options;
  if (trace.kind == RecordKind::spring_slider) {
    kinematics::make_block_of_spring(trace, notes);
    own.undo_high_pass = own.undo_speed_ripple = false;  // nothing of either is between the pull and its slope
  }
  MotionStages stages(std::move(trace), instruments, own);
  stages.look_at_recording();
  stages.correct_declared();
  stages.find_disc();
  stages.find_plateau();
  stages.find_direction();
  stages.undo_high_pass();
  stages.find_zero();
  stages.find_speed_steps();
  stages.take_speed_from_plateau();
  stages.undo_ripple();
  stages.check_clipping();
  stages.add_sensor_mass();
  stages.make_relative_motion();
  stages.settle_signs_and_levels();
  stages.check_health();
  stages.compare_plateau();
  Motion motion = stages.take();
  motion.notes.insert(motion.notes.begin(), notes.begin(), notes.end());
  return motion;
}

}  // namespace tribofit
