#pragma once

#include <span>
#include <string>

#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// Squares of friction [1 or N squared] that a low-pass leaves which was undone as well as it is known: friction
/// changes by so much in the time that is not known. noise: of a sample of friction. What explains no more is not
/// distinguishable from it.
double left_by_corrections(std::span<const Record> records, const Observations& observations, double noise);

/// Why an effect that shows over this variable cannot be named: a check of the data reports a problem that would look
/// like it. Empty where none does.
///
/// What distorts a reading in the same way all the time (a limit of the range, coarse steps, a filter, a shift between
/// the channels, a wrong level) makes structure within a cycle, and moves its break-away. What comes and goes (missing
/// stretches) makes structure in time.
std::string imitated_by(std::span<const Record> records, SketchView view);

/// Says which checks stood against a name.
void add_open_problems(std::span<const Record> records, Diagnosis& diagnosis);

/// Offers a load that moves and was not recorded: where structure remains that no effect explains, and friction rises
/// and falls from cycle to cycle in proportion at break-away and in fast slip, the effect of the load channel is
/// possible. A step of friction that was found may be one of the load.
void offer_load_variation(std::span<const Record> records, Diagnosis& diagnosis);

}  // namespace tribofit::diagnosis
