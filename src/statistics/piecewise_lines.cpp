#include "piecewise_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// A line through points that are added one by one, and the squares it leaves.
class GrowingLine {
 public:
  void add(double t, double x) {
    ++n_;
    const double dt = t - mean_t_, dx = x - mean_x_;
    mean_t_ += dt / n_;
    mean_x_ += dx / n_;
    tt_ += dt * (t - mean_t_);
    tx_ += dt * (x - mean_x_);
    xx_ += dx * (x - mean_x_);
  }
  double slope() const { return tt_ > 0 ? tx_ / tt_ : 0; }
  double squares() const { return tt_ > 0 ? std::max(0.0, xx_ - tx_ * tx_ / tt_) : xx_; }
  double at(double t) const { return mean_x_ + slope() * (t - mean_t_); }

 private:
  double n_ = 0, mean_t_ = 0, mean_x_ = 0, tt_ = 0, tx_ = 0, xx_ = 0;
};

/// Noise and rounding of samples, by their deviations from the line through their neighbours.
double noise_about_neighbours(std::span<const double> t, std::span<const double> x) {
  std::vector<double> off;
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double part = (t[i] - t[i - 1]) / (t[i + 1] - t[i - 1]);
    off.push_back(std::abs(x[i] - (1 - part) * x[i - 1] - part * x[i + 1]) /
                  std::sqrt(1 + part * part + (1 - part) * (1 - part)));
  }
  if (off.empty()) return 0;
  // Readings of few digits deviate in few samples only, and by as much as a digit.
  double squares = 0;
  for (double& d : off) squares += d * d;
  const double robust = kSigmaPerMad * median(off), plain = std::sqrt(squares / static_cast<double>(off.size()));
  return robust > 0 ? robust : plain;
}

/// Readings in a row that are the same.
struct Run {
  std::size_t begin = 0, end = 0;
  bool lasts() const { return end - begin > 1; }
};

std::vector<Run> runs_of(std::span<const double> x) {
  std::vector<Run> runs;
  for (std::size_t begin = 0, end = 0; begin < x.size(); begin = end) {
    end = begin + 1;
    while (end < x.size() && x[end] == x[begin]) ++end;
    runs.push_back({begin, end});
  }
  return runs;
}

/// Least step of readings that stay before and behind it, as slow motion shows its last digit; 0: there is none. A stop
/// of fast motion is no such step.
double digit_of(std::span<const double> x, const std::vector<Run>& runs) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t r = 1; r < runs.size(); ++r) {
    if (runs[r - 1].lasts() && runs[r].lasts())
      least = std::min(least, std::abs(x[runs[r].begin] - x[runs[r - 1].begin]));
  }
  return std::isfinite(least) ? least : 0;
}

/// Readings that stay the same while what they show moves by a digit lie on the line through the changes of the digit.
std::vector<double> between_digits(std::span<const double> t, std::span<const double> x, const std::vector<Run>& runs,
                                   double digit) {
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t r = 1; r + 1 < runs.size(); ++r) {
    const auto [begin, end] = runs[r];
    if (!runs[r].lasts() || !(runs[r - 1].lasts() || runs[r + 1].lasts())) continue;
    const double early = 0.5 * (t[begin - 1] + t[begin]), late = 0.5 * (t[end - 1] + t[end]);
    const double low = -std::copysign(0.5 * digit, x[begin] - x[begin - 1]),
                 high = std::copysign(0.5 * digit, x[end] - x[end - 1]);
    for (std::size_t i = begin; i < end; ++i) out[i] += low + (high - low) * (t[i] - early) / (late - early);
  }
  return out;
}

/// A last piece that may begin at a sample, and what all before it costs.
struct LastPiece {
  std::size_t begin = 0, doubted_at = 0;
  double before = 0;
  bool is_doubted = false;  ///< no later end can make it the best one, but for those too close for a further piece
  GrowingLine line;
};

