#include "tribofit/segmentation/cycles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "break_away.hpp"
#include "counts.hpp"
#include "limits.hpp"
#include "phases.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {
namespace {

using segmentation::BreakAway;
using segmentation::Onset;
using segmentation::RawSlip;
using segmentation::Thresholds;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Index of the first sample later than `time`, near `guess`.
std::size_t first_after(const std::vector<double>& time, double t, std::size_t guess) {
  std::size_t i = std::min(guess, time.size());
  while (i > 0 && time[i - 1] > t) --i;
  while (i < time.size() && time[i] <= t) ++i;
  return i;
}

Cycle blank_cycle(const RawSlip& slip) {
  Cycle c;
  c.direction = slip.direction;
  c.slip = slip.samples;
  c.slip_complete = false;
  c.break_away_time = c.break_away_time_std_error = c.restick_time = unknown;
  c.stick_time = c.slip_time = c.period = unknown;
  c.break_away_friction = c.break_away_friction_std_error = c.stick_slope = c.stick_maximum = unknown;
  c.slip_minimum = c.peak_velocity = c.plateau_velocity = unknown;
  return c;
}

/// Whether the record begins with what may be the end of a slip, or ringing after it.
bool begins_in_doubt(const std::vector<RawSlip>& slips) {
  return slips.size() > 1 && slips.front().may_be_ringing;
}

/// The cycles of a record as they are found: slips in order, each with the stick before it, then the break-aways.
class PhaseFinder {
 public:
  PhaseFinder(const Motion& motion, const std::vector<RawSlip>& slips, const Thresholds& thresholds, int threads)
      : motion_(motion), slips_(slips), thresholds_(thresholds), threads_(threads) {}

  std::vector<Cycle> find() {
    for (const RawSlip& slip : slips_) cycles_.push_back(blank_cycle(slip));
    std::vector<std::size_t> after(slips_.size());  // the first sample of what follows a slip
    run_tasks(slips_.size(), threads_, [&](std::size_t k) { after[k] = end_slip(k, cycles_[k]); });
    for (std::size_t k = 0; k < slips_.size(); ++k) begin_stick(k, k > 0 ? after[k - 1] : 0);
    if (!cycles_.empty()) end_in_stick(cycles_.back(), slips_.back().ends_within && can_stick());
    set_break_aways();
    if (begins_in_doubt(slips_)) {  // neither slip nor stick: it has only shown where the first stick begins
      cycles_.erase(cycles_.begin());
      cycles_.front().stick_complete = false;
    }
    return std::move(cycles_);
  }

 private:
  bool can_stick() const { return motion_.velocity_kind != VelocityKind::fixed_block; }

  static void end_in_stick(Cycle& c, bool does) {
    c.slip_complete = does;
    if (!does) c.restick_time = unknown;
  }

  /// Returns the first sample of what follows the slip. Friction jumps at re-stick: a sample that may lie on either
  /// side of it belongs to neither phase.
  std::size_t end_slip(std::size_t k, Cycle& c) const {
    const RawSlip& slip = slips_[k];
    if (!slip.ends_within) return slip.samples.end;
    const std::size_t next = k + 1 < slips_.size() ? slips_[k + 1].samples.begin : motion_.size();
    c.restick_time = segmentation::locate_restick(motion_, slip.samples, next, slip.direction, thresholds_.peak);
    const double half = 0.5 * motion_.step;
    c.slip.end = std::max(slip.samples.begin + 1, first_after(motion_.time, c.restick_time - half, slip.samples.end));
    return std::max(c.slip.end, first_after(motion_.time, c.restick_time + half, slip.samples.end));
  }

  /// The stick before slip k, from sample `first` on. Where the motion only reverses, the slip before has not ended in
  /// stick.
  void begin_stick(std::size_t k, std::size_t first) {
    const RawSlip& slip = slips_[k];
    Cycle& c = cycles_[k];
    bool sticks = slip.begins_within && can_stick();
    if (k > 0) {
      sticks = sticks && !segmentation::only_reverses(motion_, slips_[k - 1], slip, thresholds_);
      end_in_stick(cycles_[k - 1], slips_[k - 1].ends_within && sticks);
    }
    if (!sticks || first >= slip.samples.begin) return;
    c.stick = {first, slip.samples.begin};
    c.stick_complete = k > 0;
    with_stick_.push_back(k);
    onsets_.push_back({first, slip.samples.begin, c.slip.end, slip.direction});
  }

