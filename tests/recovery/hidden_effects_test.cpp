/// A slice of the benchmark of hidden effects; scripts/hidden-effects runs all of it.
#include "hidden_effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "hidden_recipes.hpp"
#include "rates.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace {

using namespace recovery;

std::string names(const Outcome& o) {
  std::string text;
  for (const Name& name : o.names) {
    text += (text.empty() ? "" : ", ") + name.added;
    for (const std::string& other : name.equivalent) text += "|" + other;
  }
  return text.empty() ? "nothing" : text;
}

/// Number of cases that came out right; prints the others.
std::size_t count_right(const std::vector<Outcome>& outcomes) {
  std::size_t right = 0;
  for (const Outcome& o : outcomes) {
    EXPECT_EQ(o.failure, "") << o.tested.name;
    right += o.right ? 1u : 0u;
    if (!o.right) {
      std::printf("%-32s %s, %s\n", o.tested.name.c_str(), names(o).c_str(),
                  std::string(tribofit::to_string(o.verdict)).c_str());
    }
  }
  return right;
}

std::vector<Case> slice(Kind kind, const PlanOptions& options) {
  std::vector<Case> cases = plan_cases(options);
  std::erase_if(cases, [&](const Case& c) { return c.kind != kind; });
  return cases;
}

constexpr PlanOptions kSlice = {
    .runs = 1, .pairs = 0, .nothing = 10, .aliens = 2, .unknowable = 1, .largest_only = true};

/// Sizes and draws lie within the bounds of the parameters, the least effect first.
TEST(HiddenEffects, EveryEffectOfTheCatalogueIsInTheBenchmark) {
  std::set<std::string> planned;
  for (const Case& c : slice(Kind::single, kSlice)) planned.insert(c.hidden[0].key);
  const auto within = [](const tribofit::Parameter& p, double value) { return p.lower <= value && value <= p.upper; };
  for (const tribofit::Effect& effect : tribofit::effect_catalogue()) {
    const tribofit::EffectInfo info = describe(effect);
    SCOPED_TRACE(info.key);
    EXPECT_EQ(planned.count(info.key), 1u);
    const HiddenCases& cases = hidden_cases(info.key);
    ASSERT_FALSE(cases.sizes.empty());
    ASSERT_EQ(cases.others.size() + 1, info.parameters.size());
    const tribofit::Parameter& first = info.parameters[0];
    for (std::size_t k = 0; k < cases.sizes.size(); ++k) {
      EXPECT_TRUE(within(first, cases.sizes[k])) << cases.sizes[k];
      EXPECT_TRUE(!cases.either_sign || within(first, -cases.sizes[k])) << -cases.sizes[k];
      if (k == 0 || std::isnan(first.neutral)) continue;
      EXPECT_GT(std::abs(cases.sizes[k] - first.neutral), std::abs(cases.sizes[k - 1] - first.neutral));
    }
    for (std::size_t k = 0; k < cases.others.size(); ++k) {
      const tribofit::Parameter& p = info.parameters[k + 1];
      const ValueDraw& draw = cases.others[k];
      for (const double value : draw.choices) EXPECT_TRUE(within(p, value)) << p.name;
      if (draw.choices.empty()) {
        EXPECT_TRUE(within(p, draw.lower) && within(p, draw.upper) && draw.lower < draw.upper) << p.name;
      }
    }
  }
}

/// A case that failed can be rerun alone, whatever else was in the plan.
TEST(HiddenEffects, ACaseFollowsFromItsNameAlone) {
  const std::vector<Case> few = slice(Kind::single, kSlice);
  PlanOptions more = kSlice;
  more.runs = 2;
  more.largest_only = false;
  const std::vector<Case> many = slice(Kind::single, more);
  const auto again = std::find_if(many.begin(), many.end(), [&](const Case& c) { return c.name == few[3].name; });
  ASSERT_NE(again, many.end());
  const Simulated a = simulate_case(few[3]), b = simulate_case(*again);
  EXPECT_EQ(a.truth, b.truth);
  EXPECT_EQ(a.traces[0]->friction, b.traces[0]->friction);
  EXPECT_GT(a.floor_rmse, 0.003);
  EXPECT_LT(a.floor_rmse, 0.02);
}

TEST(HiddenEffects, AreNamed) {
  const std::vector<Outcome> outcomes = run_cases(halved(slice(Kind::single, kSlice)), 0);
  EXPECT_GE(count_right(outcomes), outcomes.size() - 3);
}

/// Each leaves the other as what looks like slow noise, or explains less than a free function of its variable does.
TEST(HiddenEffects, TwoThatHideEachOtherAreNamed) {
  std::vector<Case> cases = slice(Kind::pair, {.runs = 0, .pairs = 1, .nothing = 0, .aliens = 0, .unknowable = 0});
  const std::set<std::string> few = {"step+disc-pattern", "drift+runout", "load-dependence+frictional-lag"};
  std::erase_if(cases, [&](const Case& c) { return few.count(c.group) == 0; });
  ASSERT_EQ(cases.size(), few.size());
  EXPECT_EQ(count_right(run_cases(cases, 0)), cases.size());
}

