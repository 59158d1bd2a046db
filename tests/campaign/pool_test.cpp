/// Coverage and power of what is said of several runs, on results drawn from known truth.
#include "tribofit/campaign/pool.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tribofit/campaign/sharing.hpp"
#include "tribofit/campaign/trends.hpp"
#include "tribofit/ingest/input_error.hpp"

using namespace tribofit;

namespace {

/// Results of runs of the exponential law: mu_s, mu_k, alpha with errors that go together.
class Laboratory {
 public:
  explicit Laboratory(unsigned seed, double freedom = 20) : random_(seed), freedom_(freedom) {}

  /// between: scatter from run to run, in units of the runs' own errors.
  RunResult run(const std::array<double, 3>& truth, double radius_mm, double between = 0) {
    const Eigen::Vector3d size(8e-4, 2e-4, 4e-4);
    Eigen::Matrix3d correlation;
    correlation << 1, 0.2, 0.3, 0.2, 1, 0.8, 0.3, 0.8, 1;
    const Eigen::Vector3d sd = size * std::exp(0.3 * normal_(random_));
    const Eigen::Matrix3d covariance = sd.asDiagonal() * correlation * sd.asDiagonal();
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    const Eigen::Vector3d error = root * Eigen::Vector3d(normal(), normal(), normal()) +
                                  between * Eigen::Vector3d(size(0) * normal(), size(1) * normal(), size(2) * normal());
    RunResult out;
    out.run.name = "r" + std::to_string(count_++);
    out.run.conditions.radius = {radius_mm * 1e-3, "manifest"};
    out.run.conditions.speed = {0.41887902, "manifest"};
    out.conditions = out.run.conditions;
    ResultFit fit;
    fit.law = "exponential";
    fit.protocol = "joint";
    fit.converged = true;
    fit.degrees_of_freedom = freedom_;
    const char* names[] = {"mu_s", "mu_k", "alpha"};
    // The errors that a run states are estimates, too.
    std::chi_squared_distribution<double> chi(freedom_);
    const double stated = std::sqrt(chi(random_) / freedom_);
    for (int k = 0; k < 3; ++k) {
      ResultParameter p;
      p.name = names[k];
      p.unit = k < 2 ? "1" : "s/mm";
      p.value = truth[static_cast<std::size_t>(k)] + error(k);
      p.std_error = stated * sd(k);
      fit.parameters.push_back(p);
    }
    for (int i = 0; i < 3; ++i) {
      fit.covariance.emplace_back();
      for (int j = 0; j < 3; ++j) fit.covariance.back().push_back(stated * stated * covariance(i, j));
    }
    out.fits.push_back(fit);
    return out;
  }
  double normal() { return normal_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double freedom_;  ///< of the errors that a run states
  int count_ = 0;
};

constexpr std::array<double, 3> kTruth = {0.509, 0.318, 0.05214};

}  // namespace

class PooledRepeats : public testing::TestWithParam<std::tuple<int, double, double>> {};

/// Where runs do not scatter two of them cannot show it: an interval that is no narrower than their own errors allow
/// then holds the truth more often than it says.
TEST_P(PooledRepeats, CoverTheTruth) {
  const auto [count, between, freedom] = GetParam();
  Laboratory laboratory(7, freedom);
  int inside = 0, all = 0;
  for (int campaign = 0; campaign < 1000; ++campaign) {
    std::vector<RunResult> runs;
    for (int k = 0; k < count; ++k) runs.push_back(laboratory.run(kTruth, 15, between));
    const std::vector<PooledGroup> groups = pool_repeats(runs);
    ASSERT_EQ(groups.size(), 1u);
    ASSERT_EQ(groups[0].runs.size(), static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < 3; ++k) {
      const PooledValue& value = groups[0].fits[0].parameters[k];
      inside += value.lower95 <= kTruth[k] && kTruth[k] <= value.upper95 ? 1 : 0;
      EXPECT_GT(value.upper95 - value.lower95, 2 * 1.95 * value.statistical);
      ++all;
    }
  }
  const double covered = static_cast<double>(inside) / all;
  RecordProperty("covered", std::to_string(covered));
  EXPECT_GE(covered, 0.93);
  EXPECT_LE(covered, between >= 5 || count == 16 ? 0.97 : 0.995);
}

INSTANTIATE_TEST_SUITE_P(Campaigns, PooledRepeats,
                         testing::Combine(testing::Values(2, 3, 4, 16), testing::Values(0.0, 1.0, 5.0),
                                          testing::Values(2.0, 20.0)));

TEST(PooledRepeats, KeepThePartsOfTheErrorApart) {
  Laboratory laboratory(11);
  std::vector<RunResult> runs;
  for (int k = 0; k < 400; ++k) {
    runs.push_back(laboratory.run(kTruth, 15, 3));
    runs.back().fits[0].parameters[0].systematic = 2e-3;
  }
  const PooledValue mu_s = pool_repeats(runs)[0].fits[0].parameters[0];
  EXPECT_NEAR(mu_s.between, 3 * 8e-4, 0.1 * 3 * 8e-4);
  EXPECT_LT(mu_s.statistical, 8e-4 / 15) << "falls with the number of runs";
  EXPECT_NEAR(mu_s.std_error, 3.2 * 8e-4 / 20, 0.2 * 3.2 * 8e-4 / 20);
  EXPECT_NEAR(mu_s.systematic, 2e-3, 1e-12) << "shared by all runs: does not fall";
}

TEST(PooledRepeats, OneRunKeepsItsOwnInterval) {
  Laboratory laboratory(3);
  for (int k = 0; k < 50; ++k) {  // however its value and error are rounded
    std::vector<RunResult> runs = {laboratory.run(kTruth, 15)};
    for (ResultParameter& p : runs[0].fits[0].parameters) {
      p.lower95 = p.value - 3 * p.std_error;
      p.upper95 = p.value + 4 * p.std_error;
    }
    const PooledGroup group = pool_repeats(runs)[0];
    for (std::size_t p = 0; p < 3; ++p) {
      const PooledValue& pooled = group.fits[0].parameters[p];
      EXPECT_EQ(pooled.lower95, runs[0].fits[0].parameters[p].lower95);
      EXPECT_EQ(pooled.upper95, runs[0].fits[0].parameters[p].upper95);
      EXPECT_TRUE(std::isnan(pooled.between));
    }
  }
}

TEST(PooledRepeats, GroupByConditionsButNotByOrder) {
  Laboratory laboratory(5);
  std::vector<RunResult> runs;
  for (const double radius : {9.0, 15.0, 9.0, 15.0}) {
    runs.push_back(laboratory.run(kTruth, radius));
    runs.back().run.others = {{"order", std::to_string(runs.size())}, {"pad", radius < 10 ? "new" : "worn"}};
  }
  const std::vector<PooledGroup> groups = pool_repeats(runs);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].runs, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(groups[1].others.size(), 1u);
  EXPECT_EQ(groups[1].others[0].value, "worn");
}

