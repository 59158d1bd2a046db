#include "plateau_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

Plateaus evenly_spaced_windows(std::size_t samples) {
  Plateaus windows;
  const std::size_t count = kNoiseWindows, length = std::clamp(samples / 4, kShortestWindow, kLongestWindowOfNoise);
  if (samples < length) return windows;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * (samples - length) / count;
    windows.runs.push_back({begin, begin + length, 0});
  }
  return windows;
}

// Noise of a record before it is known where it rests. Where sticks last a dozen samples most windows hold some of a
// slip; the quiet ones are then far below the median, which no noise does, and they count.
double roughness_of(std::span<const double> velocity) {
  std::vector<double> spreads = spreads_about_parabolas(velocity, evenly_spaced_windows(velocity.size()).runs, 1);
  if (spreads.empty()) return 0;
  const double middle = median(spreads), quiet = quantile(std::move(spreads), kQuietWindows);
  return quiet < kQuietNoise * middle ? quiet : middle;
}

/// Friction from the beginning of a plateau to its end, in the direction of v_r there or of friction itself [1 or N].
double rise_over(const Trace& trace, const StickPlateau& run, std::size_t length) {
  const auto mean_at = [&](std::size_t block) {
    const std::span<const double> friction(trace.friction);
    const std::size_t begin = std::min(block * length, friction.size() - 1);
    return mean_of(friction.subspan(begin, std::min(length, friction.size() - begin)));
  };
  const double first = mean_at(run.begin), last = mean_at(run.end - 1);
  return last < 0 ? first - last : last - first;
}

/// Whether the plateaus of v_r are rest, not slow sliding: see search_plateaus().
bool rests(const Trace& trace, const PlateauSearch& s) {
  const double noise = std::max(kRestNoise * s.noise, kRestDepth * s.plateaus.depth);
  if (s.disc.mean.empty()) {
    if (std::abs(s.plateaus.level) <= noise) return true;
  } else {
    // The disc turns at a speed of its own.
    std::size_t moving = 0, all = 0;
    for (const StickPlateau& run : s.plateaus.runs) {
      for (std::size_t b = run.begin; b < run.end; ++b, ++all) {
        const double disc = s.disc.mean[b], block = s.blocks.mean[b];
        moving += std::abs(disc - block) <= std::max(noise, kMovesWithDisc * std::abs(disc)) ? 1u : 0u;
      }
    }
    if (2 * moving > all) return true;
  }
  if (s.plateaus.runs.size() < kFewestForMedian) return false;
  std::vector<double> rises;
  for (const StickPlateau& run : s.plateaus.runs) rises.push_back(rise_over(trace, run, s.blocks.length));
  std::vector<double> friction = thinned(trace.friction, std::size_t{1} << 15);
  for (double& mu : friction) mu = std::abs(mu);
  const double range = quantile(friction, 0.95) - quantile(friction, 0.05);
  return median(std::move(rises)) > kLeastLoading * range;
}

}  // namespace

const Condition& first_known(const Condition& a, const Condition& b) {
  return a.known() ? a : b;
}

double largest_of(std::span<const double> values) {
  if (values.empty()) return 0;
  const Extremes e = extremes(values);
  return std::max(std::abs(e.low), std::abs(e.high));
}