  void set_break_aways() {
    const std::vector<BreakAway> found = segmentation::locate_break_aways(motion_, onsets_, thresholds_.peak, threads_);
    for (std::size_t k = 0; k < found.size(); ++k) {
      Cycle& c = cycles_[with_stick_[k]];
      const std::size_t first = std::max(c.stick.begin, first_after(motion_.time, found[k].time, c.stick.end));
      c.stick.end = std::min(first, c.slip.end - 1);
      c.is_sharp = found[k].is_sharp;
      const double either = std::min(segmentation::kBeforeOrAfter * found[k].std_error, motion_.step);
      const double surely_after = found[k].time + either;
      c.slip.begin = c.is_sharp
                         ? std::clamp(first_after(motion_.time, surely_after, c.slip.end), c.stick.end, c.slip.end - 1)
                         : c.stick.end;
      if (c.stick.size() >= segmentation::kShortestStick) {
        c.break_away_time = found[k].time;
        c.break_away_time_std_error = found[k].std_error;
        continue;
      }
      c.stick = {};  // the velocity only turns near zero
      c.stick_complete = false;
      if (with_stick_[k] > 0) end_in_stick(cycles_[with_stick_[k] - 1], false);
    }
  }

  const Motion& motion_;
  const std::vector<RawSlip>& slips_;
  const Thresholds& thresholds_;
  int threads_;
  std::vector<Cycle> cycles_;
  std::vector<Onset> onsets_;
  std::vector<std::size_t> with_stick_;  ///< the cycles of these onsets
};

/// Whether anything sticks: what is slow beside the fastest slip need not be at rest.
bool any_stick(const Motion& motion, const std::vector<Cycle>& cycles, const Thresholds& t) {
  if (motion.stick.never || motion.velocity_kind == VelocityKind::fixed_block || cycles.empty()) return false;
  std::vector<SampleRange> sticks;
  for (const Cycle& c : cycles) {
    if (c.stick.size() > 0) sticks.push_back(c.stick);
  }
  if (cycles.back().slip_complete && cycles.back().slip.end + 2 < motion.size())
    sticks.push_back({cycles.back().slip.end, motion.size()});
  if (motion.sticks || motion.stick.below > 0 || motion.stick.always) return !sticks.empty();
  return std::any_of(sticks.begin(), sticks.end(),
                     [&](const SampleRange& stick) { return segmentation::rests(motion, stick, t); });
}

/// A block that rests before or after it slides does not stick and slip: what there is to see is the sliding.
bool mostly_slides(const Motion& motion, const std::vector<Cycle>& cycles, const Thresholds& t) {
  const auto break_aways =
      std::count_if(cycles.begin(), cycles.end(), [](const Cycle& c) { return c.stick.size() > 0; });
  if (static_cast<std::size_t>(break_aways) >= segmentation::kFewestCycles) return false;
  std::size_t sliding = 0, driven = 0;
  for (const RawSlip& slide : segmentation::without_rests(motion, segmentation::find_slides(motion), t.peak)) {
    sliding += slide.samples.size();
    driven += segmentation::keeps_speed(motion, slide.samples) ? slide.samples.size() : 0;
  }
  return 2 * sliding > motion.size() ||
         static_cast<double>(driven) > segmentation::kDrivenPart * static_cast<double>(sliding);
}

/// No phase runs across a gap: nobody knows what happened there. A stick begins anew behind it, a slip ends before it,
/// and a break-away that was found with samples from both sides is none.
void cut_at_gaps(const Motion& motion, std::vector<Cycle>& cycles) {
  for (const std::size_t gap : segmentation::gaps_of(motion)) {
    for (Cycle& c : cycles) {
      const bool in_stick = c.stick.begin < gap && gap <= c.slip.begin,
                 in_slip = c.slip.begin < gap && gap < c.slip.end;
      if (in_stick) c.stick.begin = std::min(gap, c.stick.end);
      if (in_stick || in_slip) c.stick_complete = false;
      if (in_slip || (in_stick && c.stick.size() < segmentation::kShortestStick)) {
        c.stick = {};
        c.break_away_time = c.break_away_time_std_error = unknown;
      }
      if (!in_slip) continue;
      c.slip.end = gap;
      c.slip_complete = false;
      c.restick_time = unknown;
    }
  }
}

/// Whether the end of a stick, where friction is largest, was clipped.
bool ends_spoilt(const Motion& motion, const SampleRange& stick) {
  return motion.has_fault(stick.end - 1, SampleFault::friction);
}

/// What the samples of a cycle say of it; the times of its neighbours are known.
void measure_cycle(const Motion& motion, const std::vector<std::size_t>& gaps, std::size_t k,
                   std::vector<Cycle>& cycles) {
  const auto torn = [&](std::size_t begin, std::size_t end) {
    return std::any_of(gaps.begin(), gaps.end(), [&](std::size_t gap) { return begin < gap && gap <= end; });
  };
  const std::span<const double> friction(motion.friction), velocity(motion.relative_velocity);
  Cycle& c = cycles[k];
  const bool has_stick = c.stick.size() > 0 && c.break_away_time == c.break_away_time;
  if (has_stick) {
    const auto [low, high] = extremes(friction.subspan(c.stick.begin, c.stick.size()));
    c.stick_maximum = ends_spoilt(motion, c.stick) ? unknown : c.direction > 0 ? high : -low;
    const auto stick = velocity.subspan(c.stick.begin, c.stick.size());
    c.plateau_velocity = mean_of(stick);
    const auto at_break = segmentation::friction_at(motion, c.stick, c.break_away_time, c.direction);
    c.break_away_friction = at_break.level.value;
    c.break_away_friction_std_error =
        std::hypot(at_break.level.std_error, at_break.slope * c.break_away_time_std_error);
    c.stick_slope = at_break.slope;
    // A drive that rests and turns round unloads the contact first: the slip does not begin at a break-away.
    if (c.break_away_friction < 0) c.break_away_friction = c.break_away_friction_std_error = c.stick_slope = unknown;
    if (c.stick_complete && !torn(cycles[k - 1].slip.begin, c.stick.end)) {
      c.stick_time = c.break_away_time - cycles[k - 1].restick_time;
    }
  }
  const auto [weakest, strongest] = extremes(friction.subspan(c.slip.begin, c.slip.size()));
  const auto [slowest, fastest] = extremes(velocity.subspan(c.slip.begin, c.slip.size()));
  c.slip_minimum = c.direction > 0 ? weakest : -strongest;
  c.peak_velocity = c.direction > 0 ? fastest : -slowest;
  c.branch_difference = segmentation::branch_difference(velocity.subspan(c.slip.begin, c.slip.size()),
                                                        friction.subspan(c.slip.begin, c.slip.size()), c.direction);
  if (c.slip_complete) c.slip_time = c.restick_time - c.break_away_time;
  const bool follows = k + 1 < cycles.size() && !torn(c.slip.begin, cycles[k + 1].slip.begin);
  if (follows && cycles[k + 1].direction == c.direction) {
    c.period = cycles[k + 1].break_away_time - c.break_away_time;
  }
}

void measure(const Motion& motion, int threads, std::vector<Cycle>& cycles) {
  const std::vector<std::size_t> gaps = segmentation::gaps_of(motion);
  run_tasks(cycles.size(), threads, [&](std::size_t k) { measure_cycle(motion, gaps, k, cycles); });
}

std::vector<RawSlip> split_at_steps(const Motion& motion, const std::vector<RawSlip>& slips) {
  std::vector<RawSlip> parts;
  for (const RawSlip& slip : slips) {
    RawSlip part = slip;
    const auto add_up_to = [&](std::size_t end) {
      part.samples.end = end;
      if (part.samples.size() > 0) parts.push_back(part);
      part.samples.begin = end;
    };
    for (const Step& step : motion.steps) {
      if (step.end <= part.samples.begin || step.begin >= slip.samples.end) continue;
      add_up_to(std::min(step.end, slip.samples.end));
    }
    add_up_to(slip.samples.end);
  }
  return parts;
}

/// A record that never sticks is one slip per direction and step.
void slide_throughout(const Motion& motion, double peak, Segmentation& result) {
  const Thresholds t = segmentation::thresholds_without_stick(motion);
  result.slip_threshold = motion.stick.never ? 0 : t.slip;
  result.stick_threshold = motion.stick.never ? 0 : t.stick;
  result.cycles.clear();
  std::vector<RawSlip> slides = segmentation::find_slides(motion);
  if (!motion.stick.never) slides = segmentation::without_rests(motion, slides, peak);
  for (const RawSlip& part : split_at_steps(motion, slides)) result.cycles.push_back(blank_cycle(part));
  if (result.cycles.empty()) result.kind = MotionKind::always_sticking;
}

double rms_block_velocity(const Motion& motion) {
  double squares = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    squares += std::pow(motion.disc_velocity_at(i) - motion.relative_velocity[i], 2);
  return motion.size() > 0 ? std::sqrt(squares / static_cast<double>(motion.size())) : 0;
}

void summarise(int threads, Segmentation& result) {
  std::vector<double> peaks, sticks, slips, periods, branches;
  for (const Cycle& c : result.cycles) {
    // A slip that the record or a reversal begins may have had its peak before.
    if (c.slip_complete && c.stick.size() > 0) peaks.push_back(c.peak_velocity);
    sticks.push_back(c.stick_time);
    slips.push_back(c.slip_time);
    periods.push_back(c.period);
    branches.push_back(c.branch_difference);
  }
  if (peaks.empty()) {
    for (const Cycle& c : result.cycles) peaks.push_back(c.peak_velocity);
  }
  result.frequency = segmentation::frequency_of(periods);
  std::vector<double>* const values[] = {&peaks, &sticks, &branches, &slips};
  Estimate* const means[] = {&result.amplitude, &result.stick_time, &result.branch_difference, &result.slip_time};
  run_tasks(std::size(values), threads, [&](std::size_t k) { *means[k] = mean_with_error(std::move(*values[k])); });
}

void add_notes(Segmentation& result) {
  const auto& cycles = result.cycles;
  if (result.kind == MotionKind::always_sticking) result.notes.push_back("the record never slips");
  if (result.kind == MotionKind::always_slipping) result.notes.push_back("the record never sticks");
  if (result.kind != MotionKind::stick_slip) return;
  if (cycles.front().stick.size() == 0)
    result.notes.push_back("the record begins in slip: the first break-away is not in it");
  if (!cycles.back().slip_complete) result.notes.push_back("the last slip is cut off by the end of the record");
  std::vector<double> lengths;
  for (const Cycle& c : cycles) lengths.push_back(static_cast<double>(c.slip.size()));
  const double usual = median(std::move(lengths));
  if (usual < static_cast<double>(segmentation::kShortestSlip)) {
    result.notes.push_back(
        fmt::format("only {} sample{} a slip: too few for a curve", general(usual, 3), usual == 1 ? "" : "s"));
  }
  std::size_t complete = 0;
  for (const Cycle& c : cycles) complete += c.stick_complete && c.slip_complete ? 1u : 0u;
  if (complete < segmentation::kFewestCycles)
    result.notes.push_back(fmt::format("only {} complete cycle{}", complete, complete == 1 ? "" : "s"));
}

/// Points, which are sorted by v_r: one slip for each direction. At rest friction shows it.
Segmentation slips_of_points(const Motion& motion) {
  Segmentation result;
  result.kind = MotionKind::always_slipping;
  std::size_t forward = 0;
  const auto& v = motion.relative_velocity;
  while (forward < motion.size() && (v[forward] < 0 || (v[forward] == 0 && motion.friction[forward] < 0))) ++forward;
  const RawSlip back{{0, forward}, -1, 0, false, false}, forth{{forward, motion.size()}, 1, 0, false, false};
  for (const RawSlip& slip : {back, forth}) {
    if (slip.samples.size() > 0) result.cycles.push_back(blank_cycle(slip));
  }
  measure(motion, 1, result.cycles);
  summarise(1, result);
  return result;
}

}  // namespace

