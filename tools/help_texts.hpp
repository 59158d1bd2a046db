#pragma once

#include <span>
#include <string_view>

/// A text of tools/help/, whose first line is its title.
struct HelpText {
  std::string_view topic;  ///< name of the file, which `identify help` takes; at most 13 characters
  std::string_view text;
};

/// Every text, in the order of tools/CMakeLists.txt.
std::span<const HelpText> help_texts();
