#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// What a model leaves over cycle and phase of the slip.
struct ResidualMap {
  std::vector<double> first_cycle;        ///< of the neighbours that a row has together
  std::vector<double> phase;              ///< of the columns, from break-away (0) to re-stick (1)
  std::vector<std::vector<double>> mean;  ///< rows: mean of measured less predicted friction; NaN: nothing there
  double usual = 0;                       ///< size that 99.5 % of the cells stay below
};

/// At most `rows` rows and exactly `columns` columns, of the slips that are whole and selected. prediction: a value a
/// sample, NaN outside slips. Friction counts as positive in either direction.
ResidualMap residual_map(const Motion& motion, const Segmentation& segmentation, std::span<const double> prediction,
                         std::size_t rows = 120, std::size_t columns = 50);

}  // namespace tribofit
