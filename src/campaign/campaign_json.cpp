#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "tribofit/campaign/batch.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

std::string campaign_json(const Campaign& campaign, const BatchOptions& options) {
  using Json = nlohmann::ordered_json;
  const std::string hash = options_hash(options);
  std::error_code ignored;
  const Json folder =
      campaign.folder.empty() ? Json() : Json(std::filesystem::weakly_canonical(campaign.folder, ignored).string());
  Json runs = Json::array();
  for (const Run& run : campaign.runs) {
    runs.push_back({{"name", run.name}, {"file", run.file}, {"settings", settings_hash(run, hash)}});
  }
  const Json json = {{"tool", {{"name", "tribofit"}, {"version", version}}},
                     {"folder", folder},
                     {"runs", std::move(runs)},
                     {"problems", campaign.problems}};
  return sealed(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace tribofit
