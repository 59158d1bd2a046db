/// Simulated twins of the tests of [D] through every stage before the report, against the truth they were made with.
///
/// TRIBOFIT_RECOVERY_RUNS sets how many twins a cell of the coverage table gets (scripts/recovery runs the full count).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tribofit/execution/parallel.hpp"
#include "twin.hpp"

namespace {

using namespace tribofit;
using recovery::fit_twin;
using recovery::make_twin;
using recovery::Twin;
using recovery::TwinOptions;

constexpr double kRadii[] = {0.009, 0.012, 0.015, 0.018};
constexpr Law kLaws[] = {Law(ExponentialLaw{}), Law(FractionalLaw{})};

Law other(Law law) {
  return law == Law(ExponentialLaw{}) ? Law(FractionalLaw{}) : Law(ExponentialLaw{});
}

/// Twins side by side.
std::vector<Twin> make_twins(const std::vector<TwinOptions>& options) {
  std::vector<Twin> twins(options.size());
  run_tasks(twins.size(), 0, [&](std::size_t i) { twins[i] = make_twin(options[i]); });
  return twins;
}

/// The eight twins: each law at each radius. Prints value, error and the bias of per-cycle extremes beside it.
TEST(Twins, JointFitReturnsTheTruthAndTheGeneratingLawWins) {
  std::printf("%-12s %-7s %-22s %-22s %-26s  %s\n", "law", "radius", "mu_s (joint, publ.)", "mu_k (joint, publ.)",
              "decay (joint, publ.)", "held-out p");
  std::vector<TwinOptions> options;
  for (const Law& law : kLaws) {
    for (const double radius : kRadii) options.push_back({.radius = radius, .law = law});
  }
  const std::vector<Twin> twins = make_twins(options);
  auto next = twins.begin();
  for (const Law& law : kLaws) {
    for (const double radius : kRadii) {
      const Twin& twin = *next++;
      const Fit joint = fit_twin(twin, law), published = fit_twin(twin, law, Protocol::published);
      const Fit rival = fit_twin(twin, other(law));
      ASSERT_TRUE(joint.converged);
      const auto percent = [&](const Fit& fit, std::size_t k) {
        return 100 * (fit.parameters[k].value / twin.truth[k] - 1);
      };
      const Comparison comparison = compare_held_out(joint, rival);
      std::printf(
          "%-12s %2.0f mm   %+6.2f %% %+6.2f %%      %+6.2f %% %+6.2f %%      %+6.2f %% %+7.2f %%         %.1e\n",
          std::string(to_string(law)).c_str(), radius * 1e3, percent(joint, 0), percent(published, 0),
          percent(joint, 1), percent(published, 1), percent(joint, 2), percent(published, 2), comparison.p_value);
      // At 9 mm slips end where a sixth (exponential) or a quarter (fractional) of the drop is still to come.
      const bool short_slips = radius < 0.010;
      EXPECT_LT(std::abs(percent(joint, 0)), 0.5) << radius;
      EXPECT_LT(std::abs(percent(joint, 1)), short_slips ? 1.5 : 0.5) << radius;
      EXPECT_LT(std::abs(percent(joint, 2)), short_slips ? 4.0 : 2.0) << radius;
      EXPECT_TRUE(comparison.first_better) << radius;
      EXPECT_LT(comparison.p_value, 0.01) << radius;
    }
  }
}

struct Hidden {
  const char* key;
  std::vector<double> parameters;  ///< SI
  std::size_t main;                ///< the parameter that tells
};

/// An effect at work in the simulated contact comes back when it is added to the model, and the error falls to the
/// floor.
TEST(Effects, ComeBackFromTheRigTheyWereSimulatedOn) {
  const Hidden hidden[] = {{"viscous", {1.0}, 0}, {"rate-state", {60e-6, 0.0}, 0}, {"bristle", {80e3, 2.0}, 0}};
  for (const Hidden& h : hidden) {
    TwinOptions options;
    options.effects = {make_effect(h.key)};
    options.effect_parameters = h.parameters;
    options.scatter = 0.002;
    const Twin twin = make_twin(options);
    const auto fitted = [&](const FrictionModel& model) {
      FitOptions fit;
      return fit_model(model, twin.motion, twin.segmentation,
                       observe(twin.motion, twin.segmentation, model.needs(), 1000), {}, fit);
    };
    const Fit bare = fitted(FrictionModel(ExponentialLaw{}));
    const Fit fit = fitted(FrictionModel(ExponentialLaw{}, options.effects));
    const FitParameter& p = fit.parameters[3 + h.main];
    std::printf("%-10s %s = %.4g (%.4g..%.4g), truth %.4g; held-out error %.5f -> %.5f, noise floor %.5f\n", h.key,
                p.parameter.name.c_str(), p.value / p.parameter.si, p.lower95 / p.parameter.si,
                p.upper95 / p.parameter.si, h.parameters[h.main] / p.parameter.si, bare.error.held_out_rmse,
                fit.error.held_out_rmse, twin.floor_rmse);
    EXPECT_NEAR(p.value / h.parameters[h.main], 1, 0.1) << h.key;
    EXPECT_LT(fit.error.held_out_rmse, 1.1 * twin.floor_rmse) << h.key;
    EXPECT_GT(bare.error.held_out_rmse, 1.2 * fit.error.held_out_rmse) << h.key;
  }
}

struct Condition {
  const char* name;
  double colour, scatter, wander;
};
constexpr Condition kConditions[] = {{"white noise, independent scatter", 0, 0.004, 0},
                                     {"AR(1) 0.9 noise, independent scatter", 0.9, 0.004, 0},
                                     {"white noise, wandering scatter (0.7)", 0, 0.012, 0.7},
                                     {"AR(1) 0.9 noise, wandering scatter (0.7)", 0.9, 0.012, 0.7}};

int runs_per_cell() {
  const char* text = std::getenv("TRIBOFIT_RECOVERY_RUNS");
  return text != nullptr ? std::max(1, std::atoi(text)) : 4;
}

/// Records of a quarter of the rate of [D] do for a few runs: they hold as many cycles.
constexpr double kRateOfFewRuns = 5e3;

/// Nominal 95 % intervals of all parameters over radii and laws, condition by condition.
TEST(Coverage, NominalIntervalsCoverTheTruth) {
  const int runs = runs_per_cell();
  struct Cell {
    int covered[3] = {0, 0, 0};
  };
  for (const Condition& condition : kConditions) {
    std::vector<Cell> cells(static_cast<std::size_t>(8 * runs));
    run_tasks(cells.size(), 0, [&](std::size_t i) {
      TwinOptions options;
      options.radius = kRadii[i % 4];
      options.law = kLaws[(i / 4) % 2];
      options.colour = condition.colour;
      options.scatter = condition.scatter;
      options.wander = condition.wander;
      options.seed = 7919 * (i + 1);
      if (runs < 50) options.rate = kRateOfFewRuns;
      const Twin twin = make_twin(options);
      const Fit fit = fit_twin(twin, options.law);
      for (std::size_t k = 0; k < 3 && k < fit.parameters.size(); ++k) {
        const FitParameter& p = fit.parameters[k];
        cells[i].covered[k] = p.lower95 <= twin.truth[k] && twin.truth[k] <= p.upper95 ? 1 : 0;
      }
    });
    int covered[3] = {0, 0, 0};
    for (const Cell& cell : cells) {
      for (int k = 0; k < 3; ++k) covered[k] += cell.covered[k];
    }
    const double n = static_cast<double>(cells.size());
    const double pooled = (covered[0] + covered[1] + covered[2]) / (3 * n);
    std::printf("%-42s %5.0f intervals: pooled %.1f %%  (mu_s %.1f, mu_k %.1f, decay %.1f)\n", condition.name, 3 * n,
                100 * pooled, 100 * covered[0] / n, 100 * covered[1] / n, 100 * covered[2] / n);
    // The three intervals of a fit are correlated: allow the binomial spread of as many independent fits.
    const double spread = 3 * std::sqrt(0.95 * 0.05 / n);
    EXPECT_GT(pooled, 0.95 - std::max(0.02, spread)) << condition.name;
    if (runs >= 50) {
      EXPECT_LT(pooled, 0.97) << condition.name;
    }
  }
}

}  // namespace
