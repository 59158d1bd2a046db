#include "tribofit/kinematics/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "corrections.hpp"
#include "health_checks.hpp"
#include "high_pass.hpp"
#include "plateau.hpp"
#include "plateau_ratio.hpp"
#include "plateau_search.hpp"
#include "ripple.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {
namespace {

using kinematics::add_sensor_mass;
using kinematics::Disc;
using kinematics::disc_of;
using kinematics::disc_slopes;
using kinematics::final_level;
using kinematics::find_rests;
using kinematics::first_known;
using kinematics::HighPassEstimate;
using kinematics::largest_of;
using kinematics::LevelRange;
using kinematics::PlateauSearch;
using kinematics::Rests;
using kinematics::RippleEstimate;
using kinematics::run_up_blocks;
using kinematics::StickPlateau;

void require_channels(const Trace& trace) {
  const std::size_t n = trace.size();
  const InputLocation where{trace.path, 0, ""};
  if (n < 2) throw InputError("the trace has fewer than two samples", "give a longer record", where);
  if (trace.friction.size() != n)
    throw InputError("the trace has no friction for every sample", "name the friction column", where);
  if (trace.velocity_kind != VelocityKind::fixed_block && trace.velocity.size() != n) {
    throw InputError("the trace has no velocity for every sample",
                     "name the column with --columns v_b=NAME or v_r=NAME", where);
  }
}

void take_conditions_from_instruments(Conditions& conditions, const Instruments::Rig& rig) {
  const auto take = [](Condition& condition, const std::optional<Declared>& declared) {
    if (!condition.known() && declared) condition = {declared->value, "instruments"};
  };
  take(conditions.radius, rig.radius);
  take(conditions.speed, rig.speed);
  take(conditions.load, rig.load);
}

// The direction of the vibrometer, where nobody declared it, from the plateau.
bool points_the_other_way(const Trace& trace, const Disc& disc, const PlateauSearch& s) {
  if (!s.sticks || trace.velocity_kind != VelocityKind::block || !disc.varying.empty()) return false;
  if (disc.known) return s.rests.level * disc.constant < 0;
  double sum = 0;
  for (const StickPlateau& run : s.rests.runs) {
    const auto part = std::span<const double>(trace.friction).subspan(run.inner_begin() * s.blocks.length);
    sum += part[0] + part[(run.inner_end() - run.inner_begin()) * s.blocks.length - 1];
  }
  return s.rests.level < 0 && sum > 0;
}

void drop_ends(std::vector<double>& channel, std::size_t head, std::size_t tail) {
  if (channel.empty()) return;
  channel.resize(channel.size() - tail);
  if (head > 0) channel.erase(channel.begin(), channel.begin() + static_cast<std::ptrdiff_t>(head));
}

std::vector<Step> steps_within(const std::vector<Step>& steps, std::size_t head, std::size_t size) {
  std::vector<Step> kept;
  for (Step step : steps) {
    step.begin = step.begin > head ? step.begin - head : 0;
    step.end = std::min(step.end > head ? step.end - head : 0, size);
    if (step.begin < step.end) kept.push_back(std::move(step));
  }
  return kept;
}

// v_r in the place of v_b.
void make_relative(std::vector<double>& velocity, const Disc& disc) {
  if (disc.varying.empty()) {
    const double constant = disc.constant;
    for (double& v : velocity) v = constant - v;
  } else {
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = disc.varying[i] - velocity[i];
  }
}

// Friction opposes sliding: where it is recorded with the other sign throughout, the sign is settled once.
void settle_friction_sign(Motion& motion, double scale) {
  if (scale == 0) return;
  double agreement = 0, total = 0;
  const std::size_t stride = std::max<std::size_t>(1, motion.size() / 65536);
  for (std::size_t i = 0; i < motion.size(); i += stride) {
    const double v = motion.relative_velocity[i];
    if (std::abs(v) < 0.1 * scale) continue;
    agreement += v > 0 ? motion.friction[i] : -motion.friction[i];
    total += std::abs(motion.friction[i]);
  }
  if (agreement >= -0.5 * total || total == 0) return;
  for (double& mu : motion.friction) mu = -mu;
  motion.notes.push_back("friction: sign reversed so that it is positive where v_r is");
}

// Where v_b rests beside a recorded speed. A record whose rests follow the recorded speed is compared there; where none
// do, or far from it, the rests of v_b alone tell what the disc did.
std::optional<kinematics::RecordedPlateau> recorded_plateau(const PlateauSearch& s, const Disc& disc, bool block) {
  if (!block || disc.varying.empty() || s.disc.mean.empty()) return std::nullopt;
  const auto recorded_in = [&](const Rests& rests) {
    double sum = 0;
    std::size_t count = 0;
    for (const StickPlateau& run : rests.runs) {
      for (std::size_t b = run.begin; b < run.end; ++b) sum += s.disc.mean[b], ++count;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, count));
  };
  std::optional<kinematics::RecordedPlateau> following;
  if (s.sticks) {
    const double recorded = recorded_in(s.rests);
    following = {recorded + s.rests.level, recorded};
    if (std::abs(s.rests.level) <= 0.2 * std::abs(recorded)) return following;
  }
  const std::span<const double> v(s.blocks.mean);
  const Extremes range = extremes(v);
  Rests alone = range.high - range.low <= 8 * s.noise ? Rests{{{0, v.size(), fit_line(v).value}}, 0, 0} : find_rests(v);
  if (alone.level == 0 && !alone.empty()) alone.level = alone.runs.front().level;
  std::size_t resting = 0;
  for (const StickPlateau& run : alone.runs) resting += run.size();
  const bool rests = 10 * resting > v.size() && std::abs(alone.level) > 3 * s.noise;
  return rests ? kinematics::RecordedPlateau{alone.level, recorded_in(alone)} : following;
}

