#pragma once

#include <string_view>
#include <vector>

#include "ladder.hpp"

namespace tribofit::diagnosis {

/// The trial's model without one of its effects, fitted.
Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads = 1);

/// Fills in what is asked of every step.
void look_beside(const DiagnosisContext& context, LadderStep& step);

/// What the largest structure beside a step would take away of the held-out squares; 0 where none is left.
double largest_fall(const LadderStep& step);

/// Drops effects that the ones added after them made redundant. Returns the top without each of those left.
std::vector<Trial> prune(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                         const Limits& least);

/// Each effect was chosen beside what was known then. Once the others are there too, it is compared once more with
/// those that explained nearly as much: the better one takes its place, and its group is drawn anew. True where one was
/// replaced. without: the top without each of its effects; empty where that is not known.
bool reconsider(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                const Limits& least, std::vector<Trial> without = {});

/// Where structure is left that no effect explains, a name that was given to a smaller part of the error while a free
/// function of one variable explained far more is probably wrong: it is withdrawn, with those that stand on it. Not
/// where the effects above it have explained nearly all of that after all. Nor does a name stand for less than what is
/// left where friction swings as a whole: a load that moves makes another law of any. swinging: squares that are left
/// there, with the scatter of break-away; 0: it does not swing.
void withdraw(Ladder& ladder, double swinging);

}  // namespace tribofit::diagnosis
