#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tribofit/report/chart.hpp"

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp
struct Identification;
struct RigIdentification;
struct RunPlan;  // study/plan.hpp
struct TwinIdentification;

/// A report as data: title, what it says first, sections of texts, tables and charts. report_of() makes it of a result,
/// once; render_terminal() prints it, report_page() makes one HTML file of it, PictureFiles a file of each chart.

/// Where a part of a report is shown. Charts and animations are for pages, whatever is said of them.
enum class Medium { any, page, terminal };

struct ReportText {
  enum class Kind {
    plain,
    soft,
    warning,
    problem,
    command,
    heading,
    item,
    title,  ///< the first line of a terminal, as those below
    name,   ///< of what is said in details below it
    detail,
    drawing  ///< of characters
  };
  std::string text = {};
  Kind kind = Kind::plain;
};

/// Names and values, as people read them: {"radius", "15 mm (command line)"}.
using Facts = std::vector<std::pair<std::string, std::string>>;

struct ReportFacts {
  Facts facts = {};
};

/// A column of a table: what stands above it and how it is set.
struct ReportColumn {
  std::string name = {};   ///< with its unit: "slope [mm/s]"
  bool number = false;     ///< set to the right
  int detail = 0;          ///< where room is short, columns of the highest detail go first; those of 0 stay
  std::string brief = {};  ///< the name where there is little room; empty: the same
};

/// A table, described once for the terminal, which shows the first rows of a long one, and the page. Columns are named
/// from left to right: ReportTable("Cells").text({"regime"}).numbers({"cells"}).
struct ReportTable {
  /// all_rows: the file that has them, where only the first are shown.
  explicit ReportTable(std::string title = {}, std::string all_rows = {})
      : caption(std::move(title)), file(std::move(all_rows)) {}
  ReportTable& text(std::initializer_list<std::string> names, int detail = 0) { return add(names, false, detail); }
  ReportTable& numbers(std::initializer_list<std::string> names, int detail = 0) { return add(names, true, detail); }
  /// A column behind those that are there, a cell a row; none where all cells are empty.
  void add(ReportColumn column, std::vector<std::string> cells);

  /// What a terminal draws into an empty column: a bar a row, lighter up to `pale`.
  struct Bars {
    std::size_t column = 0;
    std::vector<double> values = {};
    double full = 0, pale = 0;
    std::size_t longest = 40, shortest = 10;     ///< columns of a terminal
    std::string pale_name = {}, full_name = {};  ///< what the lighter part stands for, and the other
  };

  std::string caption, file;
  std::vector<ReportColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  Bars bars = {};
  bool folded = false;  ///< opened by a click; a terminal leaves it out

 private:
  ReportTable& add(std::initializer_list<std::string> names, bool number, int detail) {
    for (const std::string& name : names) columns.push_back({name, number, detail, {}});
    return *this;
  }
};

/// A block on its disc in motion, each as long as one turn of its loop.
struct Animation {
  struct Block {
    std::string name;                                            ///< "measured", "simulated"
    std::vector<double> time, displacement, velocity, friction;  ///< [s], [mm], [mm/s], [1 or N]
    std::vector<std::uint8_t> sticks;
  };
  std::string id = {}, title = {}, note = {};
  double disc_velocity = 0;  ///< omega r [mm/s]
  std::vector<Block> blocks = {};
};

using AnyItem = std::variant<ReportText, ReportFacts, ReportTable, Chart, Animation>;
struct ReportItem : AnyItem {
  using AnyItem::AnyItem;
  Medium medium = Medium::any;
};

struct ReportSection {
  std::string id = {}, title = {};
  std::vector<ReportItem> items = {};
  Medium medium = Medium::any;

