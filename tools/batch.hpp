#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/campaign/run.hpp"

/// Whether what was typed asks for a batch: results in a folder, one file a run.
bool is_batch(const Settings& settings, const tribofit::Campaign& campaign);

/// Fits the runs into the folder of results and shows them; the exit status.
int run_as_batch(const Settings& settings, const tribofit::Campaign& campaign, const tribofit::IdentifyOptions& options,
                 const std::vector<std::string>& arguments);

/// Pools the results that lie in a folder, writes what they say together beside them and returns it as text.
std::string pool_results(const Settings& settings, const std::string& results);

/// Puts '/' behind a name, for showing that it is a folder.
std::string as_folder(std::string name);
