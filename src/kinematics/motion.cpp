#include "tribofit/kinematics/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "corrections.hpp"
#include "health_checks.hpp"
#include "high_pass.hpp"
#include "plateau.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

using kinematics::add_sensor_mass;
using kinematics::block_means;
using kinematics::BlockMeans;
using kinematics::find_rests;
using kinematics::HighPassEstimate;
using kinematics::LevelRange;
using kinematics::Rest;
using kinematics::Rests;

/// omega r of every sample, or one value for all.
struct Disc {
  bool known = false;
  double constant = 0;
  std::vector<double> varying;  // empty when constant
  double largest = 0;           // |omega r|
};

const Condition& first_known(const Condition& a, const Condition& b) {
  return a.known() ? a : b;
}

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

Disc disc_of(const Trace& trace) {
  Disc disc;
  const std::size_t n = trace.size();
  const bool channel = trace.disc_speed.size() == n;
  std::vector<std::pair<const Step*, double>> parts;  // omega r, or r with a speed channel
  for (const Step& step : trace.steps) {
    const Condition& radius = first_known(step.conditions.radius, trace.conditions.radius);
    const Condition& speed = first_known(step.conditions.speed, trace.conditions.speed);
    if (!radius.known() || !(channel || speed.known())) return disc;
    parts.emplace_back(&step, channel ? radius.value : radius.value * speed.value);
  }
  if (parts.empty()) return disc;
  disc.known = true;
  const bool same = std::all_of(parts.begin(), parts.end(), [&](const auto& p) { return p.second == parts[0].second; });
  if (same && !channel) {
    disc.constant = parts[0].second;
    disc.largest = std::abs(disc.constant);
    return disc;
  }
  disc.varying.resize(n);
  for (const auto& [step, value] : parts) {
    for (std::size_t i = step->begin; i < step->end; ++i)
      disc.varying[i] = channel ? value * trace.disc_speed[i] : value;
  }
  for (double v : disc.varying) disc.largest = std::max(disc.largest, std::abs(v));
  return disc;
}

Rests evenly_spaced_windows(std::size_t samples) {
  Rests windows;
  const std::size_t count = 64, length = std::clamp<std::size_t>(samples / 4, 16, 64);
  if (samples < length) return windows;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * (samples - length) / count;
    windows.runs.push_back({begin, begin + length, 0});
  }
  return windows;
}

double largest_of(std::span<const double> values) {
  if (values.empty()) return 0;
  const kinematics::Extremes e = kinematics::extremes(values);
  return std::max(std::abs(e.low), std::abs(e.high));
}

/// The velocity in blocks, where it rests, and what its noise is.
struct Survey {
  BlockMeans blocks;  // of v_b, or of v_r where that was measured
  BlockMeans disc;    // of omega r, where it varies
  Rests rests;        // of blocks minus disc where that varies, else of blocks
  double noise = 0;   // [m/s]
  bool sticks = false;
};

Survey survey(const Trace& trace, const Disc& disc, double step) {
  Survey s;
  const std::span<const double> velocity(trace.velocity);
  const std::size_t length = kinematics::block_length(velocity);
  s.blocks = block_means(velocity, length, step);
  std::vector<double> relative = s.blocks.mean;
  if (!disc.varying.empty()) {
    s.disc = block_means(disc.varying, length, step);
    for (std::size_t b = 0; b < relative.size(); ++b) relative[b] -= s.disc.mean[b];
  }
  const double roughness = spread_about_parabolas(velocity, evenly_spaced_windows(velocity.size()).runs, 1);
  const bool block = trace.velocity_kind == VelocityKind::block;
  if (trace.velocity_kind == VelocityKind::fixed_block) {  // a block that is held cannot stick to the disc
    s.noise = roughness;
    return s;
  }
  const double stated = block && disc.known && disc.varying.empty() ? disc.constant : 0;
  const double centre = relative.empty() ? 0 : relative[relative.size() / 2];
  double spread = 0;
  for (double v : relative) spread = std::max(spread, std::abs(v - centre));
  if (spread <= 8 * roughness) {  // nothing moves: one rest, or steady sliding
    const double level = kinematics::fit_line(relative).value;
    const bool rests_on_disc = !block || !disc.varying.empty() ? std::abs(level) <= 3 * roughness
                               : disc.known ? std::abs(std::abs(level) - std::abs(stated)) < 0.5 * std::abs(stated)
                                            : std::abs(level) > 5 * roughness;
    s.noise = roughness;
    s.sticks = rests_on_disc;
    if (rests_on_disc) s.rests = {{{0, relative.size(), level}}, level, spread};
    return s;
  }
  if (!block) {
    const double limit = 0.06 * largest_of(relative);  // a rest of v_r is at zero
    s.rests = find_rests(relative, LevelRange{-limit, limit});
  } else if (!disc.varying.empty()) {
    s.rests = find_rests(relative, LevelRange{-0.5 * disc.largest, 0.5 * disc.largest});
  } else if (disc.known) {
    // First where it ought to be, then pointing the other way, then anywhere but at rest.
    const double near = 0.5 * std::abs(stated), far = 1.5 * std::abs(stated);
    const LevelRange right = stated > 0 ? LevelRange{near, far} : LevelRange{-far, -near};
    s.rests = find_rests(relative, right);
    if (s.rests.empty()) s.rests = find_rests(relative, LevelRange{-right.high, -right.low});
  }
  if (block && s.rests.empty() && disc.varying.empty()) s.rests = find_rests(relative);
  s.noise = s.rests.empty() ? roughness : spread_about_parabolas(velocity, s.rests.runs, s.blocks.length);
  if (s.noise == 0) s.noise = s.rests.empty() ? 0 : std::min(roughness, 1e-3 * s.rests.depth);
  s.sticks = !s.rests.empty() && (!block || !disc.varying.empty() || std::abs(s.rests.level) > 3 * s.noise);
  if (!s.sticks) s.rests.runs.clear();
  return s;
}