  /// Adds an item; empty texts, facts and tables, lines without points and charts that show nothing are left out.
  void add(ReportItem item, Medium where = Medium::any);
  void add(std::vector<Chart> charts);
  void text(ReportText::Kind kind, std::string text, Medium where = Medium::any) {
    add(ReportText{std::move(text), kind}, where);
  }
  void plain(std::string words, Medium where = Medium::any) { text(ReportText::Kind::plain, std::move(words), where); }
  void soft(std::string words) { text(ReportText::Kind::soft, std::move(words)); }
  void warning(std::string words) { text(ReportText::Kind::warning, std::move(words)); }
  void command(std::string words, Medium where = Medium::any) {
    text(ReportText::Kind::command, std::move(words), where);
  }
  void heading(std::string words, Medium where = Medium::any) {
    text(ReportText::Kind::heading, std::move(words), where);
  }
  void item(std::string words) { text(ReportText::Kind::item, std::move(words)); }
};

/// A command that exists, with the user's own options, and what it is for.
struct Suggestion {
  std::string reason;  ///< "to ..."
  std::string command;
};

struct Report {
  std::string kind = {};  ///< "friction law", "diagnosis", "campaign", "study"
  std::string title = {}, subtitle = {};
  std::string lead = {};  ///< the verdict: what a reader must know
  std::vector<std::string> warnings = {};
  Facts facts = {};  ///< at the head of a page
  std::vector<ReportSection> sections = {};
  std::vector<Suggestion> next = {};  ///< at the end of a text: what to do next, then ways to look at the same result

  /// Adds those that hold anything.
  void add(std::vector<ReportSection> more);
  /// Drops what is shown elsewhere only.
  void keep_for(Medium medium);
};

/// What a report is made with, and its commands of.
struct ReportOptions {
  std::vector<std::string> arguments = {};  ///< the user's own options without traces and outputs
  std::vector<std::string> inputs = {};     ///< traces and folders as the user named them; empty: the path of the trace
  bool instruments_declared = false;        ///< an instruments file was given
  bool csv_written = false;                 ///< the CSV folder of this result exists already
  bool report_written = false;              ///< and its page
  const ReportSection* cycles = nullptr;    ///< cycles_section() of the trace, where that was drawn before
  int threads = 1;                          ///< that draw a trace side by side; 0: as many as there are
  bool charts = true;                       ///< and animations, which cost more than all else
  std::vector<std::string> shared_arguments = {};  ///< of a study: the options that those of other kinds have, too

  /// The inputs, or the path of a result where the user named none.
  std::vector<std::string> inputs_or(const std::string& path) const {
    return inputs.empty() ? std::vector{path} : inputs;
  }
};

/// A trace: three cycles of friction and velocity beside the laws, friction over v_r with both branches, parameters,
/// relative errors ([D] Eq 5), measures of each cycle and the spectrum. Cost: linear in samples.
Report report_of(const Identification& result, const ReportOptions& options = {});
/// Its section that no model changes: measures of each cycle, the spectrum, the whole record.
ReportSection cycles_section(const Identification& result);

/// A diagnosis: the same beside the first and the final model, with the ladder of errors, where the law fails and what
/// became of each effect. Of many traces the first eight are drawn, all are listed.
Report report_of(const DiagnosedTraces& result, const ReportOptions& options = {});

/// A rig: mass, damping and stiffness with their intervals, the balance behind them, and the record.
Report report_of(const RigIdentification& result, const ReportOptions& options = {});

/// A twin: measures in standard errors, three cycles of friction and velocity measured and simulated, the portraits,
/// and the block on its disc, measured and simulated side by side.
Report report_of(const TwinIdentification& result, const ReportOptions& options = {});

/// What a person reads of a plan: what is open and how likely each answer is so far; the experiments with their
/// minutes and the probability that each names the effect; what each model predicts to be seen in them; where nothing
/// settles it, that; and the command to type afterwards.
ReportSection plan_section(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options = {});
/// The plan; on a page the report of the diagnosis behind it, too.
Report plan_report(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options = {});

/// Whether this build holds the page: it is left out where npm was not found when the build was configured.
bool has_report_page();

/// A report as one HTML file that opens in any browser without a network: charts to zoom and save, tables, what was
/// run.
///
/// Less than 4 MB for any trace or diagnosis: what is drawn is reduced to the extremes of each stretch, so that no peak
/// is lost. Nothing in the file is executed but its own scripts (Content-Security-Policy), whatever names the input
/// has. Throws InputError where has_report_page() is false.
std::string report_page(const Report& report);

}  // namespace tribofit