/// Indices at which pieces begin, the first among them: those of the least sum of squares and of a price per corner,
/// by optimal partitioning with pruning (PELT; Killick, Fearnhead and Eckley 2012).
std::vector<std::size_t> corners_of(std::span<const double> t, std::span<const double> x, double price) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t n = t.size();
  std::vector<double> least(n + 1, kNever);
  std::vector<std::size_t> begin_of_last(n + 1, 0);
  least[0] = -price;  // the first piece has no corner
  std::vector<LastPiece> pieces;
  for (std::size_t end = 1; end <= n; ++end) {
    if (least[end - 1] < kNever) pieces.push_back({end - 1, 0, least[end - 1], false, {}});
    for (LastPiece& piece : pieces) {
      piece.line.add(t[end - 1], x[end - 1]);
      const double cost = piece.before + piece.line.squares() + price;
      if (end - piece.begin < kFewestOfPiece || cost >= least[end]) continue;
      least[end] = cost;
      begin_of_last[end] = piece.begin;
    }
    for (LastPiece& piece : pieces) {
      if (piece.is_doubted || piece.before + piece.line.squares() <= least[end]) continue;
      piece.is_doubted = true;
      piece.doubted_at = end;
    }
    std::erase_if(pieces, [&](const LastPiece& p) { return p.is_doubted && end >= p.doubted_at + kFewestOfPiece; });
  }
  std::vector<std::size_t> corners;
  for (std::size_t end = n; end > 0; end = begin_of_last[end]) corners.push_back(begin_of_last[end]);
  std::reverse(corners.begin(), corners.end());
  return corners;
}

struct Stretch {
  std::size_t begin = 0, end = 0;
  GrowingLine line;      ///< through its inner samples
  bool on_ramp = false;  ///< see LinePiece
};

Stretch stretch_of(std::span<const double> t, std::span<const double> x, std::size_t begin, std::size_t end) {
  Stretch out{begin, end, {}};
  const std::size_t margin = std::min((end - begin) / 5, kMarginOfPiece);
  for (std::size_t i = begin + margin; i < end - margin; ++i) out.line.add(t[i], x[i]);
  return out;
}

/// Corners among all values near those found among every `stride`-th: pieces shorter than some strides show only there.
std::vector<std::size_t> corners_near(std::span<const double> t, std::span<const double> x, double price,
                                      std::size_t stride, const std::vector<std::size_t>& coarse) {
  if (stride == 1) return coarse;
  const std::size_t reach = kReachOfCorner * stride;
  std::vector<std::size_t> out = {0};
  for (std::size_t first = 1, last = 1; first < coarse.size(); first = last + 1) {
    for (last = first; last + 1 < coarse.size() && (coarse[last + 1] - coarse[last]) * stride <= 2 * reach;) ++last;
    const std::size_t begin = std::max(coarse[first] * stride, reach) - reach,
                      end = std::min(x.size(), coarse[last] * stride + reach);
    const std::vector<std::size_t> fine =
        corners_of(t.subspan(begin, end - begin), x.subspan(begin, end - begin), price);
    for (std::size_t i = 1; i < fine.size(); ++i) out.push_back(begin + fine[i]);
    for (std::size_t i = first; i <= last && fine.size() == 1; ++i) out.push_back(coarse[i] * stride);
  }
  return out;
}

/// How plain a corner is, over the least that counts: by its change of slope, over `least_change` of the larger one,
/// and by its distance from one line.
double plainness(std::span<const double> t, const Stretch& one, const Stretch& two, double noise, double least_change) {
  const double change = std::abs(one.line.slope() - two.line.slope());
  const double larger = std::max(std::abs(one.line.slope()), std::abs(two.line.slope()));
  const double first = t[two.begin] - t[one.begin], second = t[two.end - 1] - t[two.begin];
  if (!(change > 0)) return 0;
  const double by_distance = change * first * second / (first + second) / (kCornerOfNoise * noise);
  return least_change > 0 ? std::min(change / (least_change * larger), by_distance) : by_distance;
}

/// Neighbours of one speed are one stretch: the least plain corner goes first.
void merge_alike(std::span<const double> t, std::span<const double> x, double noise, double least_change,
                 std::vector<Stretch>& stretches) {
  while (stretches.size() > 1) {
    std::size_t faintest = 0;
    double least = 1;
    for (std::size_t i = 1; i < stretches.size(); ++i) {
      const double plain = plainness(t, stretches[i - 1], stretches[i], noise, least_change);
      if (plain < least) least = plain, faintest = i;
    }
    if (faintest == 0) return;
    stretches[faintest - 1] = stretch_of(t, x, stretches[faintest - 1].begin, stretches[faintest].end);
    stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(faintest));
  }
}

/// A stretch by the corners within it that noise has not made.
std::vector<Stretch> parts_of(std::span<const double> t, std::span<const double> x, const Stretch& whole,
                              const std::vector<Stretch>& fine) {
  std::vector<Stretch> out;
  std::size_t begin = whole.begin;
  for (const Stretch& part : fine) {
    if (part.begin < begin + kFewestOfPiece || part.begin + kFewestOfPiece > whole.end) continue;
    out.push_back(stretch_of(t, x, begin, part.begin));
    begin = part.begin;
  }
  out.push_back(stretch_of(t, x, begin, whole.end));
  return out;
}

