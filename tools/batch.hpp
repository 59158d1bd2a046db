#pragma once

#include <string>
#include <vector>

#include "exit_status.hpp"
#include "settings.hpp"
#include "tribofit/campaign/run.hpp"

/// Whether what was typed asks for a batch: results in a folder, one file a run.
bool is_batch(const Settings& settings, const tribofit::Campaign& campaign);

/// Fits the runs into the folder of results and shows them; the exit status.
ExitStatus run_as_batch(const Settings& settings, tribofit::Campaign campaign, const tribofit::IdentifyOptions& options,
                        const std::vector<std::string>& arguments);

/// Puts '/' behind a name, for showing that it is a folder.
std::string as_folder(std::string name);
