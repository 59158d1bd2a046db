#include "tribofit/kinematics/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "displacement.hpp"
#include "held_values.hpp"
#include "load_point.hpp"
#include "motion_channels.hpp"
#include "motion_stages.hpp"
#include "records_without_motion.hpp"
#include "spring_slider.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::kinematics {

namespace {

/// Makes velocity, or friction, or both, of the channels from which they follow. False where they were recorded.
bool make_missing_channels(Trace& trace, std::vector<std::string>& notes) {
  if (trace.kind == RecordKind::spring_slider) {
    make_block_of_spring(trace, notes);
  } else if (trace.kind == RecordKind::motion_only) {
    make_friction_of_motion(trace, notes);
  } else if (trace.velocity.empty() && !(trace.block_position.empty() && trace.drive_position.empty())) {
    make_velocity_of_displacement(trace, notes);
  } else {
    return false;
  }
  return true;
}

}  // namespace

MotionStages::MotionStages(Trace trace, const Instruments& instruments, const MotionOptions& options)
    : trace_(std::move(trace)), instruments_(instruments), options_(options), threads_(options.threads) {
  kinematics::require_channels(trace_);
  kinematics::take_conditions_from_instruments(trace_.conditions, instruments.rig);
  if (trace_.steps.empty()) trace_.steps.push_back({0, trace_.size(), "", {}});
  motion_.step = trace_.interval();
  kinematics::take_kinds(trace_, options.stick, motion_);
  motion_.clock_offset_std_error = trace_.clock_offset_std_error;
}

/// What the recorder did: its range and its gaps.
void MotionStages::look_at_recording() {
  samples_.emplace(trace_, threads_);
  samples_->add_unsure(kinematics::unsure_samples(trace_));
}

