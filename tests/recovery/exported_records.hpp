#pragma once

/// The hidden records as anybody can have them: CSV files on one side, what was hidden on the other.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hidden_effects.hpp"

namespace recovery {

/// One record of the benchmark, with its truth.
struct ExportedRecord {
  std::string case_name;        ///< says what is hidden, so it goes to the truth alone
  std::string kind;             ///< "stick-slip", "sliding", "points", "spring-slider"
  std::string noise = "white";  ///< or "AR(1) 0.9", "1/f"
  std::string expected;         ///< "named", "silent", "unexplained"
  std::vector<Ingredient> hidden = {};
  tribofit::Law law = tribofit::ExponentialLaw{};
  std::vector<double> friction = {};  ///< parameters of the law [SI]
  double floor_rmse = 0;              ///< what the true law leaves while it slides [1]; 0: not known
  std::vector<std::shared_ptr<const tribofit::Trace>> traces = {};
};

/// How many records.
struct ExportOptions {
  std::size_t singles = 1, pairs = 1, nothing = 12, aliens = 3, of_each_kind = 1;
  bool whole = false;  ///< records as long as those of the benchmark; else half as long where that is enough
  std::uint64_t seed = 1;
};

/// Makes a record when it is asked for.
using RecordMaker = std::function<ExportedRecord()>;

/// All of them, in an order that says nothing of what is hidden.
std::vector<RecordMaker> plan_export(const ExportOptions& options);

/// Writes records and truth into a folder, which must not hold any: records/, truth/, README.md. Throws
/// std::runtime_error where it cannot. done: called after each record.
void export_records(const std::vector<RecordMaker>& records, const std::string& folder, std::uint64_t seed,
                    const std::function<void(std::size_t)>& done);

/// README.md: the task, the files, the answers, the catalogue of names.
std::string export_readme(std::size_t records, std::uint64_t seed);

}  // namespace recovery
