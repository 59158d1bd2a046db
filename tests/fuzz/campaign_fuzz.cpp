// What campaigns read back: earlier tables, and results that other processes wrote.

#include <cmath>
#include <filesystem>

#include "campaign/kept_samples.hpp"
#include "scratch.hpp"
#include "targets.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/campaign/pooled.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit::fuzz {
namespace {

/// What pooled runs have: two laws with their parameters.
PooledGroup group() {
  PooledGroup out;
  out.conditions.radius = {0.015, "manifest"};
  PooledGroup::OfFit fit;
  fit.law = "exponential";
  fit.protocol = "joint";
  for (const auto& [name, unit] : {std::pair{"mu_s", "1"}, std::pair{"mu_k", "1"}, std::pair{"alpha", "s/mm"}}) {
    PooledValue value;
    value.name = name;
    value.unit = unit;
    fit.parameters.push_back(value);
  }
  out.fits.push_back(fit);
  return out;
}

void read_all(const std::string& folder) {
  is_read([&] {
    const ResultReader results(folder);
    for (std::size_t k = 0; k < results.size(); ++k) {
      const auto result = results.read(k);
      results.figures(k);
      results.condensed(k);
      require(!result || result->fits.empty() || result->best < result->fits.size());
    }
  });
  is_read([&] { pool_repeats(read_results(folder)); });
}

}  // namespace

void read_earlier_bytes(std::string_view bytes) {
  static const Folder scratch;
  static const std::vector<PooledGroup> groups = {group()};
  const std::string path = scratch.write("table.csv", bytes);
  is_read([&] {
    const EarlierTable table = read_earlier(path, groups);
    require(!table.values.empty());
    for (const EarlierValue& value : table.values) require(std::isfinite(value.value) && value.line > 1);
  });
}

void read_results_bytes(std::string_view bytes) {
  static const Folder scratch;
  [[maybe_unused]] static const std::string campaign = scratch.write(
      campaign_name, sealed(R"({"folder": "runs", "runs": [{"name": "a", "file": "a.csv", "settings": "1"}],
  "problems": []
}
)"));
  std::filesystem::create_directory(scratch / kept_folder);
  for (const char* kept : {"a.figures.json", "a.condensed.json"}) {
    scratch.write(std::string(kept_folder) + "/" + kept, sealed(bytes));
  }
  const std::string path = scratch.write("a.json", sealed(bytes));
  read_record(path);
  read_all(scratch.path());
}

void read_campaign_bytes(std::string_view bytes) {
  static const Folder scratch;
  scratch.write(campaign_name, sealed(bytes));
  read_all(scratch.path());
}

}  // namespace tribofit::fuzz
