#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "numbers.hpp"
#include "style.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// Every run of a campaign in its order, with a result or without.
template <class WithResult, class Missing>
void for_each_run(const ResultReader& results, WithResult&& with_result, Missing&& missing) {
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (const auto result = results.read(k)) {
      with_result(*result);
    } else {
      missing(results.missing(k));
    }
  }
}

/// summary.csv: which columns there are is known when every result has been declared.
class SummarySheet {
 public:
  SummarySheet();
  void declare(const RunResult& result);
  std::string header() const;
  std::string row(const RunResult& result) const;
  std::string row(const MissingRun& run) const;

 private:
  std::string row(const std::map<std::string, std::string>& cells) const;

  std::vector<std::string> columns_, conditions_;  // conditions_: columns of further conditions
  std::map<std::string, bool> known_;
};

/// The table for people.
class ResultTable {
 public:
  explicit ResultTable(const TerminalOptions& options);
  void add(const RunResult& result);
  void add(const MissingRun& run);
  std::string text() const;

 private:
  static constexpr std::size_t kMostRows = 40;

  Style style_;
  Table table_;
  std::size_t rows_ = 0;
};

}  // namespace tribofit
