#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tribofit/report/chart.hpp"

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp
struct Identification;

/// A report as data: title, what it says first, sections of texts, tables and charts. report_page() makes one HTML file
/// of it, write_pictures() a file of each chart. report_of() makes it of a result.

struct ReportText {
  enum class Kind { plain, soft, warning, command, heading, item };
  std::string text = {};
  Kind kind = Kind::plain;
};

struct ReportTable {
  std::string caption = {};
  std::vector<std::string> header = {};
  std::vector<std::vector<std::string>> rows = {};
  std::vector<std::size_t> numeric = {};  ///< columns set to the right
  bool folded = false;                    ///< opened by a click
};

/// A block on its disc in motion, each as long as one turn of its loop.
struct Animation {
  struct Block {
    std::string name;                                  ///< "measured", "simulated"
    std::vector<double> time, displacement, friction;  ///< [s], [mm], [1 or N]; the loop begins anew at its end
    std::vector<bool> sticks;
  };
  std::string id = {}, title = {}, note = {};
  double disc_velocity = 0;  ///< omega r [mm/s]
  std::vector<Block> blocks = {};
};

using ReportItem = std::variant<ReportText, ReportTable, Chart, Animation>;

struct ReportSection {
  std::string id = {}, title = {};
  std::vector<ReportItem> items = {};
};

struct Report {
  std::string kind = {};  ///< "friction law", "diagnosis", "campaign", "study"
  std::string title = {}, subtitle = {};
  std::string lead = {};  ///< the verdict: what a reader must know
  std::vector<std::string> warnings = {};
  std::vector<std::pair<std::string, std::string>> facts = {};
  std::vector<ReportSection> sections = {};
};

struct ReportOptions {
  std::vector<std::string> arguments =
      {};                                ///< the user's own options without traces and outputs, shown with the command
  std::vector<std::string> inputs = {};  ///< traces and folders as the user named them; empty: the path of the trace
  bool instruments_declared = false;     ///< an instruments file was given
};

/// A trace: three cycles of friction and velocity beside the laws, friction over v_r with both branches, parameters,
/// relative errors ([D] Eq 5), measures of each cycle and the spectrum. Cost: linear in samples.
Report report_of(const Identification& result, const ReportOptions& options = {});

/// A diagnosis: the same beside the first and the final model, with the ladder of errors, where the law fails and what
/// became of each effect. Of many traces the first eight are drawn, all are listed.
Report report_of(const DiagnosedTraces& result, const ReportOptions& options = {});

}  // namespace tribofit
