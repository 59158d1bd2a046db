/// The statistics of the diagnosis on problems whose answers are known: linear ones, refitted by brute force, and noise
/// with nothing in it.
#include "diagnosis/held_out.hpp"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numeric>

namespace {

using namespace tribofit::diagnosis;

/// Rows [J r] of cycles whose residuals are noise correlated by `colour` from row to row, across cycles too.
struct Problem {
  std::size_t cycles = 40;
  Eigen::Index rows = 12, columns = 3;
  double colour = 0;
  bool constant = false;  ///< the first column is one everywhere: its parameter is a mean
};

Linearised draw(const Problem& problem, boost::random::mt19937_64& engine) {
  boost::random::normal_distribution<double> normal;
  Linearised out;
  out.free.assign(static_cast<std::size_t>(problem.columns), true);
  double state = normal(engine);
  for (std::size_t c = 0; c < problem.cycles; ++c) {
    Eigen::MatrixXd rows(problem.rows, problem.columns + 1);
    for (Eigen::Index i = 0; i < problem.rows; ++i) {
      for (Eigen::Index j = 0; j < problem.columns; ++j) rows(i, j) = problem.constant && j == 0 ? 1 : normal(engine);
      rows(i, problem.columns) = state;
      state = problem.colour * state + std::sqrt(1 - problem.colour * problem.colour) * normal(engine);
    }
    out.rows.push_back(std::move(rows));
  }
  return out;
}

Blocks blocks_of(std::size_t cycles, std::size_t count) {
  std::vector<std::size_t> block_of_cycle;
  for (std::size_t c = 0; c < cycles; ++c) block_of_cycle.push_back(c * count / cycles);
  return Blocks(std::move(block_of_cycle));
}

/// Least squares over the cycles kept, by QR of the stacked rows.
Eigen::VectorXd refit(const Linearised& problem, const std::vector<bool>& kept) {
  const Eigen::Index n = problem.rows[0].cols() - 1, each = problem.rows[0].rows();
  Eigen::MatrixXd stacked(0, n + 1);
  for (std::size_t c = 0; c < problem.rows.size(); ++c) {
    if (!kept[c]) continue;
    stacked.conservativeResize(stacked.rows() + each, Eigen::NoChange);
    stacked.bottomRows(each) = problem.rows[c];
  }
  return stacked.leftCols(n).colPivHouseholderQr().solve(-stacked.col(n));
}

TEST(Evidence, HeldOutSquaresAreThoseOfRefitsWithoutTheBlock) {
  boost::random::mt19937_64 engine(1);
  const Linearised problem = draw({}, engine);
  const Blocks blocks = blocks_of(problem.rows.size(), 8);
  const std::vector<double> held_out = held_out_squares(problem, blocks);
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    std::vector<bool> kept;
    for (std::size_t c = 0; c < problem.rows.size(); ++c) kept.push_back(blocks.of(c) != b);
    const std::vector<double> expected = squares_after(problem, refit(problem, kept));
    for (std::size_t c = 0; c < kept.size(); ++c) {
      if (!kept[c]) {
        EXPECT_NEAR(held_out[c], expected[c], 1e-9 * expected[c]);
      }
    }
  }
}

TEST(Evidence, AParameterThatIsHeldDoesNotMove) {
  boost::random::mt19937_64 engine(2);
  Linearised problem = draw({}, engine);
  problem.free[1] = false;
  const Eigen::VectorXd step = gauss_newton_step(problem);
  EXPECT_EQ(step(1), 0);
  for (Eigen::MatrixXd& rows : problem.rows) rows.col(1).setZero();
  const Eigen::VectorXd expected = refit(problem, std::vector<bool>(problem.rows.size(), true));
  EXPECT_NEAR(step(0), expected(0), 1e-9);
  EXPECT_NEAR(step(2), expected(2), 1e-9);
}

TEST(Evidence, ABoundedStepIsTheBestWithinItsBounds) {
  boost::random::mt19937_64 engine(3);
  const Linearised problem = draw({}, engine);
  const Eigen::VectorXd wide = Eigen::VectorXd::Constant(3, 10), free = bounded_step(problem, -wide, wide);
  EXPECT_LT((free - gauss_newton_step(problem)).norm(), 1e-9);
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
      mean += design_effect(draw(shape, engine), 0, 1.0, tribofit::SlowNoise()).of_cycles / kRuns;
    }
    const double truth = (1 + rho) / (1 - rho);
    // At least 1 by definition, which lifts the mean where the truth is 1.
    EXPECT_NEAR(mean, rho > 0 ? truth : 1.1, 0.15 * truth) << rho;
  }
}

/// Of the mean of levels with a slow part of known covariance: 1 + (sum of the covariances) / (n noise / rows).
TEST(Evidence, TheDesignEffectHoldsSlowNoise) {
  boost::random::mt19937_64 engine(5);
  Linearised problem = draw({40, 20, 1, 0, true}, engine);
  problem.level = Eigen::VectorXd::Ones(1);
  tribofit::SlowNoise slow;
  double sum = 0;
  for (int k = 0; k < 40; ++k) {
    slow.covariance.push_back(0.3 * std::pow(0.9, k));
    sum += (k == 0 ? 1 : 2) * (40 - k) * slow.covariance.back();
  }
  EXPECT_NEAR(design_effect(problem, 0, 1.0, slow).of_slow, 1 + sum / 40 * 20, 1e-9 * sum);
}

TEST(Evidence, PValuesOfNothingAreUniform) {
  constexpr int kRuns = 2000;
  int below5 = 0, below1 = 0;
  for (int run = 0; run < kRuns; ++run) {
    boost::random::mt19937_64 engine(static_cast<std::uint64_t>(run));
    const Linearised richer = draw({20, 10, 2, 0, false}, engine);
    Linearised poorer = richer;
    poorer.free[1] = false;
    const double before = sum(squares_after(poorer, gauss_newton_step(poorer)));
    const double after = sum(squares_after(richer, gauss_newton_step(richer)));
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
