/// The statistics of the diagnosis on problems whose answers are known: linear ones, refitted by brute force, and noise
/// with nothing in it.
#include "diagnosis/evidence.hpp"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numeric>

namespace {

using namespace tribofit;
using namespace tribofit::diagnosis;

/// Rows [J r] of cycles whose residuals are noise correlated by `colour` from row to row, across cycles too.
struct Problem {
  std::size_t cycles = 40;
  Eigen::Index rows = 12, columns = 3;
  double colour = 0;
  bool constant = false;  ///< the first column is one everywhere: its parameter is a mean
};

std::vector<Eigen::MatrixXd> draw(const Problem& problem, boost::random::mt19937_64& engine) {
  boost::random::normal_distribution<double> normal;
  std::vector<Eigen::MatrixXd> out;
  double state = normal(engine);
  for (std::size_t c = 0; c < problem.cycles; ++c) {
    Eigen::MatrixXd rows(problem.rows, problem.columns + 1);
    for (Eigen::Index i = 0; i < problem.rows; ++i) {
      for (Eigen::Index j = 0; j < problem.columns; ++j) rows(i, j) = problem.constant && j == 0 ? 1 : normal(engine);
      rows(i, problem.columns) = state;
      state = problem.colour * state + std::sqrt(1 - problem.colour * problem.colour) * normal(engine);
    }
    out.push_back(std::move(rows));
  }
  return out;
}

/// Least squares over the cycles kept, by QR of the stacked rows.
Eigen::VectorXd refit(const std::vector<Eigen::MatrixXd>& problem, const std::vector<bool>& kept) {
  const Eigen::Index n = problem[0].cols() - 1, each = problem[0].rows();
  Eigen::MatrixXd stacked(0, n + 1);
  for (std::size_t c = 0; c < problem.size(); ++c) {
    if (!kept[c]) continue;
    stacked.conservativeResize(stacked.rows() + each, Eigen::NoChange);
    stacked.bottomRows(each) = problem[c];
  }
  return stacked.leftCols(n).colPivHouseholderQr().solve(-stacked.col(n));
}

const std::vector<bool> kAllFree(3, true);

TEST(Evidence, HeldOutSquaresAreThoseOfRefitsWithoutTheBlock) {
  boost::random::mt19937_64 engine(1);
  const std::vector<Eigen::MatrixXd> problem = draw({}, engine);
  constexpr std::size_t kBlocks = 8;
  std::vector<std::size_t> blocks;
  for (std::size_t c = 0; c < problem.size(); ++c) blocks.push_back(c * kBlocks / problem.size());
  const std::vector<double> held_out = held_out_squares(evidence_of(problem), kAllFree, blocks);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    std::vector<bool> kept;
    for (const std::size_t own : blocks) kept.push_back(own != b);
    const Eigen::VectorXd step = refit(problem, kept);
    for (std::size_t c = 0; c < kept.size(); ++c) {
      const double expected = (problem[c].leftCols(3) * step + problem[c].col(3)).squaredNorm();
      if (!kept[c]) {
        EXPECT_NEAR(held_out[c], expected, 1e-9 * expected);
      }
    }
  }
}

TEST(Evidence, AParameterThatIsHeldDoesNotMove) {
  boost::random::mt19937_64 engine(2);
  std::vector<Eigen::MatrixXd> problem = draw({}, engine);
  const Eigen::VectorXd step = gauss_newton_step(evidence_of(problem), {true, false, true});
  EXPECT_EQ(step(1), 0);
  for (Eigen::MatrixXd& rows : problem) rows.col(1).setZero();
  const Eigen::VectorXd expected = refit(problem, std::vector<bool>(problem.size(), true));
  EXPECT_NEAR(step(0), expected(0), 1e-9);
  EXPECT_NEAR(step(2), expected(2), 1e-9);
}