// The direction of the vibrometer, where nobody declared it, from the plateau.
bool points_the_other_way(const Trace& trace, const Disc& disc, const Survey& s) {
  if (!s.sticks || trace.velocity_kind != VelocityKind::block || !disc.varying.empty()) return false;
  if (disc.known) return s.rests.level * disc.constant < 0;
  double sum = 0;
  for (const Rest& run : s.rests.runs) {
    const auto part = std::span<const double>(trace.friction).subspan(run.inner_begin() * s.blocks.length);
    sum += part[0] + part[(run.inner_end() - run.inner_begin()) * s.blocks.length - 1];
  }
  return s.rests.level < 0 && sum > 0;
}

std::vector<double> disc_slopes(const Survey& s) {
  std::vector<double> slopes;
  if (s.disc.mean.empty()) return slopes;
  for (const Rest& run : s.rests.runs) {
    const auto part =
        std::span<const double>(s.disc.mean).subspan(run.inner_begin(), run.inner_end() - run.inner_begin());
    slopes.push_back(kinematics::fit_line(part).slope / s.blocks.step);
  }
  return slopes;
}

// The level towards which the plateaus tend: median over the second half of the record.
double final_level(const Rests& rests) {
  std::vector<double> levels;
  for (std::size_t r = rests.runs.size() / 2; r < rests.runs.size(); ++r) levels.push_back(rests.runs[r].level);
  return kinematics::median(std::move(levels));
}

