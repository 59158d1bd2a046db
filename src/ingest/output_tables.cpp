#include "tribofit/ingest/output_tables.hpp"

#include <algorithm>
#include <filesystem>

#include "input_file.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

bool is_output_table(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const auto known = std::find_if(output_tables.begin(), output_tables.end(),
                                  [&](const OutputTable& file) { return file.name == name; });
  if (known == output_tables.end()) return false;
  std::string header(known->header.size(), '\0');
  try {
    header.resize(InputFile(path).read(0, header));
  } catch (const InputError&) {
    return false;
  }
  return header == known->header;
}

}  // namespace tribofit
