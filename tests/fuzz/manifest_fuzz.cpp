#include "scratch.hpp"
#include "targets.hpp"
#include "tribofit/ingest/manifest.hpp"

namespace tribofit::fuzz {
namespace {

void require_positive(const Condition& condition) {
  require(!condition.known() || (condition.value > 0 && condition.source == "manifest"));
}

void require_valid(const Manifest& manifest) {
  require(!manifest.rows.empty() || !manifest.problems.empty());
  for (const ManifestRow& row : manifest.rows) {
    require(!row.path.empty() && row.line > 1);
    require_positive(row.conditions.radius);
    require_positive(row.conditions.speed);
    require_positive(row.conditions.load);
  }
}

/// Two runs beside the manifest.
const Folder& folder_with_runs() {
  static const Folder scratch;
  for (const char* name : {"a.csv", "b.csv"}) scratch.write(name, "time_s,mu\n");
  return scratch;
}

}  // namespace

void read_manifest_bytes(std::string_view bytes) {
  static const Folder& folder = folder_with_runs();
  folder.write(manifest_name, bytes);
  for (const auto errors : {ManifestErrors::refuse, ManifestErrors::collect}) {
    is_read([&] { require_valid(read_manifest(folder.path(), errors)); });
  }
}

}  // namespace tribofit::fuzz