// Where the velocity as recorded repeats in stick when there is no noise.
std::optional<double> plateau_as_recorded(const PlateauSearch& s, const Disc& disc, const Instruments& instruments,
                                          bool block, bool stated, bool reversed,
                                          const std::optional<kinematics::RecordedPlateau>& recorded) {
  double level = 0;  // of v_r
  if (block) {
    if (!disc.varying.empty() && !recorded) return std::nullopt;
    if (disc.varying.empty() && (!s.sticks || (reversed && !stated))) return std::nullopt;
    level = !disc.varying.empty() ? recorded->disc : disc.constant;
  }
  const auto& vibrometer = instruments.vibrometer;
  return level * vibrometer.sign * (vibrometer.gain ? vibrometer.gain->value : 1) * (reversed ? -1 : 1);
}

// A channel that was not recorded, or a handful of samples: valid, but nothing can be found in it.
bool is_useless(const Trace& trace) {
  constexpr std::size_t few = 16;
  const Extremes range = extremes(trace.velocity);
  return range.low == range.high || (trace.size() < few && trace.conditions.radius.known());
}

[[noreturn]] void throw_no_speed(const Trace& trace) {
  throw InputError("v_r cannot be made: the block never sticks, so that no plateau shows the speed of the disc",
                   "give --radius and --speed, or a column with v_r", {trace.path, 0, ""});
}

// The one stated speed of the whole record [rad/s], NaN where there are several or it was recorded.
double steady_speed(const Trace& trace) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!trace.disc_speed.empty() || !trace.disc_angle.empty()) return none;
  double speed = none;
  for (const Step& step : trace.steps) {
    const double here = first_known(step.conditions.speed, trace.conditions.speed).value;
    if (speed == speed && here != speed) return none;
    speed = here;
  }
  return speed;
}

// A ripple of the disc's speed. Where the speed is read off the plateau, it is read off again without the ripple.
RippleEstimate find_ripple(Trace& trace, const PlateauSearch& s, Disc& disc, bool stated) {
  if (!s.sticks || !disc.varying.empty() || trace.velocity_kind != VelocityKind::block) return {};
  const double omega = steady_speed(trace);
  if (!(std::abs(omega) > 0)) return {};
  RippleEstimate ripple = estimate_ripple(s.blocks, s.rests, omega, trace.time, trace.friction);
  const bool from_plateau = trace.conditions.speed.source == "plateau" && trace.conditions.radius.known();
  if (stated) return ripple;
  Condition speed = trace.conditions.speed;
  for (int pass = 0; pass < 3 && from_plateau && ripple.level != 0; ++pass) {
    speed.value = ripple.level / trace.conditions.radius.value;
    ripple = estimate_ripple(s.blocks, s.rests, speed.value, trace.time, trace.friction);
  }
  if (!ripple.significant) return ripple;
  disc.constant = ripple.level;
  if (from_plateau) trace.conditions.speed = speed;
  return ripple;
}

// The survey as a disc without the ripple would have shown it.
void flatten(PlateauSearch& s, const RippleEstimate& ripple, double omega, std::span<const double> time) {
  std::vector<double> middles(s.blocks.mean.size());
  for (std::size_t b = 0; b < middles.size(); ++b) middles[b] = time[b * s.blocks.length + s.blocks.length / 2];
  const kinematics::RippledDisc rippled = kinematics::rippled_disc(ripple, omega, middles);
  for (std::size_t b = 0; b < middles.size(); ++b) s.blocks.mean[b] /= rippled.factor[b];
  const double near = 0.5 * s.rests.level, far = 1.5 * s.rests.level;
  Rests rests = find_rests(s.blocks.mean, LevelRange{std::min(near, far), std::max(near, far)});
  if (!rests.empty()) s.rests = std::move(rests);
}

