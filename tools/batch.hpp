#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/campaign/sharing.hpp"
#include "tribofit/report/campaign.hpp"
#include "tribofit/report/report.hpp"

/// Whether what was typed asks for a batch: results in a folder, one file a run.
bool is_batch(const Settings& settings, const tribofit::Campaign& campaign);

/// Fits the runs into the folder of results and shows them; the exit status.
ExitStatus run_as_batch(const Settings& settings, tribofit::Campaign campaign, const tribofit::IdentifyOptions& options,
                        const std::vector<std::string>& arguments);

/// Puts '/' behind a name, for showing that it is a folder.
std::string as_folder(std::string name);

/// Usage error or tribofit::InputError: a table of earlier values that cannot be read, or that would be overwritten by
/// what is written into the folder of results.
void check_comparison(const Settings& settings, const std::string& results);

/// What --share and --vary say. Throws UsageError.
tribofit::Sharing sharing_from(const Settings& settings);

/// A campaign's summary, and what was asked beyond it and could not be done.
struct Summarised {
  struct Refusal {
    ExitStatus status = ExitStatus::done;
    std::string why;
  };
  tribofit::CampaignSummary summary;
  std::vector<Refusal> refused;
  std::string note;   ///< what was left as it is; empty: nothing
  std::string table;  ///< all of it for people
};

/// Writes all that is made of the results of a campaign: summary, what the runs say together, figures and, where a
/// table of earlier values is named, the comparison with it, and the report where one is asked for (`shown`: how it
/// says what was run). All of it for people is in the table that is returned. A sharing or a comparison that cannot be
/// done is named; the rest is written all the same. Throws tribofit::InputError where nothing can be written.
Summarised summarise(const Settings& settings, const tribofit::ResultReader& results,
                     const tribofit::ReportOptions& shown);

/// Prints what could not be done; the exit status for it.
ExitStatus print_refusals(const Summarised& all);
