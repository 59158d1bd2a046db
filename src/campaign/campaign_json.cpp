#include <filesystem>
#include <string>
#include <system_error>

#include "output/json.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

std::string campaign_json(const Campaign& campaign, const BatchOptions& options) {
  const std::string hash = options_hash(options);
  std::error_code ignored;
  const Json folder =
      campaign.folder.empty() ? Json() : Json(std::filesystem::weakly_canonical(campaign.folder, ignored).string());
  const auto run_json = [&](const Run& run) {
    return object("name", run.name, "file", run.file, "settings", settings_hash(run, hash));
  };
  return sealed(text_of(object("tool", object("name", "tribofit", "version", version), "folder", folder, "runs",
                               list_of(campaign.runs, run_json), "problems", campaign.problems)));
}

}  // namespace tribofit
