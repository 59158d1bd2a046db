#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/ingest/conditions.hpp"

namespace tribofit {

/// A condition of a run that the library gives no meaning to (humidity, lot, lubricant), as written.
struct OtherCondition {
  std::string name, value;
};

/// One run of a campaign and what is known of it beforehand.
struct ManifestRow {
  std::string path;       ///< folder and file
  Conditions conditions;  ///< source "manifest"; what the manifest does not say is not known
  std::optional<int> repeat;
  std::vector<OtherCondition> others;
  std::size_t line = 0;  ///< of the manifest, 1-based
  std::string problem;   ///< why this run cannot be taken as stated; empty: it can (see ManifestErrors::collect)
};

/// The manifest of a folder of runs.
struct Manifest {
  std::string path;
  std::vector<ManifestRow> rows;      ///< in the order of the file, those of a pattern by name
  std::vector<std::string> notes;     ///< what was assumed, for the report
  std::vector<std::string> problems;  ///< of rows that name no run of their own (see ManifestErrors::collect)
};

/// What a defect of a single row does.
enum class ManifestErrors {
  refuse,  ///< the manifest is refused with an InputError
  collect  ///< it is named, in the row's `problem` or in Manifest::problems, and the other rows are taken
};

/// Name of the manifest in a folder of runs.
inline constexpr const char* manifest_name = "manifest.csv";

/// Reads folder/manifest.csv: a header, then one run a row.
///
/// Columns: file (a name relative to the folder, or a pattern with * and ? in its last part), radius, speed, load,
/// repeat; any further column is kept as text. Units stand in the cell ("15mm") or in the header ("radius [mm]",
/// "speed_rpm"); the cell's own wins. An empty cell says nothing. Comma, semicolon (then with decimal comma too) or
/// tab; quotes, BOM and comment lines as in a trace.
/// Throws InputError with file, line and column: no column of files, a file that does not exist, a pattern that none
/// fits, a run listed twice (with the same conditions or with others), a missing or unknown unit (the nearest known one
/// offered), a value that cannot be. Cost: linear in rows, and one listing of the folder for each pattern.
///
/// ManifestErrors::collect takes the rows that are right beside others that are not. A file that does not exist and a
/// cell that cannot be used are the `problem` of their row; so are conditions that contradict an earlier row of the
/// same file, for both. A row listed twice, a pattern that none fits and a row without a file are among
/// Manifest::problems. A header that cannot be used is refused all the same.
Manifest read_manifest(const std::string& folder, ManifestErrors errors = ManifestErrors::refuse);

/// Whether two runs were made under the same conditions, so that one repeats the other: equal radius, speed, load and
/// other conditions, where both say nothing or the same.
bool same_conditions(const ManifestRow& a, const ManifestRow& b);

}  // namespace tribofit
