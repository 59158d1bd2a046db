#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/report/pictures.hpp"
#include "tribofit/report/report.hpp"

/// What is drawn of a report where that was asked for (--report, --figures), on the disc but without names until
/// commit().
class ReportFiles {
 public:
  ReportFiles(const Settings& settings, const tribofit::Report& report);
  void commit();

 private:
  std::optional<tribofit::PictureFiles> pictures_;
  std::optional<tribofit::WholeFile> page_;
};

/// What can be made of one result; each is only called where it was asked for.
struct Outputs {
  std::function<tribofit::Report()> report;  ///< for people
  std::function<std::string()> json;
  std::function<void(const std::string&)> csv = {};  ///< writes tables into the folder given
};

/// Writes what was asked for of one result (--json, --report, --figures, --csv), all of it or none: the others are on
/// the disc before the CSV gets its names, and get their own after it. Then prints the report and what was written,
/// unless --quiet.
void deliver(const Settings& settings, const Outputs& outputs);

/// "wrote FILE (2.1 MB)"; of a folder with the size of what it holds.
std::string written_line(const std::string& path);

/// Whether two names lead to one file.
bool same_file(const std::string& a, const std::string& b);

/// Usage error: an output that would overwrite one of the inputs, or that this build or machine cannot write.
void refuse_overwriting(const Settings& settings, const std::vector<std::string>& inputs);
