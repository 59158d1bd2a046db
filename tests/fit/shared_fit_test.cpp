/// Records that share parameters, against the fit of one record and against known truth.
#include "fit/shared_fit.hpp"

#include <gtest/gtest.h>

#include "fit/fit_laws.hpp"
#include "synthetic.hpp"

using namespace tribofit;

namespace {

constexpr std::size_t kOwn = SharingRecord::kOwn;

synthetic::Options noisy(std::uint64_t seed) {
  synthetic::Options options;
  options.rate = 2e3;
  options.noise = 0.005;
  options.scatter = 0.004;
  options.wander = 0.5;
  options.seed = seed;
  return options;
}

/// Records with what their own fits found.
struct Campaign {
  const FrictionModel model{ExponentialLaw{}};
  std::vector<Observations> observations;
  std::vector<Fit> fits;
  Bounds bounds;

  void add(const std::vector<double>& truth, std::uint64_t seed) {
    const synthetic::Record made = synthetic::make(model, truth, noisy(seed));
    const Record record = {&made.motion, &made.segmentation};
    observations.push_back(observations_for(model, {&record, 1}));
    fits.push_back(fit_model(model, {&record, 1}, observations.back()));
    bounds = {};
    for (const FitParameter& p : fits.back().parameters) {
      bounds.lower.push_back(p.parameter.lower * p.parameter.si);
      bounds.upper.push_back(p.parameter.upper * p.parameter.si);
    }
  }
  RecordsFit fit(const std::vector<std::size_t>& common, std::size_t count) const {
    std::vector<SharingRecord> records;
    for (std::size_t r = 0; r < fits.size(); ++r)
      records.push_back({&observations[r], false, fits[r].values(), common});
    return fit_sharing_records(model, records, bounds, count);
  }
};

const std::vector<double> kTruth = synthetic::table4_15mm(ExponentialLaw{});

TEST(SharedFit, ARecordThatSharesNothingKeepsItsFit) {
  Campaign campaign;
  campaign.add(kTruth, 1);
  campaign.add({0.52, 0.33, 40}, 2);
  const RecordsFit together = campaign.fit({kOwn, kOwn, kOwn}, 0);
  ASSERT_TRUE(together.converged) << together.message;
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      const FitParameter& single = campaign.fits[r].parameters[k];
      const SharedEstimate& estimate = together.records[r][k];
      EXPECT_NEAR(estimate.value, single.value, 0.01 * single.std_error) << r << k;
      EXPECT_NEAR(estimate.std_error, single.std_error, 0.02 * single.std_error) << r << k;
      EXPECT_NEAR(estimate.lower95, single.lower95, 0.05 * single.std_error) << r << k;
    }
  }
  EXPECT_EQ(together.test.degrees_of_freedom, 0);
  EXPECT_NEAR(together.held_out_rmse_together, together.held_out_rmse_alone, 1e-4 * together.held_out_rmse_alone);
}

/// A whitening anew forgets what was evaluated with the one before it.
TEST(SharedFit, AMemberIsWhitenedAnew) {
  Campaign campaign;
  campaign.add(kTruth, 1);
  const SharingRecord record{&campaign.observations[0], false, campaign.fits[0].values(), {kOwn, kOwn, kOwn}};
  std::vector<double> elsewhere = record.values;
  elsewhere[1] *= 0.9;
  sharing::Member member(campaign.model, record), fresh(campaign.model, record);
  const auto rows = [&](const sharing::Member& whitened) {
    std::vector<double> residual(whitened.residuals.count()), jacobian(residual.size() * record.values.size());
    EXPECT_TRUE(whitened.residuals.evaluate(record.values.data(), residual.data(), jacobian.data()));
    residual.insert(residual.end(), jacobian.begin(), jacobian.end());
    return residual;
  };
  member.whiten_at(elsewhere);
  const std::vector<double> before = rows(member);
  member.whiten_at(record.values);
  fresh.whiten_at(record.values);
  ASSERT_TRUE(fresh.whitening.any());
  EXPECT_EQ(rows(member), rows(fresh));
  EXPECT_NE(before, rows(fresh));
}

TEST(SharedFit, IntervalsCoverAndTheSharingIsRarelyRefused) {
  constexpr int kCampaigns = 60;
  int inside = 0, inside_own = 0, refused = 0;
  double squares = 0, single_squares = 0;
  for (int c = 0; c < kCampaigns; ++c) {
    Campaign campaign;
    for (std::uint64_t r = 0; r < 3; ++r)
      campaign.add({0.509, 0.3 + 0.02 * static_cast<double>(r), kTruth[2]}, 10 * static_cast<std::uint64_t>(c) + r);
    const RecordsFit together = campaign.fit({kOwn, kOwn, 0}, 1);
    ASSERT_TRUE(together.converged) << together.message;
    const SharedEstimate& alpha = together.common[0];
    inside += alpha.lower95 <= kTruth[2] && kTruth[2] <= alpha.upper95 ? 1 : 0;
    const SharedEstimate& mu_k = together.records[1][1];
    inside_own += mu_k.lower95 <= 0.32 && 0.32 <= mu_k.upper95 ? 1 : 0;
    refused += together.test.is_refused() ? 1 : 0;
    squares += std::pow(alpha.value - kTruth[2], 2);
    single_squares += std::pow(campaign.fits[0].parameters[2].value - kTruth[2], 2);
  }
  // 95 % of 60 is 57 with a standard error of 1.7.
  EXPECT_GE(inside, 52);
  EXPECT_GE(inside_own, 52);
  EXPECT_LE(refused, 4);
  EXPECT_LT(squares, 0.6 * single_squares) << "three records know alpha better than one";
}

TEST(SharedFit, ARecordWithAnotherLawIsNamed) {
  Campaign campaign;
  for (std::uint64_t r = 0; r < 5; ++r) {
    std::vector<double> truth = kTruth;
    if (r == 3) truth[2] *= 1.05;
    campaign.add(truth, 40 + r);
  }
  const RecordsFit together = campaign.fit({kOwn, kOwn, 0}, 1);
  ASSERT_TRUE(together.converged) << together.message;
  EXPECT_TRUE(together.test.is_refused());
  EXPECT_EQ(together.test.most_different, 3u);
  EXPECT_GT(together.common[0].std_error, 2 * together.common[0].statistical);
  EXPECT_GT(together.held_out_rmse_together, together.held_out_rmse_alone);
}

}  // namespace
