#pragma once

#include "tribofit/campaign/batch.hpp"

namespace tribofit {

/// Makes a shard work to the plan that another one wrote: the runs of campaign.json in its order, so that a folder that
/// changes meanwhile moves no run from one shard to another. Runs that are new are left out, with a note; those whose
/// file is gone stay, with a problem. A plan of which every run has a result is done: the campaign is as it was found.
/// Returns whether there is a plan to follow. Throws InputError where its runs were planned with other options or
/// conditions: every shard must have the same.
bool follow_plan(const BatchOptions& options, Campaign& campaign);

}  // namespace tribofit
