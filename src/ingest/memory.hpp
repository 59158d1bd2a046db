#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tribofit {

/// Memory of this process [bytes], that which is not in use among it; 0 where nothing says how much.
std::uint64_t used_memory();

/// Throws InputError where so many rows of so many columns would take more memory than there is: the system would swap,
/// or end the process, before they are read.
void refuse_beyond_memory(double rows, std::size_t columns, const std::string& path);

}  // namespace tribofit
