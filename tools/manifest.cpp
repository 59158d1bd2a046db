#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "tribofit/campaign/names.hpp"
#include "tribofit/ingest/manifest.hpp"
#include "tribofit/output/whole_file.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

struct Wanted {
  std::string folder, pattern, out;
  bool force = false;
};

void write_draft(const Wanted& wanted) {
  std::optional<NamePattern> pattern;
  if (!wanted.pattern.empty()) pattern.emplace(wanted.pattern);
  std::error_code ignored;
  if (!wanted.out.empty() && !wanted.force && std::filesystem::exists(wanted.out, ignored)) {
    throw UsageError(wanted.out + " exists; --force overwrites it");
  }
  const ManifestDraft draft = draft_manifest(wanted.folder, pattern);
  if (wanted.out.empty()) {
    print(draft.text);
    return;
  }
  write_whole(wanted.out, draft.text);
  print(fmt::format("{}: {} runs, {} with a radius\n\nNext, when it is right:\n  identify {}\n", wanted.out, draft.runs,
                    draft.complete, shell_quoted(wanted.folder)));
}

}  // namespace

void add_manifest(const Command& app) {
  const auto wanted = std::make_shared<Wanted>();
  const Command verb =
      app.add_verb("manifest", "Draft the manifest.csv of a folder of runs from what it finds",
                   "Conditions come from the names of the files (r15mm, 4rpm, 50N, 60degC, run03, _1; or as --pattern "
                   "says) and from\n"
                   "lines above the table (\"Radius: 15 mm\"). What is not found is left empty.\n\n"
                   "Examples:\n"
                   "  identify manifest runs/\n"
                   "  identify manifest runs/ --pattern 'r{radius}mm_{humidity}_{repeat}.csv' --out runs/manifest.csv");
  verb.add_option("FOLDER", wanted->folder, "Folder of traces (CSV)").required();
  verb.add_option("--pattern", wanted->pattern, "How the files are named: 'r{radius}mm_{repeat}.csv'");
  verb.add_option("--out", wanted->out, "Write it here (default: standard output)");
  verb.add_flag("--force", wanted->force, "Overwrite the file that is there");
  verb.on_run([wanted, verb] { write_draft(*wanted); });
}
