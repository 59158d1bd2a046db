#pragma once

#include <cstddef>
#include <map>
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
  bool is_likely = false;          ///< `channel` is only what its name or unit suggests: it must be named
  std::string request;             ///< what names it in ReadOptions::columns, "Velocity" or "#3"
};

/// What a file holds, before any of it must make sense as a trace.
struct ColumnListing {
  std::string format;  ///< "CSV", "MATLAB", ...
  std::vector<ListedColumn> columns;
  std::vector<std::pair<std::string, std::string>> facts;  ///< names and values stated beside the columns
  std::vector<double> intervals;                           ///< [s] that the file states between values
  /// The columns that make a trace, by channel, as ReadOptions::columns takes them.
  std::map<std::string, std::string> selected;
  std::string selection;             ///< the same in one line: "time=t,mu=COF,v_b=Velocity:mm/s"
  std::vector<std::string> assumed;  ///< units in it which the file does not state: "mm/s of v_b"
  std::vector<std::string> missing;  ///< what a trace needs and no column was found for: "friction", "velocity"
  std::vector<std::string> notes;
};

/// Lists what a file holds; `options` as for read_trace. Throws InputError for a file that cannot be read at all.
ColumnListing list_columns(const std::string& path, const ReadOptions& options = {});

/// A listing, and whether the columns that it selects make a trace.
struct TriedColumns {
  ColumnListing listing;
  std::string obstacle;       ///< what keeps them from it; empty where nothing does, or where some are missing
  bool needs_radius = false;  ///< of the contact, which the file does not state
};
/// The same, and tries the columns. Cost: one reading of the file.
TriedColumns try_columns(const std::string& path, const ReadOptions& options = {});

}  // namespace tribofit
