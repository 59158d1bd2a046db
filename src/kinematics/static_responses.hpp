#pragma once

#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/instruments/static_response.hpp"
#include "tribofit/statistics/estimate.hpp"

namespace tribofit::kinematics {

/// The response of the velocity channel with which a block on a spring goes nowhere: of the forms the one that balances
/// the forces best, m a + c v + k x = N mu, whatever the law of friction. mean: of v_b as read, from stick to stick
/// (see BlockZero). Of a disc at one speed. Cost: two passes.
UndoneResponse find_velocity_response(const Trace& trace, const PlateauSearch& search, const Estimate& mean);

/// The response of the friction channel with which friction rises in a straight line in stick, over the displacement of
/// the block and over that of the disc: it is the force of the spring. None where these do not agree (the contact
/// creeps, or the velocity is read wrongly), where the halves of the record do not, or where friction rises faster
/// towards break-away, which a spring that hardens does too. Cost: two passes.
UndoneResponse find_friction_response(const Trace& trace, const PlateauSearch& search);

/// By how much friction bends in stick over the displacement of the disc and over that of the block as read: the part
/// that a linear StaticResponse would have to make it straight. In stick it is the force of a spring, straight over the
/// displacement that the block truly has.
struct StickBends {
  double over_disc = 0, over_way = 0, std_error = 0;  ///< std_error: of the larger one; 0: too few sticks
};
StickBends bends_in_stick(const Trace& trace, const PlateauSearch& search);

}  // namespace tribofit::kinematics
