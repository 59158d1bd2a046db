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

/// Writes what was asked for of one result (--json, --report, --csv), all of it or none: JSON and page are on the disc
/// before the CSV gets its names, and get their own after it. shown: how the page says what was run.
template <class Result>
void write_results(const Settings& s, const Result& result, const std::vector<std::string>& arguments,
                   const tribofit::ReportOptions& shown) {
  std::optional<tribofit::WholeFile> json, page;
  if (!s.json.empty()) {
    json.emplace(s.json == "-" ? "/dev/stdout" : s.json);
    json->write(to_json(result, {arguments}));
    json->finish();
  }
  if (!s.report.empty()) {
    page.emplace(s.report);
    page->write(report_page(report_of(result, shown)));
    page->finish();
  }
  if (!s.csv.empty()) write_csv_folder(s.csv, result);
  if (page) page->commit();
  if (json) json->commit();
}
