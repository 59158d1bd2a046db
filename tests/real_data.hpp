#pragma once

#include <cstdlib>
#include <filesystem>

/// A file or folder of the measured records, which are not in the repository: in the folder that TRIBOFIT_SHARED_DIR
/// names, or in "shared" beside the repository. Tests skip where it is absent.
inline std::filesystem::path real_data(const std::filesystem::path& name) {
  const char* folder = std::getenv("TRIBOFIT_SHARED_DIR");
  return (folder != nullptr ? std::filesystem::path(folder)
                            : std::filesystem::path(TRIBOFIT_SOURCE_DIR).parent_path() / "shared") /
         name;
}
