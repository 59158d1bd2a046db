#pragma once

#include <string>
#include <vector>

namespace tribofit {

/// The CSV files of a folder in order of name, without its manifest. Throws InputError where there are none.
std::vector<std::string> traces_in(const std::string& folder);

}  // namespace tribofit