TEST(SharedFit, CoversWhatIsCommonAndWhatIsFree) {
  // alpha is the same everywhere, mu_s goes with the radius, mu_k is each run's own.
  Laboratory laboratory(23);
  const std::map<double, double> mu_s = {{9, 0.521}, {12, 0.512}, {15, 0.509}, {18, 0.5}};
  const Sharing sharing = sharing_from({"alpha"}, {"mu_s:radius"});
  int inside[3] = {}, all[3] = {};
  double own = 0, joint = 0;
  for (int campaign = 0; campaign < 300; ++campaign) {
    std::vector<RunResult> runs;
    std::vector<double> mu_k;
    for (const auto& [radius, level] : mu_s) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        mu_k.push_back(0.35 + 0.02 * laboratory.normal());
        runs.push_back(laboratory.run({level, mu_k.back(), kTruth[2]}, radius));
      }
    }
    const std::vector<SharedFit> fits = fit_shared(runs, sharing);
    ASSERT_EQ(fits.size(), 1u);
    const PooledValue& alpha = fits[0].common[0].values.at(0);
    inside[0] += alpha.lower95 <= kTruth[2] && kTruth[2] <= alpha.upper95 ? 1 : 0;
    ++all[0];
    const SharedFit::Parameter& levels = fits[0].common[1];
    ASSERT_EQ(levels.values.size(), 4u);
    for (std::size_t l = 0; l < 4; ++l) {
      const double truth = std::next(mu_s.begin(), static_cast<std::ptrdiff_t>(l))->second;
      inside[1] += levels.values[l].lower95 <= truth && truth <= levels.values[l].upper95 ? 1 : 0;
      ++all[1];
    }
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const double off = fits[0].runs[r].value[1] - mu_k[r];
      inside[2] += std::abs(off) <= 2.08 * fits[0].runs[r].std_error[1] ? 1 : 0;  // t of 20 degrees of freedom
      ++all[2];
      joint += off * off;
      own += std::pow(runs[r].fits[0].parameters[1].value - mu_k[r], 2);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double covered = static_cast<double>(inside[k]) / all[k];
    RecordProperty("covered_" + std::to_string(k), std::to_string(covered));
    EXPECT_GE(covered, 0.92) << k;  // 300 values of alpha: standard error 1.3 %
    EXPECT_LE(covered, 0.98) << k;
  }
  EXPECT_LT(joint, 0.6 * own) << "mu_k goes with alpha: knowing alpha better tells mu_k better";
}

