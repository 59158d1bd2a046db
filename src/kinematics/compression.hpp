#pragma once

#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::kinematics {

/// v_meas = v_b (1 - part (v_b/fastest)^2): a gain that falls towards the fastest v_b.
struct Compression {
  UndoneDistortion part;  ///< [1]; 0: none of this kind
  double fastest = 0;     ///< [m/s]
};

/// What was read as v_meas.
double decompressed(double reading, double part, double fastest);

/// The part by which the block goes nowhere. mean: of v_meas, from stick to stick (see BlockZero). Cost: a few passes.
Compression find_compression(const Trace& trace, const PlateauSearch& search, const Estimate& mean);

}  // namespace tribofit::kinematics
