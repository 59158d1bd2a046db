#pragma once

#include <span>
#include <vector>

#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::kinematics {

/// What v_b is on average, from stick to stick. The block hangs on a spring and goes nowhere, so that it is zero. A
/// wrong zero of the vibrometer shifts the plateau by as much; where the plateau is right, slips are read wrongly.
struct BlockZero {
  enum class Kind {
    none,    ///< zero within its error, or not to be had
    zero,    ///< the plateau is off omega r by as much
    uneven,  ///< the plateau is not, or omega r is not known
  };
  Kind kind = Kind::none;
  Estimate mean;  ///< [m/s]
};

/// Where the block is in the middles of the plateaus.
struct BlockPositions {
  std::vector<double> time, position;  ///< [s], [m]
};

/// Cost: one pass.
BlockPositions positions_in_plateaus(std::span<const double> time, std::span<const double> velocity,
                                     const PlateauSearch& search, int threads = 1);

/// Of the block over the record [m/s].
Estimate mean_velocity(const BlockPositions& positions);

/// By how much the zero of v_b moves in a second [m/s^2], evenly: plateaus and the mean velocity of the block move
/// alike. A disc that changes its speed moves plateaus alone, slips that are read wrongly the mean alone. Zero where
/// they do not agree, or within their errors. Of a disc at one speed. step: of the converter [m/s]; 0: fine.
Estimate find_zero_drift(const Trace& trace, const PlateauSearch& search, const BlockPositions& positions, double step);

/// step: of the converter [m/s]; 0: fine.
BlockZero find_zero(const PlateauSearch& search, const Disc& disc, const BlockPositions& positions, double step);

/// The same of a v_r that was measured and rests nowhere: a plateau is off zero by as much as the mean is off omega r.
BlockZero find_zero_of_relative(const Trace& trace, const PlateauSearch& search, const Disc& disc);

/// Adds what was found to the check of the plateau. response: of the velocity, that was undone.
void add_zero(const BlockZero& zero, bool speed_was_stated, const UndoneResponse& response, HealthItem& item);

}  // namespace tribofit::kinematics
