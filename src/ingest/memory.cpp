#include "memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

/// The number that a file of the system holds, behind this word where it says several things; "max" is none.
std::optional<double> number_in(const char* path, const std::string& name = {}) {
  std::ifstream in(path);
  std::string word;
  while (word != name && in >> word) continue;
  double value = 0;
  return in >> value ? std::optional(value) : std::nullopt;
}

/// Memory that the system has left for this process [bytes]: what it can free without swapping, within the limits of
/// the process and its control group. Infinite where nothing says how much.
double available_memory() {
  double available = std::numeric_limits<double>::infinity();
  const auto limit = [&](double most, double used) { available = std::min(available, std::max(0.0, most - used)); };
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable:")) limit(1024 * *kilobytes, 0);
  if (const auto of_group = number_in("/sys/fs/cgroup/memory.max"))
    limit(*of_group, number_in("/sys/fs/cgroup/memory.current").value_or(0));
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    limit(static_cast<double>(space.rlim_cur), static_cast<double>(used_memory()));
  return available;
}

}  // namespace

std::uint64_t used_memory() {
  return static_cast<std::uint64_t>(1024 * number_in("/proc/self/status", "VmSize:").value_or(0));
}

void refuse_beyond_memory(double rows, std::size_t columns, const std::string& path) {
  const double bytes = kMemoryOverValues * rows * static_cast<double>(columns) * sizeof(double);
  if (bytes < static_cast<double>(kMemoryNotAsked)) return;
  const double available = available_memory();
  if (bytes <= available) return;
  throw InputError(fmt::format("holds about {} million rows: they take {} GB of memory, and {} GB are free",
                               general(1e-6 * rows, 2), general(1e-9 * bytes, 3), general(1e-9 * available, 3)),
                   "cut the file into parts, keep every other row, or use a machine with more memory", {path, 0, ""});
}

}  // namespace tribofit
