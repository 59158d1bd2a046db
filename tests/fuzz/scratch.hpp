#pragma once

#include <cstdlib>

#include "../folder.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit::fuzz {

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Whether something was read; an InputError must say what is wrong and what to do.
template <class Read>
bool is_read(Read&& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    require(!error.problem().empty() && !error.advice().empty());
    return false;
  }
}

}  // namespace tribofit::fuzz
