#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ceres_parts.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit {

namespace {

/// The residuals of one part as one cost of several parameter blocks: R of the QR of [J r].
class PartCost : public ceres::CostFunction {
 public:
  /// blocks: parameters of the part in each block of Ceres; the others stay at `p`.
  PartCost(const ResidualPart& part, std::vector<double> p, std::vector<std::vector<std::size_t>> blocks)
      : part_(part), p_(std::move(p)), blocks_(std::move(blocks)) {
    set_num_residuals(static_cast<int>(p_.size() + 1));
    for (const auto& block : blocks_) mutable_parameter_block_sizes()->push_back(static_cast<int>(block.size()));
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    std::vector<double> p = p_;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (std::size_t k = 0; k < blocks_[b].size(); ++k) p[blocks_[b][k]] = blocks[b][k];
    }
    const auto rows = static_cast<Eigen::Index>(part_.residuals->count()), n = static_cast<Eigen::Index>(p.size());
    Eigen::VectorXd residual(rows);
    std::fill_n(residuals, num_residuals(), 0.0);
    if (jacobians == nullptr) {
      if (!evaluate_unless_stopped(*part_.residuals, p.data(), residual.data(), nullptr)) return false;
      residuals[0] = part_.root_weight * residual.norm();
      return true;
    }
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows, n);
    if (!evaluate_unless_stopped(*part_.residuals, p.data(), residual.data(), jacobian.data())) return false;
    Eigen::MatrixXd all(rows, n + 1);
    all << jacobian, residual;
    const Eigen::MatrixXd kept = part_.root_weight * triangular_factor(all);
    for (Eigen::Index i = 0; i < kept.rows(); ++i) residuals[i] = kept(i, n);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      const std::size_t width = blocks_[b].size();
      for (std::size_t i = 0; i <= p.size(); ++i) {
        for (std::size_t k = 0; k < width; ++k)
          jacobians[b][i * width + k] = kept(Eigen::Index(i), Eigen::Index(blocks_[b][k]));
      }
    }
    return true;
  }

 private:
  const ResidualPart& part_;
  std::vector<double> p_;
  std::vector<std::vector<std::size_t>> blocks_;
};

/// The values as blocks of Ceres: those that one part alone depends on as one block of it, each other by itself.
class Blocks {
 public:
  Blocks(std::span<const ResidualPart> parts, std::span<const double> start, std::span<const double> lower,
         std::span<const double> upper)
      : all_(start.begin(), start.end()), lower_(lower), upper_(upper), users_(start.size(), 0) {
    for (const ResidualPart& part : parts) {
      for (const std::size_t value : part.values) ++users_[value];
    }
    own_.resize(parts.size());
    for (std::size_t r = 0; r < parts.size(); ++r) {
      for (const std::size_t value : parts[r].values) {
        if (is_free(value) && users_[value] == 1) own_[r].push_back(all_[value]);
      }
    }
  }

  void add(const ResidualPart& part, std::size_t r, ceres::Problem& problem, ceres::ParameterBlockOrdering& order) {
    std::vector<std::vector<std::size_t>> blocks;
    std::vector<double*> data;
    if (!own_[r].empty()) {
      blocks.emplace_back();
      data.push_back(own_[r].data());
    }
    std::vector<double> p;
    for (std::size_t k = 0; k < part.values.size(); ++k) {
      const std::size_t value = part.values[k];
      p.push_back(all_[value]);
      if (!is_free(value)) continue;
      if (users_[value] == 1) {
        blocks.front().push_back(k);
        continue;
      }
      blocks.push_back({k});
      data.push_back(&all_[value]);
    }
    if (data.empty()) return;
    const std::size_t first_common = own_[r].empty() ? 0 : 1;
    problem.AddResidualBlock(new PartCost(part, p, blocks), nullptr, data);  // owned by the problem
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      order.AddElementToGroup(data[b], b < first_common ? 0 : 1);
      for (std::size_t k = 0; k < blocks[b].size(); ++k) {
        const std::size_t value = part.values[blocks[b][k]];
        if (std::isfinite(lower_[value])) problem.SetParameterLowerBound(data[b], int(k), lower_[value]);
        if (std::isfinite(upper_[value])) problem.SetParameterUpperBound(data[b], int(k), upper_[value]);
      }
    }
  }

  bool any_own() const {
    return std::any_of(own_.begin(), own_.end(), [](const auto& own) { return !own.empty(); });
  }

  std::vector<double> values(std::span<const ResidualPart> parts) const {
    std::vector<double> out = all_;
    for (std::size_t r = 0; r < parts.size(); ++r) {
      std::size_t k = 0;
      for (const std::size_t value : parts[r].values) {
        if (is_free(value) && users_[value] == 1) out[value] = own_[r][k++];
      }
    }
    return out;
  }

 private:
  bool is_free(std::size_t value) const { return lower_[value] < upper_[value]; }

  std::vector<double> all_;
  std::span<const double> lower_, upper_;
  std::vector<int> users_;
  std::vector<std::vector<double>> own_;  // of each part
};

}  // namespace

Minimum minimize(std::span<const ResidualPart> parts, std::span<const double> start, std::span<const double> lower,
                 std::span<const double> upper, const SolverOptions& options) {
  const QuietLogging quiet;
  Blocks blocks(parts, start, lower, upper);
  ceres::Problem problem;
  auto order = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t r = 0; r < parts.size(); ++r) blocks.add(parts[r], r, problem, *order);
  Minimum result;
  result.p.assign(start.begin(), start.end());
  if (problem.NumResidualBlocks() == 0) {
    result.message = "nothing to fit";
    return result;
  }
  ceres::Solver::Options solver = ceres_options(options);
  solver.linear_solver_type = blocks.any_own() ? ceres::DENSE_SCHUR : ceres::DENSE_QR;
  if (blocks.any_own()) solver.linear_solver_ordering = order;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  stop_point();
  result.p = blocks.values(parts);
  result.cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = static_cast<int>(summary.iterations.size());
  result.message = explain(summary);
  return result;
}

}  // namespace tribofit
