#pragma once

#include <string>

#include "settings.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/campaign/sharing.hpp"
#include "tribofit/report/campaign.hpp"

/// Wrong usage or tribofit::InputError: a table of earlier values that cannot be read, or that would be overwritten by
/// what is written into the folder of results.
void check_comparison(const Settings& settings, const std::string& results);

/// What --share and --vary say. Throws CLI::ValidationError.
tribofit::Sharing sharing_from(const Settings& settings);

/// Writes all that is made of the results of a campaign: summary, what the runs say together, figures and, where a
/// table of earlier values is named, the comparison with it. All of it for people is in the table that is returned.
/// Throws tribofit::InputError.
tribofit::CampaignSummary summarise(const Settings& settings, const tribofit::ResultReader& results);
