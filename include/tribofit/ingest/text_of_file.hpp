#pragma once

#include <cstdint>
#include <string>

namespace tribofit {

/// The bytes of a regular file of up to `most` bytes. Throws InputError for one that is larger or cannot be opened, for
/// a folder, and for what might never end: a pipe, a device. `advice`: what to name instead.
std::string text_of_file(const std::string& path, std::uint64_t most, const std::string& advice);

}  // namespace tribofit
