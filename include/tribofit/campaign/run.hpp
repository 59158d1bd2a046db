#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tribofit/campaign/names.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/ingest/manifest.hpp"

namespace tribofit {

/// One run of a campaign: a trace to read and what is known of it beforehand.
struct Run {
  TraceInput trace;                          ///< with the conditions of the command line over those of the manifest
  std::vector<std::string> notes, warnings;  ///< how it was found; where what is known contradicts itself
  ManifestRow known;                         ///< as stated in manifest and command line, for recognising repeats
  std::string name;                          ///< of its result: the file without extension, unique in the campaign
  std::string file;                          ///< relative to the folder of the campaign, or as named
  std::string problem;                       ///< why it cannot be read; empty: nothing is known against it
};

/// A set of runs that are fitted alike.
struct Campaign {
  std::string folder;  ///< empty where files were named one by one
  std::vector<Run> runs;
  std::vector<std::string> problems;  ///< rows of the manifest that name no run of their own
  std::vector<std::string> notes;     ///< files of the folder that were excluded
};

/// The run of one file of which nothing but `read` is known.
Run run_of(const std::string& path, const ReadOptions& read);

struct FindOptions {
  ManifestErrors errors = ManifestErrors::refuse;  ///< what defects of single rows of a manifest do
  std::optional<NamePattern> pattern;              ///< by which names of files say the conditions of their runs
};

/// The runs that `names` stand for. A folder stands for the runs of its manifest.csv in that order, or, where it has
/// none, for the CSV files in it in order of name. What the user says (`read`) beats manifest and file names;
/// contradictions become warnings of the run. A file that does not fit the pattern is a run with a problem.
/// Throws InputError for a folder without traces, a manifest that cannot be used, and a folder with a manifest where a
/// pattern is given.
Campaign find_runs(const std::vector<std::string>& names, const ReadOptions& read, const FindOptions& options = {});

}  // namespace tribofit
