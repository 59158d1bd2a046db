#pragma once

#include <cstddef>
#include <functional>
#include <optional>
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

/// A machine and two of its variables: one settled motion for each pair of their values. check_map() says what it
/// needs.
struct MapRequest {
  Machine machine;
  MapAxis x, y;               ///< columns and rows of the map
  SettleOptions settle = {};  ///< of every cell
};

/// The cells of a map, a row for each value of y.
using MapRows = std::vector<std::vector<MapCell>>;

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
std::vector<std::pair<double, double>> edge_of_stick_slip(const MapRequest& request, const MapRows& rows,
                                                          std::size_t every = 1);

/// A measure over at most `most` x `most` blocks of cells: the largest value of each, NaN where it holds none [SI].
struct CoarseMap {
  std::vector<double> x, y;            ///< middles of the blocks
  std::vector<std::vector<double>> z;  ///< a row for each y
};
CoarseMap coarse_map(const MapRequest& request, const MapRows& rows, std::size_t measure, std::size_t most);

/// The least or the largest value of a measure and where it is [SI]; nothing where no cell has one.
struct MapExtreme {
  double value = 0, x = 0, y = 0;
};
std::optional<MapExtreme> extreme_of(const MapRequest& request, const MapRows& rows, std::size_t measure, bool largest);

/// The map as CSV, so that one that was interrupted goes on: one cell a line, x, y, regime, measures; to the last
/// digit.
std::string map_csv_header(const MapRequest& request);
std::string map_csv_row(const MapRequest& request, std::size_t row, const std::vector<MapCell>& cells);
/// The cells of a row as map_csv_row() wrote it; nothing where the text is not that row of this map.
std::vector<MapCell> map_row_from_csv(const MapRequest& request, std::size_t row, const std::string& text);

/// Cells in that regime.
std::size_t count_of(const MapRows& rows, Regime regime);

}  // namespace tribofit
