#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tribofit {

/// The bytes of a regular file of up to `most` bytes. Throws InputError for one that is larger or cannot be opened, for
/// a folder, and for what might never end: a pipe, a device. `advice`: what to name instead.
std::string text_of_file(const std::string& path, std::uint64_t most, const std::string& advice);

/// How many times this process has opened an input file so far (traces, manifests, instruments files): what tests ask
/// that hold a command to read its trace once. A file that is opened twice counts twice.
std::size_t files_opened() noexcept;

}  // namespace tribofit
