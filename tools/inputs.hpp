#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/campaign/run.hpp"

using Input = tribofit::Run;

/// The one trace of a verb that takes one at a time (a folder of one does). Usage error where there are none or
/// several, or where an output would overwrite an input.
Input only_input(const Settings& settings, const tribofit::ReadOptions& read, const std::string& verb);

/// What is known of an input besides the data.
void add_remarks(const Input& input, tribofit::TracePart& trace);

/// The user's own options and the conditions that came from the manifest, so that the trace can be named alone.
std::vector<std::string> arguments_for(const Input& input, std::vector<std::string> arguments);

/// Runs that are not used in a diagnosis, for confirming it.
struct Split {
  std::vector<Input> diagnosed, kept;
  std::vector<std::string> notes;
};

/// The runs named are kept (those not among the inputs are read with `read`). Where none is named, the last repeat of
/// each condition is, as long as another run of that condition is diagnosed; runs repeat each other where all that is
/// stated of them is the same and radius and speed, or a number of the repeat, are stated.
Split keep_for_confirmation(std::vector<Input> inputs, const std::vector<std::string>& named,
                            const tribofit::ReadOptions& read);
