#include "tribofit/statistics/change_point.hpp"

#include <cstddef>
#include <numeric>

namespace tribofit {

std::vector<double> squares_by_change(std::span<const double> before, std::span<const double> after) {
  std::vector<double> out = {std::accumulate(after.begin(), after.end(), 0.0)};
  for (std::size_t k = 0; k < before.size(); ++k) out.push_back(out.back() + before[k] - after[k]);
  return out;
}

}  // namespace tribofit
