#pragma once

#include <string>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"

namespace tribofit::joined {

/// Two files of one run or of none, as two instruments write them.
struct Pair {
  std::string name;
  truth::Rig rig;      ///< of the run; as long as both files together
  double slower = 1;   ///< all times so many times as long
  double length = 40;  ///< of either file [s]
  double late = 0;     ///< by which the velocity starts after friction [s]
  double clock = 0;    ///< what the velocity's clock shows then [s]
  double ppm = 0;      ///< by which it is fast
  bool strangers = false;
  std::size_t friction_every = 1, velocity_every = 1;  ///< samples kept
  bool reversed = false;                               ///< friction of the other sign
};

/// Five hundred: late starts of 0.1 to 30 s either way, one clock or two, drift to 200 ppm, other runs, no overlap.
std::vector<Pair> pairs();

/// Regular stick-slip, few cycles, different rates, noise, slow and fast rigs, sliding, a reversed sign.
std::vector<Pair> other_pairs();

enum class Outcome { right, refused, wrong };

struct Judged {
  Outcome outcome = Outcome::wrong;
  double error = 0, std_error = 0;  ///< [s]
  double seconds = 0;
  std::string text;
  bool belongs = false;  ///< of one run
};

/// Joins them. right: within 0.1 ms, or a quarter of a sample of the slower instrument, or the part of a slip that 0.1
/// ms is of the rig of [D].
Judged judge(const Pair& pair);

}  // namespace tribofit::joined
