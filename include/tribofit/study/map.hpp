#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/study/settled.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

/// One axis of a map.
struct MapAxis {
  Variable variable;
  std::vector<double> values;  ///< SI
};

/// What is known of one cell: its regime and every measure [SI], in the order of measures().
struct MapCell {
  Regime regime = Regime::not_settled;
  std::vector<double> values;
};

struct MapRequest {
  Machine machine;
  MapAxis x, y;
  SettleOptions settle = {};
};

/// Throws InputError where axes are empty, the same, or hold values with which there is no machine: found before any
/// cell is computed, with the value that cannot be.
void check_map(const MapRequest& request);

/// Settled motion over a grid, a row (one value of y) at a time, on `threads` threads.
///
/// done[row]: rows that are known already and left out. on_row is called once for each of the others, in any order, by
/// one thread at a time; when it returns false, no further row is begun. Rows do not depend on one another nor on the
/// number of threads, so that a map that was interrupted ends the same to the last bit.
void compute_map(const MapRequest& request, const std::vector<bool>& done, int threads,
                 const std::function<bool(std::size_t row, const std::vector<MapCell>& cells)>& on_row);

/// Where stick-slip begins or ends [SI, x then y], halfway between the cells along every `every`-th row and column.
std::vector<std::pair<double, double>> edge_of_stick_slip(const MapRequest& request,
                                                          const std::vector<std::vector<MapCell>>& rows,
                                                          std::size_t every = 1);

}  // namespace tribofit
