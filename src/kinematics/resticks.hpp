#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit::kinematics {

/// v_r about one re-stick, every `stride`-th sample.
struct Restick {
  std::vector<double> velocity;
  double squares = 0;                 ///< sum of its squares
  double fall = 0;                    ///< samples in which it falls from the highest to nothing
  double at = 0;                      ///< where it does, roughly [samples]
  std::size_t begin = 0, stride = 1;  ///< of these samples in the record
};

/// The re-sticks of v_r, each from where it has fallen to a part `from` of the fastest; `shortest`: rest after them
/// that they must have, over the fall.
std::vector<Restick> find_resticks(std::span<const double> v, double rest, double fastest, double from,
                                   double shortest);

/// Evenly picked: about so many, up to twice as many.
std::vector<Restick> some_of(const std::vector<Restick>& all, std::size_t count);

/// How far v_r goes beyond rest after re-stick, the median over re-sticks [m/s].
double beyond_rest(const std::vector<Restick>& some);

/// How much v_r rises from before the middle of a stick to after it, the median over sticks [m/s]: behind a filter a
/// block at rest stays at rest, a contact that spins creeps as friction grows.
double rise_in_stick(std::span<const double> v, double rest, double fastest);

}  // namespace tribofit::kinematics
