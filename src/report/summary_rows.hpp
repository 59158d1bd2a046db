#pragma once

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Every run of a campaign in its order, with a result or without.
template <class WithResult, class Missing>
void for_each_run(const CampaignResults& results, WithResult&& with_result, Missing&& missing) {
  auto gap = results.missing.begin();
  for (const RunResult& result : results.runs) {
    for (; gap != results.missing.end() && gap->position < result.position; ++gap) missing(*gap);
    with_result(result);
  }
  for (; gap != results.missing.end(); ++gap) missing(*gap);
}

}  // namespace tribofit
