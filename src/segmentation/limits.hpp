#pragma once

// The thresholds by which stick and slip are found, with their reasons. What rest is, is said in kinematics/limits.hpp.

namespace tribofit::segmentation {

/// Part of the typical peak below which contacts do not slide throughout: v_r passes through rest there, and friction
/// is not that of a law of speed. Larger: the slow end of a Stribeck curve is lost; smaller: presliding passes for it
/// (a positioning system of published friction then comes out with half of it).
inline constexpr double kReversalPart = 0.01;

}  // namespace tribofit::segmentation
