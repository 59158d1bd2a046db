#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ladder.hpp"

namespace tribofit::diagnosis {

/// Base laws to climb from. Where a choice is given and no record ever sticks, Coulomb friction is one more: nothing in
/// such records shows a level of break-away, and a drop from it must be found in sliding alone.
/// Where a choice is given the other laws of the list compete too, Coulomb friction among them where the block sticks.
/// effects: part of the model from the start; the law must be one that they can act on.
CompetingLaws base_laws(std::span<const Record> records, std::vector<Law> given, std::span<const Effect> effects = {});

/// The ladder to tell: see better_ladder. Where Coulomb friction is among them, a law that only rises in a straight
/// line does not compete: it is Coulomb friction with something more, and the ladder from there says what.
std::size_t reported_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders);

}  // namespace tribofit::diagnosis
