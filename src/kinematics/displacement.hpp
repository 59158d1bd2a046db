#pragma once

#include <string>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// Makes the velocity of a trace of displacements: v_b of the block's alone, v_r = dx_d/dt - dx_b/dt where that of the
/// drive is there too (dx_d/dt of a fixed block), with its standard error. Slopes are taken over a twelfth of the
/// period of the fastest fall or rise to either side (smoothing.hpp).
void make_velocity_of_displacement(Trace& trace, std::vector<std::string>& notes);

/// Makes friction and velocity of the motion of a mass on a spring whose base moves by y (0 where it was not recorded):
///   friction = -(m x'' + c (x' - y') + k (x - y)),
/// positive where the mass moves forwards against what it rubs on, v_r = x' (ground) or x' - y' (base). Which of the
/// two is found where it is not stated: friction takes power from the motion. Both with standard errors. The zeros of
/// the two displacements are arbitrary, so that friction forwards and backwards is made equal where both were recorded.
/// Over the load where that is stated, else in N. Throws InputError where mass or stiffness are not known.
void make_friction_of_motion(Trace& trace, std::vector<std::string>& notes);

}  // namespace tribofit::kinematics
