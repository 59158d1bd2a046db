#include "memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The number that a small file of the system holds; "max" and what is not there are no limit.
std::uint64_t number_in(const char* path) {
  std::uint64_t value = 0;
  return std::ifstream(path) >> value ? value : kUnlimited;
}

std::uint64_t less(std::uint64_t limit, std::uint64_t used) {
  return limit == kUnlimited ? limit : limit - std::min(limit, used);
}

/// What a line of a file of the system says after its name [kB]; 0 where there is none.
std::uint64_t kilobytes_of(const char* path, const std::string& name) {
  std::ifstream in(path);
  std::string word;
  std::uint64_t value = 0;
  while (in >> word) {
    if (word == name && in >> value) return value;
  }
  return 0;
}

}  // namespace

std::uint64_t used_memory() {
  return 1024 * kilobytes_of("/proc/self/status", "VmSize:");
}

std::uint64_t available_memory() {
  const std::uint64_t kilobytes = kilobytes_of("/proc/meminfo", "MemAvailable:");
  std::uint64_t available = kilobytes > 0 ? 1024 * kilobytes : kUnlimited;
  const std::uint64_t group = number_in("/sys/fs/cgroup/memory.max");
  if (group != kUnlimited) available = std::min(available, less(group, number_in("/sys/fs/cgroup/memory.current")));
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    available = std::min(available, less(limit.rlim_cur, used_memory()));
  }
  return available;
}

void refuse_beyond_memory(double rows, std::size_t columns, const std::string& path) {
  const double bytes = kMemoryOverValues * rows * static_cast<double>(columns) * sizeof(double);
  if (bytes < static_cast<double>(kMemoryNotAsked)) return;
  const auto available = static_cast<double>(available_memory());
  if (bytes <= available) return;
  throw InputError(fmt::format("holds about {} million rows: they take {} GB of memory, and {} GB are free",
                               general(1e-6 * rows, 2), general(1e-9 * bytes, 3), general(1e-9 * available, 3)),
                   "cut the file into parts, keep every other row, or use a machine with more memory", {path, 0, ""});
}

}  // namespace tribofit