Disc disc_of(const Trace& trace) {
  Disc disc;
  if (trace.kind ==
      RecordKind::spring_slider) {  // seen from the driven end, what it slides on runs at the drive's speed
    disc.known = trace.spring.velocity.known();
    if (disc.known) disc.constant = disc.largest = trace.spring.velocity.value;
    return disc;
  }
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

namespace {

std::size_t blocks_in(const Plateaus& plateaus) {
  std::size_t blocks = 0;
  for (const StickPlateau& run : plateaus.runs) blocks += run.end - run.begin;
  return blocks;
}

/// Where the stated speed is far off, turning points of the block may lie beside omega r, and its rest elsewhere.
void prefer_where_it_rests(const std::vector<double>& velocity, Plateaus& plateaus) {
  const double enough = kPlateausOfBlock * static_cast<double>(velocity.size());
  if (plateaus.empty() || static_cast<double>(blocks_in(plateaus)) > enough) return;
  Plateaus anywhere = find_plateaus(velocity);
  if (static_cast<double>(blocks_in(anywhere)) > kLongerRest * enough) plateaus = std::move(anywhere);
}

}  // namespace

PlateauSearch search_plateaus(const Trace& trace, const Disc& disc, double step, const StickRule& stick) {
  PlateauSearch s;
  const std::span<const double> velocity(trace.velocity);
  const std::size_t length = block_length(velocity);
  s.blocks = block_means(velocity, length, step);
  std::vector<double> relative = s.blocks.mean;
  if (!disc.varying.empty()) {
    s.disc = block_means(disc.varying, length, step);
    for (std::size_t b = 0; b < relative.size(); ++b) relative[b] -= s.disc.mean[b];
  }
  const double roughness = roughness_of(velocity);
  const bool block = trace.velocity_kind == VelocityKind::block;
  // A block that is held cannot stick to the disc.
  if (trace.velocity_kind == VelocityKind::fixed_block || stick.never) {
    s.noise = roughness;
    return s;
  }
  const double stated = block && disc.known && disc.varying.empty() ? disc.constant : 0;
  const double centre = relative.empty() ? 0 : relative[relative.size() / 2];
  double spread = 0;
  for (double v : relative) spread = std::max(spread, std::abs(v - centre));
  if (spread <= kSlipsOverError * roughness) {  // nothing moves: one plateau, or steady sliding
    const double level = fit_line(relative).value;
    const bool rests_on_disc = !block || !disc.varying.empty() ? std::abs(level) <= kRestNoise * roughness
                               : disc.known
                                   ? std::abs(std::abs(level) - std::abs(stated)) < kMovesWithDisc * std::abs(stated)
                                   : std::abs(level) > kCarried * roughness;
    s.noise = roughness;
    s.sticks = rests_on_disc;
    if (rests_on_disc) s.plateaus = {{{0, relative.size(), level}}, level, spread};
    return s;
  }
  if (!block) {
    const double limit = kSlipsOverFastest * largest_of(relative);  // a plateau of v_r is at zero
    s.plateaus = find_plateaus(relative, LevelRange{-limit, limit}, true);
  } else if (!disc.varying.empty()) {
    s.plateaus = find_plateaus(relative, LevelRange{-kMovesWithDisc * disc.largest, kMovesWithDisc * disc.largest});
  } else if (disc.known) {
    // First where it ought to be, then pointing the other way, then anywhere but at rest.
    const double near = (1 - kMovesWithDisc) * std::abs(stated), far = (1 + kMovesWithDisc) * std::abs(stated);
    const LevelRange right = stated > 0 ? LevelRange{near, far} : LevelRange{-far, -near};
    s.plateaus = find_plateaus(relative, right);
    if (s.plateaus.empty()) s.plateaus = find_plateaus(relative, LevelRange{-right.high, -right.low});
    prefer_where_it_rests(relative, s.plateaus);
  }
  if (block && s.plateaus.empty() && disc.varying.empty()) s.plateaus = find_plateaus(relative);
  s.noise = s.plateaus.empty() ? roughness : spread_about_parabolas(velocity, s.plateaus.runs, s.blocks.length);
  if (s.noise == 0) s.noise = s.plateaus.empty() ? 0 : std::min(roughness, kRestDepth * s.plateaus.depth);
  s.sticks =
      !s.plateaus.empty() && (!block || !disc.varying.empty() || std::abs(s.plateaus.level) > kRestNoise * s.noise);
  if (s.sticks && (!block || !disc.varying.empty())) s.sticks = rests(trace, s);
  if (!s.sticks) {
    s.plateaus.runs.clear();
    s.plateaus.level = 0;
  }
  return s;
}

bool points_the_other_way(const Trace& trace, const Disc& disc, const PlateauSearch& search) {
  if (!search.sticks || trace.velocity_kind != VelocityKind::block || !disc.varying.empty()) return false;
  if (disc.known) return search.plateaus.level * disc.constant < 0;
  double sum = 0;
  for (const StickPlateau& run : search.plateaus.runs) {
    const auto part = std::span<const double>(trace.friction).subspan(run.inner_begin() * search.blocks.length);
    sum += part[0] + part[(run.inner_end() - run.inner_begin()) * search.blocks.length - 1];
  }
  return search.plateaus.level < 0 && sum > 0;
}

std::optional<RecordedPlateau> recorded_plateau(const PlateauSearch& search, const Disc& disc, VelocityKind kind) {
  if (kind != VelocityKind::block || disc.varying.empty() || search.disc.mean.empty()) return std::nullopt;
  // Of a disc that turns forth and back both are taken the way that it turns: its mean is nothing to compare with.
  const auto both_in = [&](const Plateaus& plateaus) {
    double turned = 0, size = 0, along = 0;
    std::size_t blocks = 0;
    for (const StickPlateau& run : plateaus.runs) {
      for (std::size_t b = run.begin; b < run.end; ++b) {
        const double speed = search.disc.mean[b], block = search.blocks.mean[b];
        turned += speed, size += std::abs(speed), along += speed < 0 ? -block : block, ++blocks;
      }
    }
    const auto n = static_cast<double>(std::max<std::size_t>(1, blocks));
    if (std::abs(turned) > kTurnsOneWay * size) return RecordedPlateau{turned / n + plateaus.level, turned / n};
    return RecordedPlateau{along / n, size / n};
  };
  std::optional<RecordedPlateau> following;
  if (search.sticks) {
    following = both_in(search.plateaus);
    if (std::abs(following->block - following->disc) <= kFarFromDisc * std::abs(following->disc)) return following;
  }
  const std::span<const double> v(search.blocks.mean);
  const Extremes range = extremes(v);
  Plateaus alone = range.high - range.low <= kSlipsOverError * search.noise
                       ? Plateaus{{{0, v.size(), fit_line(v).value}}, 0, 0}
                       : find_plateaus(v);
  if (alone.level == 0 && !alone.empty()) alone.level = alone.runs.front().level;
  std::size_t resting = 0;
  for (const StickPlateau& run : alone.runs) resting += run.size();
  const bool has_plateau = static_cast<double>(resting) > kPlateausOfBlock * static_cast<double>(v.size()) &&
                           std::abs(alone.level) > kRestNoise * search.noise;
  return has_plateau ? RecordedPlateau{alone.level, both_in(alone).disc} : following;
}

double final_level(const Plateaus& plateaus) {
  std::vector<double> levels;
  for (std::size_t r = plateaus.runs.size() / 2; r < plateaus.runs.size(); ++r)
    levels.push_back(plateaus.runs[r].level);
  return median(std::move(levels));
}

Plateaus plateaus_within(const PlateauSearch& search, std::size_t trimmed, std::size_t size) {
  Plateaus plateaus = search.plateaus;
  const std::size_t length = search.blocks.length;
  const std::size_t cut = (trimmed + length - 1) / length, kept = size / length;
  std::erase_if(plateaus.runs, [&](const StickPlateau& run) { return run.begin < cut || run.end - cut > kept; });
  for (StickPlateau& run : plateaus.runs) run.begin -= cut, run.end -= cut;
  return plateaus;
}

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

void flatten(PlateauSearch& search, std::span<const double> factor) {
  const BlockMeans means = block_means(factor, search.blocks.length, search.blocks.step);
  for (std::size_t b = 0; b < means.mean.size(); ++b) search.blocks.mean[b] /= means.mean[b];
  const double near = 0.5 * search.plateaus.level, far = 1.5 * search.plateaus.level;
  Plateaus plateaus = find_plateaus(search.blocks.mean, LevelRange{std::min(near, far), std::max(near, far)});
  if (!plateaus.empty()) search.plateaus = std::move(plateaus);
}

void impose(std::vector<double> factor, double omega, Trace& trace, Disc& disc) {
  if (std::abs(omega) > 0) {
    trace.disc_speed = factor;
    for (double& v : trace.disc_speed) v *= omega;
    trace.disc_angle.assign(trace.size(), 0);
    for (std::size_t i = 1; i < trace.size(); ++i) {
      const double mean = 0.5 * (trace.disc_speed[i] + trace.disc_speed[i - 1]);
      trace.disc_angle[i] = trace.disc_angle[i - 1] + mean * (trace.time[i] - trace.time[i - 1]);
    }
  }
  disc.varying = std::move(factor);
  for (double& v : disc.varying) v *= disc.constant;
  disc.largest = largest_of(disc.varying);
}

std::size_t run_up_blocks(const PlateauSearch& s) {
  if (s.plateaus.runs.size() < kFewestForMedian) return 0;
  const double level = final_level(s.plateaus);
  const std::span<const double> v(s.blocks.mean);
  struct Piece {
    std::size_t begin;
    double level;
  };
  std::vector<Piece> pieces;
  for (const StickPlateau& run : s.plateaus.runs) {
    // The first plateau may be the run-up itself: it is looked at from end to end, and more finely.
    const bool first = run.begin == 0;
    const std::size_t begin = first ? 0 : run.inner_begin(),
                      end = first ? run.end - run.size() / kEndOfFirst : run.inner_end();
    const std::size_t length = std::max<std::size_t>(1, (end - begin) / (first ? kPiecesOfFirst : kPiecesOfPlateau));
    for (std::size_t b = begin; b + length <= end; b += length) {
      pieces.push_back({b, fit_line(v.subspan(b, length)).value});
    }
  }
  const double tolerance = std::max(kSettled * std::abs(level), kPieceNoise * s.noise);
  const auto settled = [&](const Piece& p) { return std::abs(p.level - level) <= tolerance; };
  // A disc that starts from rest begins well below its final speed; a disc that ripples does not settle.
  const std::size_t head = s.plateaus.runs.front().begin;
  std::vector<double> gaps;
  for (std::size_t r = 1; r < s.plateaus.runs.size(); ++r) {
    gaps.push_back(static_cast<double>(s.plateaus.runs[r].begin - s.plateaus.runs[r - 1].end));
  }
  const bool slow_head =
      static_cast<double>(head) > kLongHead * median(std::move(gaps)) && std::abs(v[0]) < kSlowHead * std::abs(level);
  std::size_t k = 0;
  if (std::abs(pieces.front().level) < kBelowFinal * std::abs(level)) {
    while (k < pieces.size() && !settled(pieces[k])) ++k;
    const auto later =
        static_cast<double>(std::count_if(pieces.begin() + static_cast<std::ptrdiff_t>(k), pieces.end(), settled));
    if (later < kStaysSettled * static_cast<double>(pieces.size() - k)) return slow_head ? head : 0;
    // Ringing after a re-stick at the very beginning is no run-up either.
    std::vector<double> durations;
    for (const StickPlateau& run : s.plateaus.runs) durations.push_back(static_cast<double>(run.size()));
    const double least = kShortestRunUp * median(std::move(durations));
    return k < pieces.size() && static_cast<double>(pieces[k].begin) > least ? pieces[k].begin : 0;
  }
  return slow_head ? head : 0;
}

}  // namespace tribofit::kinematics
