#pragma once

#include <string>
#include <vector>

namespace tribofit {

struct FolderTraces {
  std::vector<std::string> paths;  ///< in order of name
  std::string left_out;            ///< tables that --csv wrote there, as a list
};

/// The CSV files of a folder without its manifest. Throws InputError where there are none.
FolderTraces traces_in(const std::string& folder);

}  // namespace tribofit
