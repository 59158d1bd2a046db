#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/input_file.hpp"

namespace tribofit {

/// Types of values and properties, by their numbers in the file.
namespace tdms {
inline constexpr std::uint32_t text = 0x20, boolean = 0x21, timestamp = 0x44;
}  // namespace tdms

/// A property of the file, a group or a channel.
struct TdmsProperty {
  std::string name;
  std::string text;  ///< of a text
  double number = 0;
  bool is_text = false;
};

/// The file (path "/"), a group ("/'a'") or a channel ("/'a'/'b'").
struct TdmsObject {
  std::string path;
  std::vector<std::string> names;  ///< of the group and the channel
  std::size_t number = 0;          ///< among the objects of the file
  std::uint32_t type = 0;          ///< of the values; 0: none
  std::uint64_t count = 0;         ///< of all values
  std::vector<TdmsProperty> properties;

  const TdmsProperty* find(std::string_view name) const;
};

/// The objects of a file, in their order, without the values. Throws InputError with the offset for a file that is
/// damaged, holds raw values of DAQmx, or has more objects than can be kept. A last segment that was not finished, as
/// after a crash of the program that wrote it, is read as far as its chunks are whole (note).
/// Cost: linear in the file's bytes.
std::vector<TdmsObject> read_tdms_objects(const InputFile& file, std::vector<std::string>& notes);

/// Appends the values of objects, by their numbers, which must hold numbers or times: these in s after the second in
/// which the first of them begins, or they would lose digits. Goes through the file again.
void read_tdms_values(const InputFile& file, const std::map<std::size_t, std::vector<double>*>& wanted);

}  // namespace tribofit
