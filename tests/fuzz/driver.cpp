// One target for libFuzzer: its name is TRIBOFIT_FUZZ_TARGET.

#include <cstddef>
#include <cstdint>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tribofit::fuzz::TRIBOFIT_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
