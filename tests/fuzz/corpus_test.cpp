// The corpus is read without a fuzzer: as it is, cut off, and with bytes changed. Whatever ends the process fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "scratch.hpp"
#include "seeds.hpp"
#include "targets.hpp"

namespace tribofit::fuzz {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> corpus_in(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> out;
  for (const fs::path& path : paths) out.push_back(bytes_of(path));
  return out;
}

std::string garbled(std::string bytes, std::mt19937& random) {
  constexpr std::string_view kTelling = "0,;.-\n\r\t\"{}[]:e%=\\ \xff";
  for (int k = 0; k < 3 && !bytes.empty(); ++k) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 4) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.insert(at, 1, kTelling[random() % kTelling.size()]);
        break;
      case 2:
        bytes.erase(at, 1 + random() % 8);
        break;
      default:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 40));
    }
  }
  return bytes;
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefused) {
  const auto& [name, read] = GetParam();
  std::vector<std::string> seeds = corpus_in(fs::path(TRIBOFIT_SOURCE_DIR) / "tests/fuzz/corpus" / name);
  ASSERT_FALSE(seeds.empty());
  if (std::string_view(name) == "trace") {
    const Folder folder;
    write_seeds(folder.path());
    for (std::string& seed : corpus_in(folder.path())) seeds.push_back(std::move(seed));
  }
  std::mt19937 random(1);
  for (const std::string& seed : seeds) {
    read(seed);
    for (int k = 0; k < 20; ++k) {
      read(seed.substr(0, random() % (seed.size() + 1)));
      read(garbled(seed, random));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(targets()),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace tribofit::fuzz
