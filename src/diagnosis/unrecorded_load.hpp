#pragma once

#include <span>

#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// How far friction swings in proportion, at break-away and in fast slip alike, from cycle to cycle [1]: as under a
/// load that moves. 0: it does not, or the load is recorded.
double common_swing(std::span<const Record> records);

/// Offers a load that moves and was not recorded: where structure remains that no effect explains, and friction rises
/// and falls from cycle to cycle in proportion at break-away and in fast slip, the effect of the load channel is
/// possible. A step of friction that was found may be one of the load.
void offer_load_variation(std::span<const Record> records, Diagnosis& diagnosis);

}  // namespace tribofit::diagnosis