// Speed and angle of the disc, and omega r, with the ripple.
void ripple_disc(Trace& trace, Disc& disc, const RippleEstimate& ripple, double omega) {
  kinematics::RippledDisc rippled = kinematics::rippled_disc(ripple, omega, trace.time);
  trace.disc_angle = std::move(rippled.angle);
  trace.disc_speed = rippled.factor;
  disc.varying = std::move(rippled.factor);
  for (double& v : trace.disc_speed) v *= omega;
  for (double& v : disc.varying) v *= disc.constant;
  disc.largest = std::abs(disc.constant) * (1 + ripple.ripple.amplitude);
}

}  // namespace

Motion compute_motion(Trace trace, const Instruments& instruments, const MotionOptions& options) {
  require_channels(trace);
  take_conditions_from_instruments(trace.conditions, instruments.rig);
  if (trace.steps.empty()) trace.steps.push_back({0, trace.size(), "", {}});
  Motion motion;
  motion.step = trace.interval();
  motion.friction_kind = trace.friction_kind;
  motion.velocity_kind = trace.velocity_kind;
  const bool block = trace.velocity_kind == VelocityKind::block;

  // What the recorder did, on the channels as recorded; then what the user declared.
  const Chunks friction_chunks = chunks_of(trace.friction);
  const Chunks velocity_chunks = chunks_of(trace.velocity);
  const kinematics::RangeEnds ends = kinematics::range_ends(trace, friction_chunks, velocity_chunks);
  HealthItem drop_outs = kinematics::check_drop_outs(trace, friction_chunks, velocity_chunks);
  kinematics::Ends lost = kinematics::correct_declared(trace, instruments, motion.step, motion.notes);
  if (lost.head + lost.tail + 2 > trace.size()) lost = {};

  Disc disc = disc_of(trace);
  if (trace.velocity_kind == VelocityKind::fixed_block) {
    if (!disc.known) {
      throw InputError("v_r cannot be made: the block stands still and omega or r is not known",
                       "give --radius and --speed, or a column with the speed of the disc", {trace.path, 0, ""});
    }
    trace.velocity.assign(trace.size(), disc.constant);
    if (!disc.varying.empty()) trace.velocity = disc.varying;
  }

  // Where the velocity rests; a vibrometer that points the other way; a high-pass.
  PlateauSearch s = survey(trace, disc, motion.step);
  const bool reversed = points_the_other_way(trace, disc, s);
  if (reversed) {
    for (double& v : trace.velocity) v = -v;
    motion.notes.push_back("velocity: sign reversed, the plateau runs against the disc");
    s = survey(trace, disc, motion.step);
  }
  HighPassEstimate sag;
  std::optional<double> declared;
  if (block && instruments.vibrometer.high_pass) declared = instruments.vibrometer.high_pass->value;
  if (block && s.sticks) sag = estimate_high_pass(s.blocks, s.rests, disc_slopes(s));
  const bool undo = declared || (sag.significant && options.undo_high_pass);
  if (undo) {
    motion.high_pass = declared ? *declared : sag.corner;
    motion.high_pass_std_error = declared ? instruments.vibrometer.high_pass->uncertainty : sag.std_error;
    const double level = disc.known && disc.varying.empty() ? disc.constant : disc.known ? 0 : std::nan("");
    restore(trace.velocity, motion.step, restoring_terms(s.blocks, s.rests, motion.high_pass, level, s.disc.mean));
    s = survey(trace, disc, motion.step);
  }

  // Speed from the plateau where nobody said it.
  const bool stated = disc.known;
  double plateau = s.sticks ? final_level(s.rests) : 0;
  if (block && !disc.known) {
    const bool unknown = !s.sticks || trace.disc_speed.size() == trace.size();
    if (unknown && !is_useless(trace)) throw_no_speed(trace);
    if (unknown) motion.notes.push_back("the speed of the disc is not known and no plateau shows it: v_r is -v_b");
    disc.known = true;
    disc.constant = unknown ? 0 : plateau;
    disc.largest = std::abs(disc.constant);
    if (!unknown && trace.conditions.radius.known()) {
      trace.conditions.speed = {plateau / trace.conditions.radius.value, "plateau"};
    }
  }
  const RippleEstimate ripple = find_ripple(trace, s, disc, stated);
  const bool undo_ripple = ripple.significant && options.undo_speed_ripple;
  const double omega = undo_ripple ? steady_speed(trace) : 0;
  if (undo_ripple) {
    motion.speed_ripple = ripple.ripple;
    if (motion.high_pass > 0) {  // its integration constants came from plateaus with the ripple on them
      const double shift = disc.constant - ripple.level;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        trace.velocity[i] += shift - ripple.drift * (trace.time[i] - ripple.middle);
      }
      s = survey(trace, disc, motion.step);
    }
    flatten(s, ripple, omega, trace.time);
    plateau = final_level(s.rests);
    motion.notes.push_back(
        fmt::format("disc: its speed follows its angle by {:.2f} +- {:.2f} %, {} a revolution ({} plateaus); omega r "
                    "follows it",
                    100 * ripple.ripple.amplitude, 100 * ripple.ripple.amplitude_std_error,
                    ripple.ripple.order == 1 ? "once" : fmt::format("{} times", ripple.ripple.order), ripple.plateaus));
  }
  const auto recorded = recorded_plateau(s, disc, block);
  HealthItem clipping = check_clipping(ends, trace, instruments,
                                       plateau_as_recorded(s, disc, instruments, block, stated, reversed, recorded));
  if (block && instruments.force_sensor.mass_below) {
    add_sensor_mass(trace, trace.velocity, instruments.force_sensor.mass_below->value, motion.step, motion.notes);
  }

  // Run-up: only where the speed is taken as constant.
  std::size_t run_up = block && s.sticks && disc.varying.empty() ? run_up_blocks(s) * s.blocks.length : 0;
  if (run_up + 2 > trace.size()) run_up = 0;
  const std::size_t head = std::max(lost.head, options.trim ? run_up : 0);

  if (undo_ripple) ripple_disc(trace, disc, ripple, omega);
  if (block) make_relative(trace.velocity, disc);
  for (auto* channel : {&trace.time, &trace.friction, &trace.velocity, &trace.load, &trace.temperature,
                        &trace.disc_speed, &trace.disc_angle, &disc.varying}) {
    drop_ends(*channel, head, lost.tail);
  }
  motion.trimmed = head;
  motion.time = std::move(trace.time);
  motion.friction = std::move(trace.friction);
  motion.relative_velocity = std::move(trace.velocity);
  motion.load = std::move(trace.load);
  motion.temperature = std::move(trace.temperature);
  motion.disc_speed = std::move(trace.disc_speed);
  motion.disc_angle = std::move(trace.disc_angle);
  motion.disc_velocity = std::move(disc.varying);
  const bool constant = disc.known && (motion.disc_velocity.empty() || undo_ripple);
  motion.constant_disc_velocity = constant ? disc.constant : 0;
  motion.conditions = trace.conditions;
  motion.steps = steps_within(trace.steps, head, motion.size());
  motion.sticks = s.sticks;
  motion.velocity_noise = s.noise;
  if (s.sticks) {
    const double level = s.rests.level;
    motion.plateau_velocity = !block ? level : motion.constant_disc_velocity - level;
  }
  double scale = s.rests.depth;
  if (scale == 0) scale = largest_of(motion.relative_velocity);
  if (disc.largest > 0 || !block) settle_friction_sign(motion, scale);

  // Rests in blocks of the trimmed record.
  Rests rests = s.rests;
  const std::size_t cut = (head + s.blocks.length - 1) / s.blocks.length, kept = motion.size() / s.blocks.length;
  std::erase_if(rests.runs, [&](const StickPlateau& run) { return run.begin < cut || run.end - cut > kept; });
  for (StickPlateau& run : rests.runs) run.begin -= cut, run.end -= cut;

  motion.health = {
      std::move(clipping),
      std::move(drop_outs),
      kinematics::check_sagging(sag, declared, undo, s.sticks),
      kinematics::check_bandwidth(motion.friction,
                                  motion.velocity_kind == VelocityKind::fixed_block
                                      ? std::span<const double>()
                                      : std::span<const double>(motion.relative_velocity),
                                  motion.step),
      kinematics::check_channel_delay(motion, rests, s.blocks.length),
      kinematics::check_revolutions(motion),
      kinematics::check_speed_ripple(motion, ripple),
      kinematics::check_run_up(motion, options.trim, run_up),
      kinematics::check_plateau_speed(motion, plateau, stated, motion.conditions.radius.known(), recorded)};
  if (block && stated && s.sticks) {
    const kinematics::PlateauRatio ratio = plateau_ratio(motion, rests, s.blocks.length);
    motion.plateau_ratio = ratio.value;
    motion.plateau_ratio_std_error = ratio.std_error;
    correct_plateau(motion, ratio, options.plateau);
  }
  return motion;
}

}  // namespace tribofit