/// Whether slopes go from the first to the last of them up or down alone.
bool is_monotonic(const std::vector<double>& slopes) {
  for (std::size_t k = 1; k < slopes.size(); ++k) {
    if (!((slopes[k] - slopes[k - 1]) * (slopes.back() - slopes.front()) > 0)) return false;
  }
  return true;
}

/// Whether a stretch over which the slope changes steadily by that much would look the same.
bool may_bend(std::span<const double> t, const Stretch& stretch, double change, double noise) {
  const auto samples = static_cast<double>(stretch.end - stretch.begin);
  // Root mean square distance of a parabola from its line.
  const double from_line = std::abs(change) * (t[stretch.end - 1] - t[stretch.begin]) / std::sqrt(720.0);
  return samples < 2 * kFewestOfPiece || std::sqrt(samples) * from_line < kCornersOfRamp * kCornerOfNoise * noise;
}

/// Where slopes change steadily, as of a drive that runs up, every corner stays that noise has not made: within
/// stretches between others of less and of more slope, and where a stretch goes over into one of these.
std::vector<Stretch> with_corners_of_ramps(std::span<const double> t, std::span<const double> x, double noise,
                                           const std::vector<Stretch>& fine, const std::vector<Stretch>& coarse) {
  const auto slope = [&](std::size_t i) { return coarse[i].line.slope(); };
  const auto is_between = [&](std::size_t i) {
    return i > 0 && i + 1 < coarse.size() && is_monotonic({slope(i - 1), slope(i), slope(i + 1)});
  };
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const std::vector<Stretch> parts = parts_of(t, x, coarse[i], fine);
    std::size_t first = 0, last = parts.size() - 1;  // of those that stay one
    if (is_between(i)) {
      std::vector<double> slopes = {slope(i - 1)};
      for (const Stretch& part : parts) slopes.push_back(part.line.slope());
      slopes.push_back(slope(i + 1));
      if (is_monotonic(slopes)) first = parts.size();
    } else {
      const auto goes_over = [&](std::size_t beside, std::size_t k) {
        return is_monotonic({slope(beside), parts[k].line.slope(), slope(i)}) &&
               may_bend(t, parts[k], 0.5 * (slope(i) - slope(beside)), noise);
      };
      while (i > 0 && is_between(i - 1) && first < last && goes_over(i - 1, first)) ++first;
      while (is_between(i + 1) && last > first && goes_over(i + 1, last)) --last;
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (k < first || k > last) out.push_back(parts[k]);
      if (k == first) out.push_back(stretch_of(t, x, parts[first].begin, parts[last].end));
    }
  }
  return out;
}

/// Stretches between others of less and of more slope are stairs of a ramp where a slope that changes steadily from one
/// to the other would look the same.
void find_ramps(std::span<const double> t, double noise, std::vector<Stretch>& stretches) {
  const auto slope = [&](std::size_t i) { return stretches[i].line.slope(); };
  const auto error = [&](std::size_t i) {
    const auto samples = static_cast<double>(stretches[i].end - stretches[i].begin);
    return noise * std::sqrt(12 / samples) / (t[stretches[i].end - 1] - t[stretches[i].begin]);
  };
  const auto goes_on = [&](std::size_t i, double change) {  // from one to the next, as far as noise lets see
    return std::copysign(1.0, change) * (slope(i + 1) - slope(i)) > -kErrorsOfSlope * (error(i) + error(i + 1));
  };
  const std::size_t n = stretches.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double change = slope(i + 1) - slope(i - 1);
    stretches[i].on_ramp =
        goes_on(i - 1, change) && goes_on(i, change) && may_bend(t, stretches[i], 0.5 * change, noise);
  }
  if (n < 3) return;
  if (stretches[1].on_ramp) stretches[0].on_ramp = may_bend(t, stretches[0], slope(1) - slope(0), noise);
  if (stretches[n - 2].on_ramp)
    stretches[n - 1].on_ramp = may_bend(t, stretches[n - 1], slope(n - 1) - slope(n - 2), noise);
}

/// Where two lines meet, from near that time.
double meeting_of(const Stretch& one, const Stretch& two, double near) {
  return near - (one.line.at(near) - two.line.at(near)) / (one.line.slope() - two.line.slope());
}

