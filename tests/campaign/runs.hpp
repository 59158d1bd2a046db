#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "command.hpp"

/// Short simulated runs (0.1 MB each), each made once.
inline const std::string& short_trace(int seed) {
  static std::map<int, std::string> made;
  std::string& text = made[seed];
  if (text.empty()) {
    const Workshop shop;
    shop.identify(
        "simulate --radius 15mm --speed 4rpm --duration 4s --rate 1kHz --noise-mu 0.003 --noise-v 0.02mm/s "
        "--scatter 0.004 --seed " +
        std::to_string(seed) + " --out t.csv --quiet");
    text = contents(shop / "t.csv");
  }
  return text;
}

/// A folder "runs" with a1.csv ... and a manifest of two radii.
inline void make_runs(const Workshop& shop, int count) {
  std::filesystem::create_directory(shop / "runs");
  std::string manifest = "file,radius,load,repeat,lot\n";
  for (int k = 1; k <= count; ++k) {
    const std::string name = "a" + std::to_string(k) + ".csv";
    shop.write("runs/" + name, short_trace(k));
    manifest += name + (k % 2 == 0 ? ",15mm,50N," : ",15.1mm,50N,") + std::to_string(k) + ",L\n";
  }
  shop.write("runs/manifest.csv", manifest);
}

/// Every file of a folder and the folders in it with its bytes.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) files[entry.path().lexically_relative(folder).string()] = contents(entry.path());
  }
  return files;
}
