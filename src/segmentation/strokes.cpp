#include "tribofit/segmentation/strokes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "tribofit/segmentation/stroke_memory.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Cycles [first, last] that slide the same way.
struct Part {
  int direction = 1;
  std::size_t first = 0, last = 0;
};

/// x: position [m].
bool is_noise(const Motion& motion, const Segmentation& segmentation, const std::vector<double>& x, const Part& part) {
  const std::size_t begin = segmentation.cycles[part.first].slip.begin;
  const std::size_t end = segmentation.cycles[part.last].slip.end - 1;
  const double steps = static_cast<double>(end - begin + 1);
  const double noise = segmentation::kTurnOverNoise * motion.velocity_noise * motion.step * std::sqrt(steps);
  return part.direction * (x[end] - x[begin]) <= noise;
}

std::vector<Part> parts_of(const Motion& motion, const Segmentation& segmentation, const std::vector<double>& x) {
  std::vector<Part> parts;
  const auto add = [&parts](const Part& part) {
    if (!parts.empty() && parts.back().direction == part.direction) {
      parts.back().last = part.last;
    } else {
      parts.push_back(part);
    }
  };
  for (std::size_t k = 0; k < segmentation.cycles.size(); ++k) add({segmentation.cycles[k].direction, k, k});
  std::vector<Part> all = std::exchange(parts, {});
  std::erase_if(all, [&](const Part& part) { return is_noise(motion, segmentation, x, part); });
  for (const Part& part : all) add(part);
  return parts;
}

/// Integral of v_r without stick.
std::vector<double> position_of(const Motion& motion) {
  std::vector<double> x = sliding_distance(motion);
  double before = 0, position = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double slid = x[i] - std::exchange(before, x[i]);
    position += motion.relative_velocity[i] < 0 ? -slid : slid;
    x[i] = position;
  }
  return x;
}

}  // namespace

std::size_t reversals_of(const Segmentation& segmentation) {
  std::size_t turns = 0;
  for (std::size_t k = 1; k < segmentation.cycles.size(); ++k)
    turns += segmentation.cycles[k].direction != segmentation.cycles[k - 1].direction ? 1U : 0U;
  return turns;
}

std::string too_few_reversals(std::size_t reversals) {
  if (reversals == 0) return "the block slides in one direction only";
  const std::string often = reversals == 1 ? "once" : std::to_string(reversals) + " times";
  return "sliding reverses " + often + " only; " + std::to_string(kFewestReversals) + " reversals are needed";
}

Strokes strokes_of(const Motion& motion, const Segmentation& segmentation) {
  if (motion.is_points() || reversals_of(segmentation) < kFewestReversals) return {};
  const std::vector<double> x = position_of(motion);
  const std::vector<Part> parts = parts_of(motion, segmentation, x);
  if (parts.size() <= kFewestReversals) return {};
  const auto begin_of = [&](std::size_t k) {
    if (k == 0) return std::size_t(0);
    return k < parts.size() ? segmentation.cycles[parts[k].first].slip.begin : x.size();
  };
  // Where each part begins: the farthest that the part before it went.
  std::vector<double> turns = {x[0]}, lengths;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    double turn = x[begin_of(k - 1)];
    for (std::size_t i = begin_of(k - 1); i < begin_of(k + 1); ++i) {
      if (parts[k].direction * (x[i] - turn) < 0) turn = x[i];
    }
    if (k > 1) lengths.push_back(std::abs(turn - turns.back()));
    turns.push_back(turn);
  }
  Strokes out;
  out.length = median(lengths);
  // What of the first stroke came before the record.
  turns[0] -= parts[0].direction * std::max(0.0, out.length - std::abs(turns[1] - turns[0]));
  out.distance.resize(x.size());
  out.earlier.resize(segmentation.cycles.size());
  StrokeMemory memory;
  memory.end_stroke(out.length);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    for (std::size_t i = begin_of(k); i < begin_of(k + 1); ++i)
      out.distance[i] = std::max(0.0, part.direction * (x[i] - turns[k]));
    const std::size_t next = k + 1 < parts.size() ? parts[k + 1].first : segmentation.cycles.size();
    for (std::size_t c = k == 0 ? 0 : part.first; c < next; ++c)
      out.earlier[c].assign(memory.lengths().begin(), memory.lengths().end());
    if (k + 1 < parts.size()) memory.end_stroke(std::abs(turns[k + 1] - turns[k]));
  }
  return out;
}

}  // namespace tribofit
