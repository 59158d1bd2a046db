/// Nominal 95 % intervals of effects, where law and effects are known, over the cases of the benchmark.
///
/// TRIBOFIT_COVERAGE_RUNS sets how many cases each effect and size gets (one when it is not set).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "hidden_effects.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace {

using namespace recovery;

/// Why an effect is left out: it is read off the motion and not fitted, or a record at hand leaves a parameter of it
/// open (ageing, load-coupling).
bool is_fitted(const Case& c) {
  static const char* const kLeftOut[] = {"ageing", "load-coupling"};
  return !tribofit::is_kinematic(tribofit::make_effect(c.hidden[0].key)) &&
         std::none_of(std::begin(kLeftOut), std::end(kLeftOut),
                      [&](const char* key) { return c.hidden[0].key == key; });
}

struct Count {
  int covered = 0, asked = 0;
};

TEST(EffectCoverage, NominalIntervalsOfEffectsCoverTheTruth) {
  const char* text = std::getenv("TRIBOFIT_COVERAGE_RUNS");
  PlanOptions plan = {.runs = text != nullptr ? static_cast<std::size_t>(std::max(1, std::atoi(text))) : 1,
                      .pairs = 0,
                      .nothing = 0,
                      .aliens = 0,
                      .unknowable = 0};
  std::vector<Case> cases = plan_cases(plan);
  if (text == nullptr) cases = halved(std::move(cases));
  std::erase_if(cases, [](const Case& c) { return !is_fitted(c); });
  std::vector<std::vector<int>> covered(cases.size());
  tribofit::run_tasks(cases.size(), 0, [&](std::size_t i) {
    const KnownFit known = fit_known(simulate_case(cases[i]));
    const std::size_t first = known.fit.parameters.size() - cases[i].hidden[0].values.size();
    for (const std::size_t k : cases[i].hidden[0].main_parameters) {
      const tribofit::FitParameter& p = known.fit.parameters.at(first + k);
      covered[i].push_back(p.lower95 <= known.truth[first + k] && known.truth[first + k] <= p.upper95 ? 1 : 0);
    }
  });
  std::map<std::string, Count> effects;
  Count all;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const int hit : covered[i]) {
      for (Count* count : {&all, &effects[cases[i].hidden[0].key]}) {
        count->covered += hit;
        ++count->asked;
      }
    }
  }
  for (const auto& [key, count] : effects) {
    std::printf("%-24s %3d of %3d  %5.1f %%\n", key.c_str(), count.covered, count.asked,
                100.0 * count.covered / count.asked);
    // 0.85 with three standard deviations of chance.
    EXPECT_GE(count.covered, 0.85 * count.asked - 3 * std::sqrt(0.85 * 0.15 * count.asked)) << key;
  }
  const double share = static_cast<double>(all.covered) / all.asked;
  std::printf("%-24s %3d of %3d  %5.1f %%\n", "all", all.covered, all.asked, 100 * share);
  // 0.93 with three standard deviations of chance.
  EXPECT_GT(share, 0.93 - 3 * std::sqrt(0.93 * 0.07 / all.asked));
}

}  // namespace
