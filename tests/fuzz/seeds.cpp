#include "seeds.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "../ingest/record_files.hpp"

namespace tribofit::fuzz {

namespace files = record_files;

namespace {

files::Columns record() {
  files::Columns columns = {{"time", "s", {}}, {"mu", "1", {}}, {"v_b", "mm/s", {}}, {"Fn", "N", {}}};
  for (int i = 0; i < 12; ++i) {
    const std::array<double, 4> row = {5e-5 * i, 0.3 + 0.01 * std::sin(i), 6 + std::cos(i), 50};
    for (std::size_t k = 0; k < row.size(); ++k) columns[k].values.push_back(row[k]);
  }
  return columns;
}

}  // namespace

void write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  const files::Columns columns = record();
  write("comma.csv", files::text_of(columns, ','));
  write("blanks.txt", files::text_of(columns, ' '));
  write("cut-off.csv", files::text_of(columns, ';') + "1;2;3;4;5");
  write("v5.mat", files::mat5_of(columns));
  write("v5-packed.mat", files::mat5_of(columns, false, true));
  write("v5-big-endian.mat", files::mat5_of(columns, true));
  files::write_mat73((folder / "v73.mat").string(), columns);
  write("uneven.uff", files::uff_of(columns));
  write("even.uff", files::uff_of(columns, 5e-5));
  write("binary.uff", files::uff_binary_of(columns));
  write("binary-big-endian.uff", files::uff_binary_of(columns, 5e-5, true));
  write("plain.tdms", files::tdms_of(columns));
  write("big-endian.tdms", files::tdms_of(columns, true));
  write("interleaved.tdms", files::tdms_of(columns, false, true));
}

}  // namespace tribofit::fuzz
