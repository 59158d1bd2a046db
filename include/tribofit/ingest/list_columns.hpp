#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// A column of a file, as it is written there.
struct ListedColumn {
  std::string name;   ///< as the file gives it, "#3" where it gives none
  std::string place;  ///< where it stands, if the name does not say
  std::string unit;   ///< from the name or beside it; empty: none
  bool is_text = false;
  std::size_t count = 0;           ///< of its numbers
  double lowest = 0, highest = 0;  ///< of them, as written
  std::string channel;             ///< that it is taken for; empty: none
  std::string request;             ///< what names it in --columns, "Velocity" or "#3"
};

/// What a file holds, before any of it must make sense as a trace.
struct ColumnListing {
  std::string format;  ///< "CSV", "MATLAB", ...
  std::vector<ListedColumn> columns;
  std::vector<std::pair<std::string, std::string>> facts;  ///< names and values stated beside the columns
  std::vector<double> intervals;                           ///< [s] that the file states between values
  std::string selection;  ///< "time=t,mu=COF,v_b=NAME:mm/s": of what was recognised, and what is missing in capitals
  std::vector<std::string> notes;
};

/// Lists what a file holds; `options` as for read_trace. Throws InputError for a file that cannot be read at all.
ColumnListing list_columns(const std::string& path, const ReadOptions& options = {});

}  // namespace tribofit
