#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/report/csv.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/page.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/whole_file.hpp"

/// What is drawn of a report (--report), on the disc but without a name until commit(). make: gives the report, and is
/// only called where something was asked for.
class ReportFiles {
 public:
  template <class Make>
  ReportFiles(const Settings& s, Make&& make) {
    if (s.report.empty()) return;
    const tribofit::Report report = make();
    page_.emplace(s.report);
    page_->write(report_page(report));
    page_->finish();
  }
  void commit() {
    if (page_) page_->commit();
  }

 private:
  std::optional<tribofit::WholeFile> page_;
};

/// Writes what was asked for of one result (--json, --report, --csv), all of it or none: JSON and page are on the disc
/// before the CSV gets its names, and get their own after it. shown: how the page says what was run.
template <class Result>
void write_results(const Settings& s, const Result& result, const std::vector<std::string>& arguments,
                   const tribofit::ReportOptions& shown) {
  std::optional<tribofit::WholeFile> json;
  if (!s.json.empty()) {
    json.emplace(s.json == "-" ? "/dev/stdout" : s.json);
    json->write(to_json(result, {arguments}));
    json->finish();
  }
  ReportFiles drawn(s, [&] { return report_of(result, shown); });
  if (!s.csv.empty()) write_csv_folder(s.csv, result);
  drawn.commit();
  if (json) json->commit();
}