TEST(HiddenEffects, NothingIsNamedWhereNothingIsHidden) {
  const std::vector<Outcome> outcomes = run_cases(slice(Kind::nothing, kSlice), 0);
  for (const Outcome& o : outcomes) EXPECT_TRUE(o.names.empty()) << o.tested.name << ": " << names(o);
  // The verdict may call scatter a structure now and then.
  EXPECT_GE(count_right(outcomes), outcomes.size() - 1);
}

/// Sliding, a slow rig, noise as 1/f: one record of each with nothing hidden and one with an effect.
TEST(HiddenEffects, AreNamedInOtherKindsOfRecord) {
  const std::vector<Case> cases = plan_record_kinds({"stick-slip-flicker", "steps", "reversals", "slow-30"}, 1, 1);
  EXPECT_GE(count_right(run_cases(cases, 0)), cases.size() - 1);
}

/// Sliding with white, AR(1) and 1/f noise in turn.
TEST(HiddenEffects, NothingIsNamedInSlidingWhereNothingIsHidden) {
  for (const Outcome& o : run_cases(plan_record_kinds({"steps", "ramps", "sines", "reversals"}, 3, 0), 0)) {
    EXPECT_TRUE(o.right) << o.tested.name << ": " << names(o);
  }
}

/// 1/f noise raises whole slips, and wanders over the record: neither is an effect, nor the mark of another law.
TEST(HiddenEffects, NothingIsNamedInFlickerNoise) {
  std::vector<Case> cases;
  for (const auto& [seed, number] : {std::pair{1, 126}, {1, 256}, {2, 61}, {2, 86}, {2, 92}}) {
    const std::string name = "stick-slip-flicker/nothing:" + std::to_string(number);
    for (const Case& c : plan_record_kinds({"stick-slip-flicker"}, 260, 0, static_cast<std::uint64_t>(seed))) {
      if (c.name == name) cases.push_back(c);
    }
  }
  ASSERT_EQ(cases.size(), 5);
  EXPECT_EQ(count_right(run_cases(cases, 0)), cases.size());
}

/// What the block shows by how it sticks is not hidden where it never does.
TEST(HiddenEffects, SlidingHidesOnlyWhatItCanShow) {
  const std::vector<std::string> sliding = {"steps", "ramps", "sines", "reversals"};
  std::set<std::string> hidden;
  for (const Case& c : plan_record_kinds(sliding, 0, 60)) {
    const tribofit::EffectInfo info = tribofit::describe(tribofit::make_effect(c.hidden.at(0).key));
    EXPECT_FALSE(info.kinematic_effect || info.needs.plateau) << info.key;
    EXPECT_TRUE(info.excitation.break_away.empty()) << info.key;
    hidden.insert(info.key);
  }
  for (const Case& c : plan_asked_of_sliding(sliding, 6)) {
    for (const Ingredient& what : c.hidden) EXPECT_EQ(hidden.count(what.key), 1u) << what.key;
    EXPECT_EQ(c.kind == Kind::base_law, c.hidden.empty()) << c.name;
  }
  EXPECT_THROW(plan_asked_of_sliding({"slow-30"}, 1), std::invalid_argument);
}

/// A slow rig makes the same record with another clock.
TEST(HiddenEffects, ASlowRigIsAnExactImage) {
  Case c = plan_record_kinds({"stick-slip-white"}, 0, 3)[2];
  const Simulated fast = simulate_case(c), slow = simulate_case(slowed(c, 30));
  EXPECT_EQ(fast.traces[0]->friction, slow.traces[0]->friction);
  EXPECT_DOUBLE_EQ(30 * fast.traces[0]->time[100], slow.traces[0]->time[100]);
  EXPECT_DOUBLE_EQ(fast.traces[0]->velocity[100], 30 * slow.traces[0]->velocity[100]);
  EXPECT_DOUBLE_EQ(fast.traces[0]->steps[0].conditions.speed.value,
                   30 * slow.traces[0]->steps[0].conditions.speed.value);
  EXPECT_DOUBLE_EQ(30 * fast.truth[2], slow.truth[2]);  // steepness of the law
  EXPECT_DOUBLE_EQ(30 * fast.truth[3], slow.truth[3]);  // frictional lag
}

TEST(HiddenEffects, OfNoCatalogueAreCalledUnexplained) {
  const std::vector<Outcome> outcomes = run_cases(slice(Kind::alien, kSlice), 0);
  EXPECT_GE(count_right(outcomes), outcomes.size() - 1);
}

