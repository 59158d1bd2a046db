#include "ladder.hpp"

#include "limits.hpp"

namespace tribofit::diagnosis {

double largest_fall(const std::vector<Probe>& probes) {
  const std::vector<Probe> structure = remaining_structure(probes);
  return structure.empty() ? 0 : structure.front().fall;
}

void withdraw(Ladder& ladder, double swinging) {
  const double left = largest_fall(ladder.steps.back().probes);
  if (left == 0 && swinging == 0) return;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {
    const Trial &below = ladder.steps[s - 1].trial, &trial = ladder.steps[s].trial;
    const double shown = largest_fall(ladder.steps[s - 1].probes);
    const bool is_little = !ladder.steps[s].by_level && left >= limits::kLeastStructure * shown && left > 0 &&
                           below.held_out_squares - trial.held_out_squares < limits::kWithdrawnPart * shown;
    // What acts by the levels of break-away alone hardly shows in squares that are whitened against their scatter.
    if (!is_little && !(below.plain_held_out - trial.plain_held_out < swinging)) continue;
    for (std::size_t k = s; k < ladder.steps.size(); ++k) ladder.withdrawn.push_back(*ladder.steps[k].added);
    ladder.last = ladder.steps[s].judged;
    ladder.steps.resize(s);
    return;
  }
}

}  // namespace tribofit::diagnosis
