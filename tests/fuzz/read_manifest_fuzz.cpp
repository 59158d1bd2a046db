// Any bytes are read as a manifest, row by row, or refused with an InputError that says what to do.

#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/manifest.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void require_positive(const tribofit::Condition& condition) {
  require(!condition.known() || (condition.value > 0 && condition.source == "manifest"));
}

void require_valid(const tribofit::Manifest& manifest) {
  require(!manifest.rows.empty() || !manifest.problems.empty());
  for (const tribofit::ManifestRow& row : manifest.rows) {
    require(!row.path.empty() && row.line > 1);
    require_positive(row.conditions.radius);
    require_positive(row.conditions.speed);
    require_positive(row.conditions.load);
  }
}

/// A folder with two runs beside the manifest.
std::filesystem::path make_folder() {
  const auto folder = std::filesystem::temp_directory_path() / ("tribofit-fuzz-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  for (const char* name : {"a.csv", "b.csv"}) std::ofstream(folder / name) << "time_s,mu\n";
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = make_folder();
  std::ofstream(folder / tribofit::manifest_name, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  for (const auto errors : {tribofit::ManifestErrors::refuse, tribofit::ManifestErrors::collect}) {
    try {
      require_valid(tribofit::read_manifest(folder.string(), errors));
    } catch (const tribofit::InputError& error) {
      require(!error.problem().empty() && !error.advice().empty());
    }
  }
  return 0;
}
