#pragma once

#include <filesystem>

namespace tribofit::fuzz {

/// Writes a small file of each format into a folder, which is made: what the reader of traces is fuzzed from.
void write_seeds(const std::filesystem::path& folder);

}  // namespace tribofit::fuzz
