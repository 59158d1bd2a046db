#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "recording.hpp"

namespace tribofit {

/// Rows in which a used column holds no finite number of a usable size, in their order: few enough and isolated, so
/// that they may be left out (limits in gaps.cpp). Throws InputError, for the first of them, where they are not.
std::vector<std::size_t> find_gappy_rows(const RawTable& table, const std::vector<Column>& used,
                                         const FileRecord& recording);

/// Rows whose time is that of the row before: a machine writes one where it changes its sampling.
std::vector<std::size_t> find_repeated_rows(const FileRecord& recording);

/// Excludes rows from the channels, lines and stated steps, and warns with their number and places. The time must be
/// known: what remains has gaps. what: the rows, as "with a cell that is not a number".
void exclude(const std::vector<std::size_t>& rows, std::string_view what, FileRecord& recording);

}  // namespace tribofit