/// Blocks before the plateau comes within 2 % of its final value and stays there.
std::size_t run_up_blocks(const Survey& s) {
  if (s.rests.runs.size() < 3) return 0;
  const double level = final_level(s.rests);
  const std::span<const double> v(s.blocks.mean);
  struct Piece {
    std::size_t begin;
    double level;
  };
  std::vector<Piece> pieces;
  for (const Rest& run : s.rests.runs) {
    // The first rest may be the run-up itself: it is looked at from end to end, and more finely.
    const bool first = run.begin == 0;
    const std::size_t begin = first ? 0 : run.inner_begin(), end = first ? run.end - run.size() / 32 : run.inner_end();
    const std::size_t length = std::max<std::size_t>(1, (end - begin) / (first ? 64 : 16));
    for (std::size_t b = begin; b + length <= end; b += length) {
      pieces.push_back({b, kinematics::fit_line(v.subspan(b, length)).value});
    }
  }
  const double tolerance = std::max(0.02 * std::abs(level), 4 * s.noise);
  const auto settled = [&](const Piece& p) { return std::abs(p.level - level) <= tolerance; };
  // A disc that starts from rest begins well below its final speed; a disc that ripples does not settle.
  const std::size_t head = s.rests.runs.front().begin;
  std::vector<double> gaps;
  for (std::size_t r = 1; r < s.rests.runs.size(); ++r) {
    gaps.push_back(static_cast<double>(s.rests.runs[r].begin - s.rests.runs[r - 1].end));
  }
  const bool slow_head =
      static_cast<double>(head) > 3 * kinematics::median(std::move(gaps)) && std::abs(v[0]) < 0.5 * std::abs(level);
  std::size_t k = 0;
  if (std::abs(pieces.front().level) < 0.9 * std::abs(level)) {
    while (k < pieces.size() && !settled(pieces[k])) ++k;
    const auto later =
        static_cast<double>(std::count_if(pieces.begin() + static_cast<std::ptrdiff_t>(k), pieces.end(), settled));
    if (later < 0.9 * static_cast<double>(pieces.size() - k)) return slow_head ? head : 0;
    // Ringing after a re-stick at the very beginning is no run-up either.
    std::vector<double> durations;
    for (const Rest& run : s.rests.runs) durations.push_back(static_cast<double>(run.size()));
    const double least = 0.25 * kinematics::median(std::move(durations));
    return k < pieces.size() && static_cast<double>(pieces[k].begin) > least ? pieces[k].begin : 0;
  }
  return slow_head ? head : 0;
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
std::optional<kinematics::RecordedPlateau> recorded_plateau(const Survey& s, const Disc& disc, bool block) {
  if (!block || disc.varying.empty() || s.disc.mean.empty()) return std::nullopt;
  const auto recorded_in = [&](const Rests& rests) {
    double sum = 0;
    std::size_t count = 0;
    for (const Rest& run : rests.runs) {
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
  const kinematics::Extremes range = kinematics::extremes(v);
  Rests alone = range.high - range.low <= 8 * s.noise ? Rests{{{0, v.size(), kinematics::fit_line(v).value}}, 0, 0}
                                                      : find_rests(v);
  if (alone.level == 0 && !alone.empty()) alone.level = alone.runs.front().level;
  std::size_t resting = 0;
  for (const Rest& run : alone.runs) resting += run.size();
  const bool rests = 10 * resting > v.size() && std::abs(alone.level) > 3 * s.noise;
  return rests ? kinematics::RecordedPlateau{alone.level, recorded_in(alone)} : following;
}

// Where the velocity as recorded repeats in stick when there is no noise.
std::optional<double> plateau_as_recorded(const Survey& s, const Disc& disc, const Instruments& instruments, bool block,
                                          bool stated, bool reversed,
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
  const kinematics::Extremes range = kinematics::extremes(trace.velocity);
  return range.low == range.high || (trace.size() < few && trace.conditions.radius.known());
}

[[noreturn]] void throw_no_speed(const Trace& trace) {
  throw InputError("v_r cannot be made: the block never sticks, so that no plateau shows the speed of the disc",
                   "give --radius and --speed, or a column with v_r", {trace.path, 0, ""});
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
  const kinematics::Chunks friction_chunks = kinematics::chunks_of(trace.friction);
  const kinematics::Chunks velocity_chunks = kinematics::chunks_of(trace.velocity);
  const kinematics::RangeEnds ends = kinematics::range_ends(trace, friction_chunks, velocity_chunks);
  HealthItem drop_outs = check_drop_outs(trace, friction_chunks, velocity_chunks);
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
  Survey s = survey(trace, disc, motion.step);
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
  const double plateau = s.sticks ? final_level(s.rests) : 0;
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
  motion.constant_disc_velocity = disc.known && motion.disc_velocity.empty() ? disc.constant : 0;
  motion.conditions = trace.conditions;
  motion.steps = steps_within(trace.steps, head, motion.size());
  motion.sticks = s.sticks;
  motion.velocity_noise = s.noise;
  if (s.sticks) {
    const double level = s.rests.level;
    motion.plateau_velocity = !block                         ? level
                              : motion.disc_velocity.empty() ? motion.constant_disc_velocity - level
                                                             : -level;
  }
  double scale = s.rests.depth;
  if (scale == 0) scale = largest_of(motion.relative_velocity);
  if (disc.largest > 0 || !block) settle_friction_sign(motion, scale);

  // Rests in blocks of the trimmed record.
  Rests rests = s.rests;
  const std::size_t cut = (head + s.blocks.length - 1) / s.blocks.length, kept = motion.size() / s.blocks.length;
  std::erase_if(rests.runs, [&](const Rest& run) { return run.begin < cut || run.end - cut > kept; });
  for (Rest& run : rests.runs) run.begin -= cut, run.end -= cut;

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
      kinematics::check_speed_ripple(motion, rests, s.blocks.length),
      kinematics::check_run_up(motion, options.trim, run_up),
      kinematics::check_plateau_speed(motion, plateau, stated, motion.conditions.radius.known(), recorded)};
  return motion;
}

}  // namespace tribofit
