#include "tribofit/campaign/pooled.hpp"

namespace tribofit {

Pooled pool_campaign(std::span<const RunResult> runs, const Sharing& sharing) {
  Pooled out;
  out.groups = pool_repeats(runs);
  if (!sharing.common.empty()) out.shared = fit_shared(runs, sharing);
  out.trends = find_trends(runs);
  return out;
}

}  // namespace tribofit