TEST(Evidence, ABoundedStepIsTheBestWithinItsBounds) {
  boost::random::mt19937_64 engine(3);
  const CycleEvidence problem = evidence_of(draw({}, engine));
  const Eigen::VectorXd wide = Eigen::VectorXd::Constant(3, 10), free = bounded_step(problem, -wide, wide);
  EXPECT_LT((free - gauss_newton_step(problem, kAllFree)).norm(), 1e-9);
  Eigen::VectorXd upper = wide, lower = -wide;
  (free(0) > 0 ? upper : lower)(0) = 0.5 * free(0);
  const Eigen::VectorXd bounded = bounded_step(problem, lower, upper);
  EXPECT_NEAR(bounded(0), 0.5 * free(0), 1e-12);
  const double least = sum(squares_after(problem, bounded));
  for (const double by : {-1e-3, 1e-3}) {  // no neighbour within the bounds is better
    for (const Eigen::Index k : {1, 2}) {
      Eigen::VectorXd other = bounded;
      other(k) += by;
      EXPECT_GT(sum(squares_after(problem, other)), least);
    }
  }
}

TEST(Evidence, TheDesignEffectIsThatOfAnAutoregression) {
  // The mean of AR(1) noise has (1 + rho)/(1 - rho) times the variance of that of white noise.
  for (const double rho : {0.0, 0.5, 0.8}) {
    double mean = 0;
    constexpr int kRuns = 60;
    for (int run = 0; run < kRuns; ++run) {
      boost::random::mt19937_64 engine(static_cast<std::uint64_t>(100 + run));
      const Problem shape = {100, 20, 1, rho, true};
      mean += design_effect(evidence_of(draw(shape, engine)), {true}, 0, 1, 1.0, SlowNoise()).of_cycles / kRuns;
    }
    const double truth = (1 + rho) / (1 - rho);
    // At least 1 by definition, which lifts the mean where the truth is 1.
    EXPECT_NEAR(mean, rho > 0 ? truth : 1.1, 0.15 * truth) << rho;
  }
}

/// Of the mean of levels with a slow part of known covariance: 1 + (sum of the covariances) / (n noise / rows).
TEST(Evidence, TheDesignEffectHoldsSlowNoise) {
  boost::random::mt19937_64 engine(5);
  CycleEvidence problem = evidence_of(draw({40, 20, 1, 0, true}, engine));
  problem.level = Eigen::VectorXd::Ones(1);
  SlowNoise slow;
  double sum = 0;
  for (int k = 0; k < 40; ++k) {
    slow.covariance.push_back(0.3 * std::pow(0.9, k));
    sum += (k == 0 ? 1 : 2) * (40 - k) * slow.covariance.back();
  }
  EXPECT_NEAR(design_effect(problem, {true}, 0, 1, 1.0, slow).of_slow, 1 + sum / 40 * 20, 1e-9 * sum);
}

TEST(Evidence, PValuesOfNothingAreUniform) {
  constexpr int kRuns = 2000;
  int below5 = 0, below1 = 0;
  for (int run = 0; run < kRuns; ++run) {
    boost::random::mt19937_64 engine(static_cast<std::uint64_t>(run));
    const CycleEvidence evidence = evidence_of(draw({20, 10, 2, 0, false}, engine));
    const double before = sum(squares_after(evidence, gauss_newton_step(evidence, {true, false})));
    const double after = sum(squares_after(evidence, gauss_newton_step(evidence, {true, true})));
    const double freedom = 20 * 10 - 2;
    const double p = fall_p_value(before - after, 1, after / freedom, 1, freedom);
    below5 += p < 0.05 ? 1 : 0;
    below1 += p < 0.01 ? 1 : 0;
  }
  // Within three standard deviations of a binomial.
  EXPECT_NEAR(below5, 0.05 * kRuns, 3 * std::sqrt(0.05 * 0.95 * kRuns));
  EXPECT_NEAR(below1, 0.01 * kRuns, 3 * std::sqrt(0.01 * 0.99 * kRuns));
}

TEST(Evidence, NoFallIsNoEvidence) {
  EXPECT_EQ(fall_p_value(-1, 1, 1, 1, 10), 1);
  EXPECT_EQ(fall_p_value(1, 1, 0, 1, 10), 1);
  EXPECT_GT(fall_p_value(10, 1, 1, 5, 10), fall_p_value(10, 1, 1, 1, 10));
}

}  // namespace
