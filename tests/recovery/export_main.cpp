/// Writes hidden records for others to solve: records, and the truth kept apart.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "exported_records.hpp"

int main(int argc, char** argv) {
  recovery::ExportOptions options;
  std::string folder;
  CLI::App app("Writes hidden records and, apart from them, what is hidden");
  app.add_option("folder", folder, "that is to hold them")->required();
  app.add_option("--singles", options.singles, "records of each effect")->capture_default_str();
  app.add_option("--pairs", options.pairs, "records of each pair of effects")->capture_default_str();
  app.add_option("--nothing", options.nothing, "records with nothing hidden, beside those of each kind")
      ->capture_default_str();
  app.add_option("--aliens", options.aliens, "records of each effect in no catalogue")->capture_default_str();
  app.add_option("--of-each-kind", options.of_each_kind,
                 "empty records of each kind of sliding, rig and noise; twice as many with an effect")
      ->capture_default_str();
  app.add_flag("--whole", options.whole, "records of full length");
  app.add_option("--seed", options.seed, "of everything")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const auto records = recovery::plan_export(options);
    recovery::export_records(records, folder, options.seed, [&](std::size_t done) {
      fmt::print(stderr, "\r{}/{}{}", done, records.size(), done == records.size() ? "\n" : "");
    });
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "\nexport-benchmark: {}\n", e.what());
    return 2;
  }
}
