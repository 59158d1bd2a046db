#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribofit::fuzz {

/// A thing that is read. read() takes any bytes for its file; they become something valid or an InputError that says
/// what to do. All else ends the process.
struct Target {
  const char* name;
  void (*read)(std::string_view bytes);
};

/// Each has a folder in corpus/.
const std::vector<Target>& targets();

void read_trace_bytes(std::string_view bytes);  ///< of every format
void read_manifest_bytes(std::string_view bytes);
void read_instruments_bytes(std::string_view bytes);
void read_formula_bytes(std::string_view bytes);
void read_session_bytes(std::string_view bytes);
void read_earlier_bytes(std::string_view bytes);
void read_results_bytes(std::string_view bytes);  ///< of one run
void read_campaign_bytes(std::string_view bytes);
void read_map_bytes(std::string_view bytes);  ///< rows of a map that was interrupted

}  // namespace tribofit::fuzz
