/// A look (FitOptions::starts == 0) against the fit that it stands for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fit/errors.hpp"
#include "fit/fit_steps.hpp"
#include "fit/model_residuals.hpp"
#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"

namespace {

using namespace tribofit;

/// With noise and scatter of break-away. extra: parameters of the effect, beside those of the law.
synthetic::Record record_of(const FrictionModel& model, const std::vector<double>& extra, std::size_t cycles) {
  std::vector<double> truth = synthetic::table4_15mm(model.law());
  truth.insert(truth.end(), extra.begin(), extra.end());
  synthetic::Options options;
  options.noise = 0.003;
  options.scatter = 0.004;
  options.cycles = cycles;
  options.seed = 5;
  return synthetic::make(model, truth, options);
}

/// A record of a lag, and a place beside its true parameters.
struct LagOffItsTruth {
  FrictionModel model{make_law("exponential"), {make_effect("frictional-lag")}};
  synthetic::Record record = record_of(model, {2e-3}, 20);
  Observations observations = observe(record.motion, record.segmentation, model.needs());
  std::vector<double> p = synthetic::table4_15mm(make_law("exponential"));

  LagOffItsTruth() { p.push_back(2.2e-3); }
};

/// Short records are searched as a whole, long ones on some of their slips or on means.
TEST(Look, IsNearTheFitOnShortAndLongRecords) {
  struct Added {
    const char* effect;
    std::vector<double> extra;
  };
  for (const Added& c : {Added{"frictional-lag", {2e-3}}, Added{"force-bandwidth:first-order", {150}}}) {
    const FrictionModel model(make_law("exponential"), {make_effect(c.effect)});
    for (const std::size_t cycles : {8U, 60U}) {
      const synthetic::Record record = record_of(model, c.extra, cycles);
      const Observations observations = observe(record.motion, record.segmentation, model.needs());
      FitOptions quick;
      quick.starts = 0;
      const Fit full = fit_model(model, record.motion, record.segmentation, observations);
      const Fit look = fit_model(model, record.motion, record.segmentation, observations, {}, quick);
      ASSERT_TRUE(full.converged && look.converged) << c.effect << ' ' << cycles;
      EXPECT_LT(look.error.rmse, 1.01 * full.error.rmse) << c.effect << ' ' << cycles;
      for (std::size_t k = 0; k < full.parameters.size(); ++k) {
        EXPECT_NEAR(look.parameters[k].value, full.parameters[k].value, 0.2 * full.parameters[k].std_error)
            << c.effect << ' ' << cycles << ' ' << full.parameters[k].parameter.name;
      }
    }
  }
}

TEST(NormalEquations, AreTheSameBehindAnEvaluationAndWithoutOne) {
  const LagOffItsTruth lag;
  const auto& [model, record, observations, p] = lag;
  const std::vector<std::size_t> all = all_slips(observations);
  const ModelResiduals::Whitening whitening = ModelResiduals(model, observations, all).whitening_at(p.data());
  ASSERT_GT(whitening.part, 0);
  ModelResiduals fresh(model, observations, all), evaluated(model, observations, all);
  fresh.whiten(whitening, true), evaluated.whiten(whitening, true);
  std::vector<double> elsewhere = p, residual(evaluated.count()), jacobian(evaluated.count() * p.size());
  elsewhere[1] *= 1.1;
  ASSERT_TRUE(evaluated.evaluate(elsewhere.data(), residual.data(), jacobian.data()));
  const auto truth = fresh.normal_equations(p.data());
  ASSERT_EQ(truth.size(), all.size());
  for (const bool again : {false, true}) {  // from elsewhere, then from the same place
    const auto found = evaluated.normal_equations(p.data());
    ASSERT_EQ(found.size(), truth.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_EQ(found[k].curvature, truth[k].curvature) << again;
      EXPECT_EQ(found[k].gradient, truth[k].gradient) << again;
    }
  }
  // Squares with scatter in them are those of values alone, and differ from the whitened ones.
  ModelResiduals unseen(model, observations, all);
  unseen.whiten(whitening, true);
  const double squares = fresh.squares_with_scatter(p.data());
  EXPECT_NEAR(unseen.squares_with_scatter(p.data()), squares, 1e-10 * squares);
  EXPECT_GT(std::abs(unseen.white_squares(p.data()) - squares), 1e-6 * squares);
  // The curvature is that of the rows the solver sees.
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  ASSERT_TRUE(evaluated.evaluate(p.data(), residual.data(), jacobian.data()));
  const Eigen::Map<const RowMajor> j(jacobian.data(), Eigen::Index(evaluated.count()), Eigen::Index(p.size()));
  const Eigen::Map<const Eigen::VectorXd> r(residual.data(), Eigen::Index(residual.size()));
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(j.cols(), j.cols());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(j.cols());
  for (const auto& slip : truth) curvature += slip.curvature, gradient += slip.gradient + slip.level_gradient;
  EXPECT_LT((curvature - j.transpose() * j).norm(), 1e-9 * curvature.norm());
  // Sums of M'M r in parts by slip and through the mean level are the whole gradient.
  EXPECT_LT((gradient - j.transpose() * r).norm(), 1e-6 * (j.transpose().cwiseAbs() * r.cwiseAbs()).norm());
}

/// Wherever it begins, the search for a change ends where all slips, evaluated with the change in each gap between two,
/// leave least.
TEST(BestChange, IsWhereLeastIsLeftWhereverTheSearchBegins) {
  const FrictionModel model(make_law("exponential"), {make_effect("step")});
  const double end = record_of(FrictionModel(make_law("exponential")), {}, 30).motion.time.back();
  const synthetic::Record record = record_of(model, {0.03, 0.37 * end}, 30);
  const Observations observations = observe(record.motion, record.segmentation, model.needs());
  const std::optional<ChangePoint> change = change_point_of(model);
  ASSERT_TRUE(change);
  const Bounds bounds = bounds_of(model, observations);
  std::vector<double> p = synthetic::table4_15mm(make_law("exponential"));
  p.insert(p.end(), {0.03, 0.0});
  for (const double begin : {0.02, 0.2, 0.36, 0.37, 0.38, 0.6, 0.98}) {
    p[change->time] = begin * end;
    ModelResiduals residuals(model, observations, all_slips(observations));
    const ModelResiduals::Whitening whitening = residuals.whitening_at(p.data());
    residuals.whiten(whitening);
    const double found = best_change(*change, residuals, observations, bounds, p, 1);
    double least = std::numeric_limits<double>::infinity();
    std::vector<double> at = p;
    for (std::size_t k = 1; k < observations.slips.size(); ++k) {
      at[change->time] =
          0.5 * (observations.time[observations.slips[k - 1].end - 1] + observations.time[observations.slips[k].begin]);
      least = std::min(least, residuals.white_squares(at.data()));
    }
    at[change->time] = found;
    EXPECT_LE(residuals.white_squares(at.data()), least * (1 + 1e-9)) << begin;
    EXPECT_NEAR(found, 0.37 * end, end / 30) << begin;
  }
}

/// Held-out errors are those of every sample of a cycle under the parameters without it, whether values are samples,
/// or not, or samples are spoilt.
TEST(HeldOutErrors, AreThoseOfSamples) {
  const FrictionModel model(make_law("exponential"), {make_effect("frictional-lag")});
  synthetic::Record record = record_of(model, {2e-3}, 20);
  for (const bool spoilt : {false, true}) {
    if (spoilt) {
      record.motion.faults.assign(record.motion.size(), 0);
      record.motion.faults[record.segmentation.cycles[3].slip.begin + 5] = SampleFault::friction;
    }
    const Record one = {&record.motion, &record.segmentation};
    for (const auto& [starts, values] : {std::pair(0, 0U), {3, 0U}, {0, 80U}, {3, 80U}}) {
      const Observations observations = observe(record.motion, record.segmentation, model.needs(), values);
      ASSERT_EQ(observations.samples_per_value == 1, values == 0);
      FitOptions options;
      options.starts = starts;
      const Fit fit = fit_model(model, record.motion, record.segmentation, observations, {}, options);
      double squares = 0, counts = 0;
      for (std::size_t fold = 0; fold < fit.fold_parameters.size(); ++fold) {
        const FullRecord full(std::span(&one, 1), observations, model.needs());
        const SampleErrors errors = sample_errors(model, fit.fold_parameters[fold], full, observations);
        for (std::size_t c = 0; c < errors.squares.size(); ++c) {
          if (fit.cycle_folds[c] == fold) squares += errors.squares[c], counts += errors.counts[c];
        }
      }
      const double truth = std::sqrt(squares / counts), near = values == 0 && !spoilt ? 1e-9 : 1e-4;
      EXPECT_NEAR(fit.error.held_out_rmse, truth, near * truth) << spoilt << starts << values;
    }
  }
}

}  // namespace
