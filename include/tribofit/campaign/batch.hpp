#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tribofit/campaign/run.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Every `count`-th run, beginning with the `index`-th (from 1).
struct Shard {
  std::size_t index = 1, count = 1;
};

struct BatchOptions {
  IdentifyOptions identify;  ///< `read` and `threads` of it are not used
  /// The options as typed: what distinguishes results of the same trace under the same conditions.
  std::vector<std::string> arguments;
  std::vector<std::string> companions;  ///< files that are read besides the traces; their content counts, too
  std::string results;                  ///< folder of the results
  Shard shard;
  bool again = false;  ///< fit what is there already, too
  int threads = 0;     ///< 0: as many as there are; the results do not depend on it
  /// Bytes of traces that may be read at the same time (one is, however long). Memory is about one and a half times it.
  std::uint64_t bytes_at_once = std::uint64_t{160} << 20;
};

struct BatchProgress {
  std::size_t done = 0, total = 0;  ///< runs of the shard
  std::uint64_t fitted_bytes = 0;   ///< of the traces fitted so far
  std::uint64_t left_bytes = 0;     ///< of those still to be looked at
  std::string_view name;            ///< of the run that ended last
};

/// How each run of the shard ended, in the order of the campaign.
struct RunEnd {
  const Run* run = nullptr;
  RunStatus status = RunStatus::ok;
  std::string message;   ///< why it is not ok, with its file
  bool present = false;  ///< it was there already
  bool kept = true;      ///< its result is in the folder
  bool begun = true;     ///< false: left for the next time, see BatchOutcome::stopped
};

struct BatchOutcome {
  std::vector<RunEnd> ends;
  std::size_t fitted = 0, present = 0, failed = 0;  ///< every run that was begun is one of them
  bool stopped = false;  ///< nothing could be written any more, so that runs were left for the next time
};

/// What the batch does with what it finds.
struct BatchHooks {
  /// Puts the result into the folder under its name, whole or not at all (the analysis is null where there is none).
  /// Called from several threads. May throw InputError.
  std::function<void(const RunRecord&, const Identification*)> keep;
  std::function<void(const BatchProgress&)> progress;  ///< called by one thread at a time; may be empty
};

/// Why the analysis could not be done; empty where it was.
std::string failure_of(const Identification& result);

/// Path of the result of a run.
std::string result_path(const std::string& results, const std::string& name);

/// Hash of tool, options and companion files. Throws InputError for a companion that cannot be read.
std::string options_hash(const BatchOptions& options);

/// Hash of all that the result of a run depends on and that is known without reading its trace: the options, the name
/// and what is stated of the run. 16 hexadecimal digits.
std::string settings_hash(const Run& run, const std::string& hash_of_options);

/// Analyses every run of the shard that has no result of the same key yet. Traces run side by side, as many as there
/// are threads and as bytes_at_once allows; one that does not leave memory for others has more threads for itself.
/// A run that cannot be read, or whose trace changes under the reader, is a result with a reason; the others go on.
/// Any number of batches may work on one folder at once. Cost: linear in bytes of traces.
BatchOutcome run_batch(const Campaign& campaign, const BatchOptions& options, const BatchHooks& hooks);

/// The way from the folder of results to that of the traces; empty where these were named one by one.
std::string folder_beside_results(const std::string& folder, const std::string& results);

/// campaign.json: the runs in order, each with the hash of its settings, the folder they lie in, and the rows of the
/// manifest that are no runs. Every shard of a campaign writes the same.
std::string campaign_json(const Campaign& campaign, const BatchOptions& options);

/// Makes a shard work to the plan that another one wrote, campaign.json: a folder that changes meanwhile moves no run
/// from one shard to another. New runs are left out, with a note; those whose file is gone stay, with a problem. A plan
/// of which every run has a result is done: the campaign is as it was found. Returns whether there is a plan to follow.
/// Throws InputError where it was planned with other options or conditions.
bool follow_plan(const BatchOptions& options, Campaign& campaign);

}  // namespace tribofit
