#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

using Input = tribofit::Run;

/// The one trace of a verb that takes one at a time (a folder of one does). Usage error where there are none or
/// several, or where an output would overwrite an input.
Input only_input(const Settings& settings, const tribofit::ReadOptions& read, const std::string& verb);

/// What is known of an input besides the data.
void add_remarks(const Input& input, tribofit::TracePart& trace);

/// The user's own options and the conditions that came from the manifest, so that the trace can be named alone.
std::vector<std::string> arguments_for(const Input& input, std::vector<std::string> arguments);

/// The records that the verbs of a diagnosis take.
struct Split {
  std::vector<Input> diagnosed;
  std::vector<Input> kept;  ///< for confirming it
  std::vector<std::string> notes;
};

/// Records that are not used, and why.
struct LeftOut {
  std::vector<std::string> reasons;
  bool any_read = false;  ///< one could be read, but not analysed
};

/// The runs that can be used, for that verb; what is left out is printed. A single one is taken as it is: the diagnosis
/// itself says what stops it.
Split usable_runs(const Settings& settings, const tribofit::IdentifyOptions& options, const std::string& verb,
                  LeftOut& left_out);

/// How the result of these runs is shown here and now: a single one by its own name and conditions.
tribofit::TerminalOptions shown_as(const Split& split, const Settings& settings,
                                   const std::vector<std::string>& arguments);

std::vector<tribofit::TraceInput> traces_of(const std::vector<Input>& inputs);

/// What is known of the inputs besides the data stands with the trace it is about, or with the first.
void add_remarks(const Split& split, tribofit::DiagnosedTraces& result);

/// Why a diagnosis could not be done.
std::string reason_of(const tribofit::DiagnosedTraces& result);

/// The moment at which a time that begins now is over; nothing where there is no limit.
std::optional<std::chrono::steady_clock::time_point> end_of(const std::string& time_limit);
