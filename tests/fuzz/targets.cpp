#include "targets.hpp"

namespace tribofit::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"trace", read_trace_bytes},     {"manifest", read_manifest_bytes}, {"instruments", read_instruments_bytes},
      {"formula", read_formula_bytes}, {"session", read_session_bytes},   {"earlier", read_earlier_bytes},
      {"results", read_results_bytes}, {"campaign", read_campaign_bytes}, {"map", read_map_bytes}};
  return all;
}

}  // namespace tribofit::fuzz