TEST(HiddenEffects, AgeingIsNotNamedFromOneConstantSpeed) {
  const std::vector<Outcome> outcomes = run_cases(slice(Kind::unknowable, kSlice), 0);
  EXPECT_EQ(count_right(outcomes), outcomes.size());
}

/// What the next experiment says is done with the rig in which the effect is hidden, and diagnosed.
TEST(HiddenEffects, TheNextExperimentTellsWhatLooksAlike) {
  std::vector<Case> cases = slice(Kind::look_alike, kSlice);
  const std::set<std::string> few = {"sensor-offset~asymmetry:0", "radius-offset~velocity-gain:0",
                                     "velocity-gain~radius-offset:0"};
  std::erase_if(cases, [&](const Case& c) { return few.count(c.name) == 0; });
  ASSERT_EQ(cases.size(), few.size());
  const std::vector<Outcome> outcomes = run_cases(cases, 0, {.experiments = true});
  EXPECT_EQ(count_right(outcomes), outcomes.size());
  for (const Outcome& o : outcomes) {
    if (o.naming != Naming::group) continue;
    for (const std::string& partner : o.partners) {
      EXPECT_NE(o.experiment.find(partner), std::string::npos) << o.tested.name << ": " << o.experiment;
    }
    EXPECT_NE(o.experiment.find(tribofit::discriminating_experiment(o.tested.hidden[0].key, o.tested.partner)),
              std::string::npos);
  }
}

TEST(HiddenEffects, EveryTestOfTheCatalogueIsSimulated) {
  for (const tribofit::Effect& effect : tribofit::effect_catalogue()) {
    const std::string key = tribofit::describe(effect).key;
    for (const tribofit::LookAlike& twin : tribofit::look_alikes(key)) {
      EXPECT_FALSE(discriminating_runs(key, twin.key).empty()) << key << " and " << twin.key;
    }
  }
}

/// No hits in 800: 1 - 0.05^(1/800).
TEST(HiddenEffects, UpperBoundOfARateIsThatOfTheBinomial) {
  EXPECT_NEAR(upper_bound_95(0, 800), 1 - std::pow(0.05, 1.0 / 800), 1e-12);
  EXPECT_NEAR(upper_bound_95(1, 10), 0.394163, 1e-6);  // Clopper, Pearson, Biometrika 26 (1934) 404
  EXPECT_EQ(upper_bound_95(10, 10), 1);
  EXPECT_NEAR(lower_bound(9, 10, 0.95), 1 - 0.394163, 1e-6);
}

// The force sensor of two runs is one. Where some slips show that it is a low-pass and others, for noise, do not, each
// record had its own, and nothing or the filter twice was named.
TEST(SeveralRuns, AFilterThatOneOfThemHidesIsNamedOnce) {
  int given = 0, taken = 0;
  for (const std::uint64_t seed : {4u, 6u}) {
    PlanOptions plan;
    plan.runs = 1;
    plan.seed = seed;
    const std::vector<Case> cases = slice(Kind::single, plan);
    const auto at = std::find_if(cases.begin(), cases.end(),
                                 [](const Case& c) { return c.hidden.front().key == "force-bandwidth"; });
    ASSERT_NE(at, cases.end());
    Case c = *at;
    c.hidden.front().values = {100, 0.75};
    c.length = 0.3;
    c.noise = 4;
    const recovery::Run longer = {.setting = Setting::fast, .duration = 10 / c.length};
    const Simulated all = simulate_case(c, {{3, longer}, {}});
    for (std::size_t k = 1; k < all.traces.size(); ++k) {
      Simulated both = all;
      both.traces = {all.traces[0], all.traces[k]};
      const tribofit::DiagnosedTraces diagnosed = diagnose_case(both);
      EXPECT_EQ(diagnosed.traces[0].motion.friction_low_pass.any(), diagnosed.traces[1].motion.friction_low_pass.any());
      for (const tribofit::Identification& trace : diagnosed.traces) {
        const bool is_other = trace.motion.friction_filter_source == tribofit::FilterSource::other_runs;
        const bool is_said = std::any_of(trace.notes.begin(), trace.notes.end(), [](const std::string& note) {
          return note.find("friction: ") == 0 && note.find("low-pass") != std::string::npos;
        });
        EXPECT_EQ(is_other, is_said) << "seed " << seed << ", run " << k;
        (trace.motion.friction_low_pass.any() ? given : taken) += is_other ? 1 : 0;
      }
      const std::vector<Name> names = names_of(diagnosed.diagnosis);
      ASSERT_EQ(names.size(), 1) << "seed " << seed << ", run " << k;
      std::vector<std::string> keys = names[0].equivalent;
      keys.push_back(names[0].added);
      EXPECT_EQ(std::count(keys.begin(), keys.end(), "force-bandwidth"), 1) << "seed " << seed << ", run " << k;
    }
  }
  EXPECT_GT(given, 0);
  EXPECT_GT(taken, 0);
}

}  // namespace
