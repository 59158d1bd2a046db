#include <filesystem>
#include <system_error>

#include "described_results.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

std::string campaign_json(const Campaign& campaign, const BatchOptions& options) {
  const std::string hash = options_hash(options);
  std::error_code ignored;
  CampaignPlan plan{"", {}, campaign.problems};
  if (!campaign.folder.empty()) plan.folder = std::filesystem::weakly_canonical(campaign.folder, ignored).string();
  for (const Run& run : campaign.runs) plan.runs.push_back({run.name, run.file, settings_hash(run, hash)});
  Json json = object("tool", object("name", "tribofit", "version", version));
  json.update(json_of(plan));
  return sealed(text_of(json));
}

}  // namespace tribofit
