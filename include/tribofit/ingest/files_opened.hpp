#pragma once

#include <cstddef>

namespace tribofit {

/// How many times this process has opened an input file so far (traces, manifests, instruments files): what tests ask
/// that hold a command to read its trace once. A file that is opened twice counts twice.
std::size_t files_opened() noexcept;

}  // namespace tribofit
