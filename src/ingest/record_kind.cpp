#include "tribofit/ingest/record_kind.hpp"

#include <algorithm>
#include <array>

namespace tribofit {

namespace {

// In the order of RecordKind.
constexpr std::array<std::string_view, 8> kNames = {"stick-slip",  "sliding",    "points",         "spring-slider",
                                                    "motion-only", "force-only", "velocity-steps", "slide-hold-slide"};

}  // namespace

std::string_view to_string(RecordKind kind) {
  return kNames.at(static_cast<std::size_t>(kind));
}

std::optional<RecordKind> find_record_kind(std::string_view name) {
  const auto at = std::find(kNames.begin(), kNames.end(), name);
  if (at == kNames.end()) return std::nullopt;
  return static_cast<RecordKind>(at - kNames.begin());
}

std::vector<std::string> record_kind_names() {
  return {kNames.begin(), kNames.end()};
}

}  // namespace tribofit
