#include "tribofit/ingest/output_tables.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace tribofit {

bool is_output_table(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const auto known = std::find_if(output_tables.begin(), output_tables.end(),
                                  [&](const OutputTable& file) { return file.name == name; });
  if (known == output_tables.end()) return false;
  std::ifstream in(path, std::ios::binary);
  std::string header(known->header.size(), '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  return in && header == known->header;
}

}  // namespace tribofit