std::string_view to_string(MotionKind kind) {
  if (kind == MotionKind::stick_slip) return "stick-slip";
  return kind == MotionKind::always_slipping ? "always-slipping" : "always-sticking";
}

RecordKind kind_of_record(const Motion& motion, const Segmentation& segmentation) {
  const bool shows_in_motion =
      !motion.kind || motion.kind == RecordKind::stick_slip || motion.kind == RecordKind::sliding;
  if (!shows_in_motion) return *motion.kind;
  return segmentation.kind == MotionKind::always_slipping ? RecordKind::sliding : RecordKind::stick_slip;
}

Segmentation find_cycles(const Motion& motion, int threads) {
  if (motion.is_points()) return slips_of_points(motion);
  Segmentation result;
  if (motion.kind == RecordKind::force_only || is_driven_in_steps(motion.kind)) {
    result.kind = MotionKind::always_sticking;
    return result;
  }
  const Thresholds t = segmentation::thresholds_of(motion, threads);
  result.slip_threshold = t.slip;
  result.stick_threshold = t.stick;
  result.rms_velocity = rms_block_velocity(motion);
  const std::vector<RawSlip> slips = segmentation::find_slips(motion, t);
  result.cycles = PhaseFinder(motion, slips, t, threads).find();
  cut_at_gaps(motion, result.cycles);
  const bool sticks = any_stick(motion, result.cycles, t);
  result.kind = sticks ? MotionKind::stick_slip : MotionKind::always_slipping;
  if (slips.empty() && !motion.stick.never) result.kind = MotionKind::always_sticking;
  const bool rests_only =
      sticks && motion.stick.below == 0 && !motion.stick.always && mostly_slides(motion, result.cycles, t);
  if (rests_only) result.kind = MotionKind::always_slipping;
  if (result.kind == MotionKind::always_slipping) slide_throughout(motion, t.peak, result);
  if (result.kind == MotionKind::stick_slip && begins_in_doubt(slips))
    result.notes.push_back("the record begins with the end of a slip, or ringing after it, which is left out");
  measure(motion, threads, result.cycles);
  result.left_out = segmentation::spoilt_stretches(motion);
  summarise(threads, result);
  add_notes(result);
  if (rests_only) result.notes.back() = "the record rests and slides, with too few break-aways for stick-slip";
  return result;
}

}  // namespace tribofit