/// Where two lines meet, if that is near the samples between which the corner lies.
double corner_between(std::span<const double> t, const Stretch& one, const Stretch& two) {
  const double early = t[two.begin - 1], late = t[two.begin], middle = 0.5 * (early + late);
  const double meet = meeting_of(one, two, middle);
  const double near = kNearCorner * (late - early);
  return std::isfinite(meet) && meet > early - near && meet < late + near ? meet : middle;
}

/// Stairs of a ramp are short, and meet far from where they were split: between two corners the values rise as much as
/// these are apart.
void join_stairs(const std::vector<Stretch>& stretches, std::vector<LinePiece>& pieces) {
  const auto at_corner = [&](std::size_t i) {
    return 0.5 * (stretches[i - 1].line.at(pieces[i].begin) + stretches[i].line.at(pieces[i].begin));
  };
  for (std::size_t i = 1; i + 1 < pieces.size(); ++i) {
    const double lasts = pieces[i + 1].begin - pieces[i].begin;
    if (stretches[i].on_ramp && lasts > 0) pieces[i].slope = (at_corner(i + 1) - at_corner(i)) / lasts;
  }
}

std::vector<double> picked(std::span<const double> values, std::size_t stride) {
  std::vector<double> out;
  for (std::size_t i = 0; i < values.size(); i += stride) out.push_back(values[i]);
  return out;
}

/// Levels go nowhere but for noise, or by a small part of what their neighbours do.
void settle_levels(const std::vector<Stretch>& stretches, std::span<const double> t, double noise,
                   std::vector<LinePiece>& pieces) {
  std::vector<double> speeds;
  for (const LinePiece& piece : pieces) speeds.push_back(std::abs(piece.slope));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double duration = t[stretches[i].end - 1] - t[stretches[i].begin];
    const double beside = std::max(i > 0 ? speeds[i - 1] : 0.0, i + 1 < pieces.size() ? speeds[i + 1] : 0.0);
    pieces[i].is_level = speeds[i] * duration <= kCornerOfNoise * noise || speeds[i] <= kLevelBeside * beside;
  }
}

/// Corners move to where the lines beside them meet: thinned samples have placed them to a stride.
void move_corners(std::span<const double> t, std::span<const double> x, std::size_t stride,
                  std::vector<Stretch>& stretches) {
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const double meet = meeting_of(stretches[i - 1], stretches[i], t[stretches[i].begin]);
    const auto found = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), meet) - t.begin());
    const std::size_t corner = stretches[i].begin, back = std::min(corner, 2 * stride);
    const std::size_t low = std::max(stretches[i - 1].begin + kFewestOfPiece, corner - back);
    const std::size_t high = std::min(stretches[i].end - kFewestOfPiece, corner + 2 * stride);
    stretches[i - 1].end = stretches[i].begin = low < high ? std::clamp(found, low, high) : corner;
  }
  for (Stretch& s : stretches) s = stretch_of(t, x, s.begin, s.end);
}

}  // namespace

std::vector<LinePiece> piecewise_lines(std::span<const double> t, std::span<const double> readings) {
  std::vector<LinePiece> pieces;
  if (t.size() < 2 * kFewestOfPiece) return pieces;
  const auto [low, high] = std::minmax_element(readings.begin(), readings.end());
  const std::vector<Run> runs = runs_of(readings);
  const double digit = digit_of(readings, runs);
  const std::vector<double> x = between_digits(t, readings, runs, digit);
  const double noise =
      std::max({noise_about_neighbours(t, readings), kNoiseOfDigit * digit, kRoundingOfWay * (*high - *low)});
  const std::size_t stride = 1 + t.size() / kMostSplit;
  const double price = kCornerOfNoise * kCornerOfNoise * noise * noise;
  const std::vector<std::size_t> corners =
      corners_near(t, x, price, stride, corners_of(picked(t, stride), picked(x, stride), price));
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < corners.size(); ++i)
    stretches.push_back(stretch_of(t, x, corners[i], i + 1 < corners.size() ? corners[i + 1] : t.size()));
  std::vector<Stretch> fine = stretches;
  merge_alike(t, x, noise, 0, fine);
  merge_alike(t, x, noise, kLeastChangeOfSlope, stretches);
  for (int again = 0; again < 3; ++again) move_corners(t, x, stride, stretches);
  stretches = with_corners_of_ramps(t, x, noise, fine, stretches);
  find_ramps(t, noise, stretches);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double begin = i == 0 ? t.front() : corner_between(t, stretches[i - 1], stretches[i]);
    pieces.push_back({begin, stretches[i].line.slope(), false, stretches[i].on_ramp});
  }
  join_stairs(stretches, pieces);
  settle_levels(stretches, t, noise, pieces);
  return pieces;
}

}  // namespace tribofit
