/// Work that is ended before its end: what is left, and how soon it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "../fit/synthetic.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace {

using namespace tribofit;
using Clock = std::chrono::steady_clock;

synthetic::Record lagging_record() {
  synthetic::Options options;
  options.cycles = 30;
  options.rate = 5e3;
  options.noise = 0.003;
  std::vector<double> p = synthetic::table4_15mm(ExponentialLaw{});
  p.push_back(0.004);
  return synthetic::make(FrictionModel(ExponentialLaw{}, {make_effect("frictional-lag")}), p, options);
}

Diagnosed diagnosed(const synthetic::Record& made, const DiagnosisOptions& options) {
  const Record record = {&made.motion, &made.segmentation};
  return diagnose({&record, 1}, {ExponentialLaw{}, FractionalLaw{}}, {}, {}, {}, options);
}

std::vector<std::string> keys_of(const Diagnosis& diagnosis, EffectStatus status) {
  std::vector<std::string> keys;
  for (const EffectFinding& finding : diagnosis.effects) {
    if (finding.status == status) keys.push_back(finding.key);
  }
  return keys;
}

TEST(TimeLimit, LeavesWhatIsKnownAndSaysWhatWasNotTried) {
  const synthetic::Record made = lagging_record();
  const Diagnosed whole = diagnosed(made, {});
  ASSERT_EQ(whole.diagnosis.verdict, Verdict::effect_found);
  DiagnosisOptions over;
  over.until = Clock::now();
  const Diagnosed cut = diagnosed(made, over);
  EXPECT_EQ(cut.diagnosis.verdict, Verdict::unfinished);
  ASSERT_EQ(cut.diagnosis.ladder.size(), 1u) << "no effect can have been judged";
  const std::vector<std::string> untried = keys_of(cut.diagnosis, EffectStatus::untried);
  EXPECT_THAT(untried, testing::Contains("frictional-lag"));
  // What these data cannot show is known without a trial.
  EXPECT_EQ(keys_of(cut.diagnosis, EffectStatus::untestable), keys_of(whole.diagnosis, EffectStatus::untestable));
  EXPECT_EQ(untried.size() + keys_of(cut.diagnosis, EffectStatus::untestable).size(), cut.diagnosis.effects.size());
  // The base law is the fit that the whole diagnosis begins from.
  if (cut.diagnosis.law == whole.diagnosis.law) {
    EXPECT_EQ(cut.fits.front().error.held_out_rmse, whole.fits.front().error.held_out_rmse);
  }
  EXPECT_GT(cut.fits.front().error.held_out_rmse, whole.fits.back().error.held_out_rmse);
}

TEST(TimeLimit, ChangesNothingWhereItIsNotReached) {
  const synthetic::Record made = lagging_record();
  DiagnosisOptions ample;
  ample.until = Clock::now() + std::chrono::hours(1);
  const Diagnosed whole = diagnosed(made, {}), limited = diagnosed(made, ample);
  EXPECT_EQ(limited.diagnosis.verdict, whole.diagnosis.verdict);
  ASSERT_EQ(limited.fits.size(), whole.fits.size());
  EXPECT_EQ(limited.fits.back().values(), whole.fits.back().values());
  EXPECT_THAT(keys_of(limited.diagnosis, EffectStatus::untried), testing::IsEmpty());
}

/// Wherever it is asked to stop, work ends soon: by the number of times it asks again, which are a few milliseconds
/// apart.
TEST(Stop, EndsADiagnosisWhereverItIs) {
  const synthetic::Record made = lagging_record();
  std::atomic<int> asked{0};
  {
    const StopScope counting([&] {
      ++asked;
      return false;
    });
    diagnosed(made, {});
  }
  const int all = asked;
  ASSERT_GT(all, 1000);
  for (const double part : {0.0, 0.1, 0.4, 0.8, 0.99}) {
    const int last = static_cast<int>(part * all);
    asked = 0;
    const StopScope scope([&] { return ++asked > last; });
    DiagnosisOptions ample;  // a time limit within takes nothing for its own
    ample.until = Clock::now() + std::chrono::hours(1);
    EXPECT_THROW(diagnosed(made, ample), Stopped) << "at " << part << " of " << all;
    EXPECT_LT(asked - last, 1000) << "at " << part;
  }
}

TEST(Stop, EndsAFitOfALongFormula) {
  const synthetic::Record made = lagging_record();
  std::string powers;
  for (int k = 10; k < 99; ++k) powers += (powers.empty() ? "" : "+") + ("k*(v/w)^." + std::to_string(k));
  const FrictionModel model(ExponentialLaw{}, {Formula("long = " + powers + "; k=0.001, w=6mm/s")});
  const Observations observations = observe(made.motion, made.segmentation, model.needs(), 1000);
  int asked = 0;
  const StopScope scope([&] { return ++asked > 500; });
  EXPECT_THROW(fit_model(model, made.motion, made.segmentation, observations), Stopped);
  EXPECT_LT(asked, 600);
}

}  // namespace
