#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// A stroke of a motion back and forth, with those before it that a contact still remembers, the longest first.
struct SlidingStroke {
  double gone = 0;                  ///< since it began [m]
  std::span<const double> earlier;  ///< lengths of strokes [m]; empty: nothing is known of what came before
};

/// A stroke that comes back to where the one before it began has closed that loop, and goes on as the stroke before
/// the two did (E. Madelung, Ann. Phys. 322 (1905) 861). The longest loop is taken to be symmetric: nothing is known of
/// what was before it.
inline SlidingStroke with_loops_closed(SlidingStroke stroke) {
  auto& [gone, earlier] = stroke;
  while (earlier.size() > 1 && gone >= earlier.back()) {
    const std::size_t n = earlier.size();
    gone += earlier[n - 2] - earlier.back();
    earlier = earlier.first(n > 2 ? n - 2 : 1);
  }
  return stroke;
}

/// Remembers strokes as they end.
class StrokeMemory {
 public:
  void end_stroke(double length) {
    const SlidingStroke ended = with_loops_closed({length, lengths_});
    lengths_.resize(ended.earlier.size());
    if (lengths_.size() == 1 && ended.gone >= lengths_[0]) {  // about the same middle
      if (ended.gone > kBeyond * lengths_[0]) lengths_[0] = 2 * ended.gone - lengths_[0];
      return;
    }
    lengths_.push_back(ended.gone);
    if (lengths_.size() > kMost) lengths_.erase(lengths_.begin(), lengths_.begin() + 2);
  }
  std::span<const double> lengths() const { return lengths_; }

 private:
  /// Over the longest: a position that was integrated wanders by less.
  static constexpr double kBeyond = 1.05;
  /// Strokes that grow shorter all the time are all remembered; the longest of so many no longer matter.
  static constexpr std::size_t kMost = 8;
  std::vector<double> lengths_;
};

}  // namespace tribofit