TEST(SharedFit, NamesWhatIsNotKnown) {
  Laboratory laboratory(2);
  const std::vector<RunResult> runs = {laboratory.run(kTruth, 9), laboratory.run(kTruth, 15)};
  const auto message = [&](const std::vector<std::string>& share, const std::vector<std::string>& vary) -> std::string {
    try {
      fit_shared(runs, sharing_from(share, vary));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({"alhpa"}, {}).find("did you mean alpha?"), std::string::npos);
  EXPECT_NE(message({}, {"mu_s:raduis"}).find("did you mean radius?"), std::string::npos);
  EXPECT_NE(message({"alpha"}, {"alpha:radius"}).find("named twice"), std::string::npos);
  EXPECT_THROW(sharing_from({}, {"mu_s"}), InputError);
  EXPECT_THROW(sharing_from({}, {"mu_s:"}), InputError);
  EXPECT_THROW(sharing_from({"mu_s:radius"}, {}), InputError);
}

TEST(Trends, CoverTheSlopeAndStaySilentOnNone) {
  Laboratory laboratory(31);
  const double slope = -2e-3;  // of mu_s [1/mm]
  int inside = 0, found = 0, alarms = 0;
  constexpr int kCampaigns = 600;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    std::vector<RunResult> runs;
    for (const double radius : {9.0, 12.0, 15.0, 18.0}) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        runs.push_back(laboratory.run({0.5 + slope * radius, 0.35, 0.05}, radius, 1));
      }
    }
    const Trends trends = find_trends(runs);
    bool alarm = false;
    for (const Trend& t : trends.trends) {
      if (t.condition != "radius") continue;
      if (t.parameter == "mu_s") {
        inside += t.lower95 <= slope && slope <= t.upper95 ? 1 : 0;
        found += t.p_corrected < 0.05 ? 1 : 0;
      } else {
        alarm |= t.p_corrected < 0.05;
      }
    }
    alarms += alarm ? 1 : 0;
  }
  EXPECT_GE(inside, 0.92 * kCampaigns);
  EXPECT_LE(inside, 0.98 * kCampaigns);
  EXPECT_GE(found, 0.99 * kCampaigns);
  EXPECT_LE(alarms, 0.05 * kCampaigns);
}

TEST(Trends, WarnWhereConditionsChangeTogether) {
  Laboratory laboratory(37);
  std::vector<RunResult> runs;
  for (const double radius : {9.0, 12.0, 15.0, 18.0}) {
    for (int repeat = 0; repeat < 3; ++repeat) {
      runs.push_back(laboratory.run(kTruth, radius));
      runs.back().order = static_cast<double>(runs.size());
    }
  }
  const Trends in_order = find_trends(runs);
  const auto holds = [](const Trends& trends, const std::string& a, const std::string& b) {
    return std::any_of(trends.confounded.begin(), trends.confounded.end(),
                       [&](const Confounded& c) { return c.a == a && c.b == b; });
  };
  EXPECT_TRUE(holds(in_order, "radius", "sliding speed")) << "one speed of the disc";
  EXPECT_TRUE(holds(in_order, "radius", "order"));
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].order = static_cast<double>((7 * k) % 12);
  EXPECT_FALSE(holds(find_trends(runs), "radius", "order"));
}

TEST(SharedFit, SaysWhereRunsHardlyShare) {
  Laboratory laboratory(41);
  std::vector<RunResult> runs;
  for (int k = 0; k < 8; ++k) runs.push_back(laboratory.run(kTruth, 15, k < 4 ? 0 : 40));
  const std::vector<SharedFit> fits = fit_shared(runs, sharing_from({"alpha"}, {}));
  ASSERT_EQ(fits[0].notes.size(), 1u);
  EXPECT_NE(fits[0].notes[0].find("--vary alpha:CONDITION"), std::string::npos);
}

TEST(Trends, DoNotDependOnTheScaleOfTheCondition) {
  const auto trend = [](double scale) {
    Laboratory laboratory(43);  // the same runs every time
    std::vector<RunResult> runs;
    for (int k = 1; k <= 8; ++k) {
      runs.push_back(laboratory.run({0.5 + 3e-3 * k, 0.35, 0.05}, 15));
      runs.back().run.others = {{"lot", fmt::format("{}", scale * k)}};
    }
    const Trends all = find_trends(runs);
    const auto found = std::find_if(all.trends.begin(), all.trends.end(),
                                    [](const Trend& t) { return t.parameter == "mu_s" && t.condition == "lot"; });
    return found == all.trends.end() ? Trend() : *found;
  };
  const Trend plain = trend(1);
  EXPECT_LT(plain.p_value, 0.01);
  EXPECT_TRUE(plain.lower95 <= 3e-3 && 3e-3 <= plain.upper95);
  for (const double scale : {1e-200, 1e200}) {
    const Trend scaled = trend(scale);
    EXPECT_NEAR(scaled.p_value, plain.p_value, 1e-9) << scale;
    EXPECT_NEAR(scaled.slope * scale, plain.slope, 1e-12) << scale;
  }
}
