#pragma once

#include <cstddef>
#include <vector>

#include "recording.hpp"

namespace tribofit {

/// Rows in which a used column holds no finite number of a usable size, in their order: few enough and isolated, so
/// that they may be left out (limits in gaps.cpp). Throws InputError, for the first of them, where they are not.
std::vector<std::size_t> find_gappy_rows(const RawTable& table, const std::vector<Column>& used,
                                         const FileRecord& recording);

/// Excludes rows from the channels, lines and stated steps, and warns with their number and places. The time must be
/// known: what remains has gaps.
void exclude(const std::vector<std::size_t>& rows, FileRecord& recording);

}  // namespace tribofit
