#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/report/csv.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/page.hpp"
#include "tribofit/report/pictures.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/whole_file.hpp"

/// What is drawn of a report (--report, --figures), on the disc but without names until commit(). make: gives the
/// report, and is only called where something was asked for.
class ReportFiles {
 public:
  template <class Make>
  ReportFiles(const Settings& s, Make&& make) {
    if (s.report.empty() && s.figures.empty()) return;
    const tribofit::Report report = make();
    if (!s.figures.empty()) pictures_.emplace(report, s.figures, picture_format(s));
    if (s.report.empty()) return;
    page_.emplace(s.report);
    page_->write(report_page(report));
    page_->finish();
  }
  void commit() {
    if (pictures_) pictures_->commit();
    if (page_) page_->commit();
  }

 private:
  std::optional<tribofit::PictureFiles> pictures_;
  std::optional<tribofit::WholeFile> page_;
};

/// Writes what was asked for of one result (--json, --report, --figures, --csv), all of it or none: the others are on
/// the disc before the CSV gets its names, and get their own after it. shown: how the page says what was run.
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