void MotionStages::correct_declared() {
  Instruments corrected = instruments_;
  if (!options_.undo_bandwidth) corrected.force_sensor.bandwidth.reset();
  lost_ = kinematics::correct_declared(trace_, corrected, motion_.step, motion_.notes);
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

/// What the velocity reads at rest, before the speed of the disc need be known.
void MotionStages::read_at_rest() {
  const std::optional<Declared>& stated = instruments_.vibrometer.high_pass;
  if (is_block() && stated) declared_high_pass_ = stated->value;
  if (!is_block() || !search_.sticks) return;
  positions_ = kinematics::positions_in_plateaus(trace_.time, trace_.velocity, search_, threads_);
  rest_ = kinematics::fit_rest(trace_, search_,
                               {.high_pass = true, .crosstalk = !stated, .drive = !stated && speed_is_constant()},
                               kinematics::mean_velocity(positions_));
  if (!rest_.crosstalk.any() || !options_.undo_distortions) return;
  motion_.velocity_crosstalk = rest_.crosstalk;
  for (std::size_t i = 0; i < trace_.size(); ++i) trace_.velocity[i] -= rest_.crosstalk.value * trace_.friction[i];
  motion_.notes.push_back(fmt::format("velocity: it reads {} mm/s for each unit of friction, taken off",
                                      general(1e3 * rest_.crosstalk.value, 3)));
  positions_ = {};
  find_plateau();
}

void MotionStages::undo_high_pass() {
  const std::optional<Declared>& stated = instruments_.vibrometer.high_pass;
  if (!declared_high_pass_ && !(rest_.high_pass_is_found && options_.undo_high_pass)) return;
  motion_.high_pass = declared_high_pass_ ? *declared_high_pass_ : rest_.high_pass.value;
  motion_.high_pass_std_error = declared_high_pass_ ? stated->uncertainty : rest_.high_pass.std_error;
  positions_ = {};
  const double level = disc_.known && speed_is_constant() ? disc_.constant : disc_.known ? 0 : std::nan("");
  kinematics::restore(
      trace_.velocity, motion_.step,
      kinematics::restoring_terms(search_.blocks, search_.plateaus, motion_.high_pass, level, search_.disc.mean));
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
    samples_->add_unknown(change);
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
    if (search_.sticks && !trace_.conditions.radius.known()) {
      throw InputError("v_r cannot be made: the speed of the disc is recorded, but not the radius of the contact",
                       "give --radius, as in --radius 15mm", {trace_.path, 0, ""});
    }
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

/// A disc that does not turn at one speed: it follows its angle, or slows down under friction.
void MotionStages::follow_disc() {
  if (!is_block() || !search_.sticks || !speed_is_constant()) return;
  double omega = kinematics::steady_speed(trace_);
  const bool slows = rest_.drive.any() && motion_.high_pass == 0;
  // A speed that was read off the plateau is read off again without the ripple.
  const bool is_read = trace_.conditions.speed.source == "plateau" && trace_.conditions.radius.known();
  constexpr int kRounds = 3;
  for (int round = 0; round == 0 || (is_read && round < kRounds); ++round) {
    disc_at_rest_ =
        kinematics::fit_rest(trace_, search_, {.drive = slows, .disc_speed = std::abs(omega) > 0 ? omega : 0}, {});
    if (is_read && disc_at_rest_.level.value != 0) omega = disc_at_rest_.level.value / trace_.conditions.radius.value;
  }
  if (!disc_at_rest_.ripple_is_found && !disc_at_rest_.drive.any()) return;
  if (!speed_was_stated_) disc_.constant = disc_at_rest_.level.value;
  if (is_read) trace_.conditions.speed.value = omega;
  if (!options_.undo_speed_ripple) return;
  if (motion_.high_pass > 0) take_disc_off_high_pass();
  disc_factor_ = kinematics::disc_factor(disc_at_rest_, omega, trace_, motion_.step);
  kinematics::flatten(search_, disc_factor_);
  plateau_ = kinematics::final_level(search_.plateaus);
  if (disc_at_rest_.ripple_is_found) {
    const DiscRipple& ripple = motion_.speed_ripple = disc_at_rest_.ripple;
    motion_.notes.push_back(
        fmt::format("disc: its speed follows its angle by {} +/- {} %, {} a revolution ({} plateaus); omega r "
                    "follows it",
                    fixed(100 * ripple.amplitude, 2), fixed(100 * ripple.amplitude_std_error, 2),
                    ripple.order == 1 ? "once" : fmt::format("{} times", ripple.order), disc_at_rest_.sticks));
  }
  if (!disc_at_rest_.drive.any()) return;
  // Over its speed without friction.
  const Estimate& drive = disc_at_rest_.drive;
  const double free = disc_at_rest_.level.value - drive.value * disc_at_rest_.friction_at_rest;
  motion_.drive_compliance = {-drive.value / free, drive.std_error / std::abs(free)};
  motion_.drive_time = disc_at_rest_.drive_time;
  motion_.notes.push_back(
      fmt::format("disc: it slows down by {} +/- {} % for each unit of friction, within {} ms; "
                  "omega r follows it",
                  fixed(100 * motion_.drive_compliance.value, 2), fixed(100 * motion_.drive_compliance.std_error, 2),
                  general(1e3 * motion_.drive_time, 2)));
}

/// The integration constants of an undone high-pass came from plateaus with the ripple on them.
void MotionStages::take_disc_off_high_pass() {
  const double shift = disc_.constant - disc_at_rest_.level.value;
  for (std::size_t i = 0; i < trace_.size(); ++i) {
    trace_.velocity[i] += shift - disc_at_rest_.drift * (trace_.time[i] - disc_at_rest_.middle);
  }
  find_plateau();
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

/// What v_b reads at rest over omega r, from the sticks that the motion will have.
void MotionStages::measure_ratio() {
  run_up_ = run_up();
  if (!is_block() || !speed_was_stated_ || !search_.sticks || disc_.largest == 0) return;
  kinematics::PlateauSearch relative = search_;
  std::erase_if(relative.plateaus.runs, [&](const kinematics::StickPlateau& run) {
    return options_.trim && run.begin * search_.blocks.length < run_up_;
  });
  for (std::size_t b = 0; b < relative.blocks.mean.size(); ++b)
    relative.blocks.mean[b] /= search_.disc.mean.empty() ? disc_.constant : search_.disc.mean[b];
  relative.disc = {};
  ratio_ = kinematics::fit_rest(trace_, relative, {}, {}).level;
  if (motion_.high_pass == 0 || disc_.constant == 0) return;
  // The level of v_b is an integration constant there: that the block goes nowhere says where it is.
  net_velocity_ =
      kinematics::mean_velocity(kinematics::positions_in_plateaus(trace_.time, trace_.velocity, search_, threads_));
  if (disc_.constant < 0) net_velocity_.value = -net_velocity_.value;  // along omega r
}

/// v_r, without the run-up and the ends that a correction has lost.
void MotionStages::make_relative_motion() {
  const std::size_t head = std::max(lost_.head, options_.trim ? run_up_ : 0);
  if (!disc_factor_.empty()) kinematics::impose(disc_factor_, kinematics::steady_speed(trace_), trace_, disc_);
  if (is_block()) kinematics::make_relative(trace_.velocity, disc_, threads_);
  const std::pair<std::vector<double>*, std::vector<double>*> channels[] = {
      {&trace_.time, &motion_.time},
      {&trace_.friction, &motion_.friction},
      {&trace_.velocity, &motion_.relative_velocity},
      {&trace_.friction_std_error, &motion_.friction_std_error},
      {&trace_.velocity_std_error, &motion_.velocity_std_error},
      {&trace_.acceleration, &motion_.acceleration},
      {&trace_.velocity_variance, &motion_.velocity_variance},
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
  motion_.smoothing = trace_.smoothing;
  motion_.conditions = trace_.conditions;
  motion_.steps = kinematics::steps_within(trace_.steps, head, motion_.size());
}

void MotionStages::settle_signs_and_levels() {
  const bool constant = disc_.known && (motion_.disc_velocity.empty() || !disc_factor_.empty());
  motion_.constant_disc_velocity = constant ? disc_.constant : 0;
  motion_.sticks = search_.sticks;
  motion_.velocity_noise = std::max(search_.noise, samples_->velocity_step() / std::sqrt(12.0));
  motion_.velocity_noise = std::max(motion_.velocity_noise, kinematics::usual_error(motion_.velocity_std_error));
  if (search_.sticks) {
    const double level = search_.plateaus.level;
    motion_.plateau_velocity = is_block() ? motion_.constant_disc_velocity - level : level;
  }
  double scale = search_.plateaus.depth;
  if (scale == 0) scale = kinematics::largest_of(motion_.relative_velocity);
  if (disc_.largest > 0 || !is_block()) kinematics::settle_friction_sign(motion_, scale);
  if (!search_.sticks) {
    motion_.restick_delay = motion_.step * kinematics::delay_at_reversals(motion_.friction, motion_.relative_velocity);
  }
}

}  // namespace tribofit::kinematics

namespace tribofit {

Motion compute_motion(Trace trace, const Instruments& instruments, const MotionOptions& options) {
  if (trace.kind == RecordKind::points) return kinematics::motion_of_points(std::move(trace), instruments, options);
  if (trace.kind == RecordKind::force_only) return kinematics::motion_of_force(std::move(trace));
  if (is_driven_in_steps(trace.kind)) return kinematics::motion_of_load_point(std::move(trace));
  std::vector<std::string> notes;
  kinematics::keep_fresh_values(trace, options.threads, notes);
  MotionOptions own = options;
  const bool was_made = kinematics::make_missing_channels(trace, notes);
  if (was_made) own.undo_high_pass = own.undo_speed_ripple = own.undo_distortions = false;  // of a vibrometer
  kinematics::MotionStages stages(std::move(trace), instruments, own);
  using Stages = kinematics::MotionStages;
  for (const auto stage :
       {&Stages::look_at_recording, &Stages::correct_declared, &Stages::find_disc, &Stages::find_plateau,
        &Stages::find_direction, &Stages::read_at_rest, &Stages::undo_high_pass, &Stages::undo_distortions,
        &Stages::find_speed_steps, &Stages::take_speed_from_plateau, &Stages::follow_disc, &Stages::check_clipping,
        &Stages::add_sensor_mass, &Stages::measure_ratio, &Stages::make_relative_motion,
        &Stages::settle_signs_and_levels, &Stages::check_health, &Stages::compare_plateau}) {
    stop_point();
    (stages.*stage)();
  }
  Motion motion = stages.take();
  motion.notes.insert(motion.notes.begin(), notes.begin(), notes.end());
  return motion;
}

}  // namespace tribofit
