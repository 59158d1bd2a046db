#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/input_file.hpp"

namespace tribofit {

/// Types of values and properties, by their numbers in the file.
namespace tdms {
inline constexpr std::uint32_t text = 0x20, boolean = 0x21, timestamp = 0x44;

/// Bytes of a value; 0: not of one length, or not known.
std::size_t bytes_of(std::uint32_t type);

/// A value as a number; timestamps in s after `epoch` [s].
double value_at(std::string_view bytes, std::size_t at, std::uint32_t type, bool big_endian, double epoch);
}  // namespace tdms

/// A property of the file, a group or a channel.
struct TdmsProperty {
  std::string name;
  std::string text;  ///< of a text
  double number = 0;
  bool is_text = false;
};

/// Values of a channel that stand in the file at even distances, in chunks that do so too.
struct TdmsPiece {
  std::uint64_t begin = 0;                     ///< byte of the first value
  std::uint64_t count = 0, stride = 0;         ///< values of a chunk, and bytes from one to the next
  std::uint64_t chunks = 1, chunk_stride = 0;  ///< bytes from a chunk to the next
  bool big_endian = false;
};

/// The file (path "/"), a group ("/'a'") or a channel ("/'a'/'b'").
struct TdmsObject {
  std::string path;
  std::vector<std::string> names;  ///< of the group and the channel
  std::uint32_t type = 0;          ///< of the values; 0: none
  std::uint64_t count = 0;         ///< of all values
  std::vector<TdmsPiece> pieces;
  std::vector<TdmsProperty> properties;

  const TdmsProperty* find(std::string_view name) const;
};

/// The objects of a file, in their order, without the values. Throws InputError with the offset for a file that is
/// damaged, holds raw values of DAQmx, or has more objects or pieces than can be kept. A last segment that was not
/// finished, as after a crash of the program that wrote it, is read as far as its chunks are whole (note).
/// Cost: linear in the file's bytes.
std::vector<TdmsObject> read_tdms_objects(const InputFile& file, std::vector<std::string>& notes);

}  // namespace tribofit
