#include "resticks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

std::vector<Restick> find_resticks(std::span<const double> v, double rest, double fastest, double from,
                                   double shortest) {
  const double high = from * fastest, low = kRestickDown * fastest;
  std::vector<Restick> all;
  for (std::size_t i = 0; i < v.size();) {
    while (i < v.size() && std::abs(v[i] - rest) < kRestickSlip * fastest) ++i;
    if (i == v.size()) break;
    const double sign = v[i] > rest ? 1 : -1;
    const auto reads = [&](std::size_t k) { return sign * (v[k] - rest); };
    while (i < v.size() && reads(i) >= high) ++i;
    const std::size_t begin = i - 1;
    std::size_t down = begin;
    while (down < v.size() && reads(down) > low) ++down;
    i = down;
    const std::size_t fall = down - begin;
    std::size_t end = down;
    while (end < std::min(v.size(), down + 6 * fall) && reads(end) < low) ++end;
    // A short stick ends before the velocity has grown to where it began to rest.
    end = std::min(down + 2 * fall, down + (end - down) / 3);
    if (fall < kRestickSamples || static_cast<double>(end - down) < shortest * static_cast<double>(fall) ||
        end + 1 >= v.size())
      continue;
    const std::size_t stride = std::max<std::size_t>(1, fall / kRestickMost);
    Restick restick;
    restick.begin = begin, restick.stride = stride;
    std::vector<double> after;
    for (std::size_t k = end - std::max<std::size_t>(2, (end - down) / 4); k < end; ++k) after.push_back(reads(k));
    const double level = median(std::move(after));
    for (std::size_t k = begin; k < end; k += stride) restick.velocity.push_back(reads(k) - level);
    for (const double y : restick.velocity) restick.squares += y * y;
    restick.fall = static_cast<double>(fall) / static_cast<double>(stride);
    restick.at = restick.fall;
    all.push_back(std::move(restick));
  }
  return all;
}

double rise_in_stick(std::span<const double> v, double rest, double fastest) {
  std::vector<double> rises;
  for (std::size_t i = 0; i < v.size();) {
    while (i < v.size() && std::abs(v[i] - rest) >= kRestickSlip * fastest) ++i;
    const std::size_t begin = i;
    while (i < v.size() && std::abs(v[i] - rest) < kRestickSlip * fastest) ++i;
    const std::size_t eighth = (i - begin) / 8;
    if (begin == 0 || i == v.size() || eighth == 0) continue;
    double rise = 0;
    for (std::size_t k = begin + 2 * eighth; k < begin + 3 * eighth; ++k) rise += v[k + 3 * eighth] - v[k];
    rises.push_back((v[i] > rest ? rise : -rise) / static_cast<double>(eighth));
  }
  return rises.empty() ? 0 : median(std::move(rises));
}

std::vector<Restick> some_of(const std::vector<Restick>& all, std::size_t count) {
  std::vector<Restick> some;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t k = 0; k < all.size(); k += stride) some.push_back(all[k]);
  return some;
}

double beyond_rest(const std::vector<Restick>& some) {
  std::vector<double> beyond;
  for (const Restick& restick : some) {
    beyond.push_back(-*std::min_element(restick.velocity.begin(), restick.velocity.end()));
  }
  return median(std::move(beyond));
}

}  // namespace tribofit::kinematics
