#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/ingest/manifest.hpp"
#include "tribofit/pipeline.hpp"

/// A trace to read and where what is known of it contradicts itself.
struct Input {
  tribofit::TraceInput trace;
  std::vector<std::string> notes, warnings;
  tribofit::ManifestRow known;  ///< as stated in manifest and command line, for telling repeats
};

/// The traces named. A folder stands for the runs of its manifest.csv, or, where it has none, for the CSV files in it
/// in order of name. What the command line says (`read`) beats the manifest.
/// Throws tribofit::InputError for a folder without traces and for a manifest that cannot be used.
std::vector<Input> inputs_from(const std::vector<std::string>& names, const tribofit::ReadOptions& read);

/// Whether two names lead to one file.
bool same_file(const std::string& a, const std::string& b);

/// The user's own options and the conditions that came from the manifest, so that the trace can be named alone.
std::vector<std::string> arguments_for(const Input& input, std::vector<std::string> arguments);

/// Runs that take no part in a diagnosis, for confirming it.
struct Split {
  std::vector<Input> diagnosed, kept;
  std::vector<std::string> notes;
};

/// The runs named are kept (those not among the inputs are read with `read`). Where none is named, the last repeat of
/// each condition is, as long as another run of that condition takes part; runs repeat each other where all that is
/// stated of them is the same and radius and speed, or a number of the repeat, are stated.
Split keep_for_confirmation(std::vector<Input> inputs, const std::vector<std::string>& named,
                            const tribofit::ReadOptions& read);
