#include "shared_parts.hpp"

#include <algorithm>
#include <cmath>

#include "fit_context.hpp"

namespace tribofit::sharing {

namespace {

/// Part of what a record knows of a value that rounding leaves where a value of its own takes all of it.
constexpr double kRounding = 1e-10;

}  // namespace

/// Rows and columns `index` of a matrix.
MatrixXd block_of(const MatrixXd& matrix, const std::vector<Index>& rows, const std::vector<Index>& columns) {
  MatrixXd out(rows.size(), columns.size());
  for (Index i = 0; i < out.rows(); ++i) {
    for (Index j = 0; j < out.cols(); ++j) out(i, j) = matrix(rows[at(i)], columns[at(j)]);
  }
  return out;
}

VectorXd rows_of(const VectorXd& all, const std::vector<Index>& rows) {
  VectorXd out(rows.size());
  for (Index i = 0; i < out.size(); ++i) out(i) = all(rows[at(i)]);
  return out;
}

MatrixXd Part::own_inverse(const MatrixXd& curvature) const {
  return block_of(inverse_over(curvature, own_free), own, own);
}

MatrixXd Part::reduced(const MatrixXd& curvature) const {
  const MatrixXd across = block_of(curvature, common, own);
  MatrixXd out = block_of(curvature, common, common) - across * own_inverse(curvature) * across.transpose();
  for (Index k = 0; k < out.rows(); ++k) {
    if (out(k, k) > kRounding * curvature(common[at(k)], common[at(k)])) continue;
    out.row(k).setZero();
    out.col(k).setZero();
  }
  return out;
}

VectorXd Part::reduced(const VectorXd& gradient) const {
  const MatrixXd across = block_of(equations.total, common, own);
  return rows_of(gradient, common) - across * (own_inverse(equations.total) * rows_of(gradient, own));
}

Part part_at(const Problem& problem, const Member& member, std::vector<double> p) {
  Part out;
  out.member = &member;
  out.p = std::move(p);
  out.equations = normal_equations(member.residuals, *member.record.observations, out.p);
  for (MatrixXd& c : out.equations.curvature) c *= member.weight;
  for (VectorXd& g : out.equations.gradient) g *= member.weight;
  for (VectorXd& g : out.equations.level_gradient) g *= member.weight;
  out.equations.total *= member.weight;
  const std::vector<bool> unconstrained = out.equations.unconstrained();
  std::vector<bool> own_inside;
  for (std::size_t k = 0; k < out.p.size(); ++k) {
    const double lower = problem.lower[member.index[k]], upper = problem.upper[member.index[k]];
    const bool own = member.record.common[k] == SharingRecord::kOwn;
    out.free.push_back(!unconstrained[k] && lower < upper);
    out.own_free.push_back(own && out.free[k]);
    own_inside.push_back(out.own_free[k] && !on_bound(out.p[k], lower, upper));
  }
  out.open.assign(out.p.size(), false);
  const std::vector<bool> all_inside = own_inside;
  for (const auto& group : undetermined(out.equations.total, own_inside)) {
    for (const std::size_t k : group) out.open[k] = true;
  }
  for (std::size_t k = 0; k < out.p.size(); ++k) {
    const bool spare = own_inside[k] != all_inside[k];
    out.free[k] = out.free[k] && !spare;
    out.own_free[k] = out.own_free[k] && !spare;
    if (out.own_free[k]) out.own.push_back(static_cast<Index>(k));
    if (!out.free[k] || out.own_free[k]) continue;
    out.common.push_back(static_cast<Index>(k));
    out.values.push_back(static_cast<Index>(member.index[k]));
  }
  return out;
}

void add_to(MatrixXd& all, const std::vector<Index>& index, const MatrixXd& part) {
  for (Index i = 0; i < part.rows(); ++i) {
    for (Index j = 0; j < part.cols(); ++j) all(index[at(i)], index[at(j)]) += part(i, j);
  }
}

Common common_of(const Problem& problem, const std::vector<Part>& parts, const std::vector<double>& values) {
  const auto count = static_cast<Index>(problem.common_count);
  Common out;
  out.information = MatrixXd::Zero(count, count);
  for (const Part& part : parts) add_to(out.information, part.values, part.reduced(part.equations.total));
  std::vector<bool> inside;
  for (std::size_t c = 0; c < problem.common_count; ++c) {
    out.free.push_back(out.information(Index(c), Index(c)) > 0 && problem.lower[c] < problem.upper[c]);
    inside.push_back(out.free[c] && !on_bound(values[c], problem.lower[c], problem.upper[c]));
  }
  const std::vector<bool> all_inside = inside;
  out.open.assign(problem.common_count, false);
  for (const auto& group : undetermined(out.information, inside)) {
    for (const std::size_t k : group) out.open[k] = true;
  }
  for (std::size_t c = 0; c < problem.common_count; ++c) out.free[c] = out.free[c] && inside[c] == all_inside[c];
  out.inverse = inverse_over(out.information, out.free);
  return out;
}

void drop_open(const Common& common, Part& part) {
  std::vector<Index> kept, values;
  for (std::size_t k = 0; k < part.common.size(); ++k) {
    if (common.free[at(part.values[k])]) {
      kept.push_back(part.common[k]);
      values.push_back(part.values[k]);
    } else {
      part.free[at(part.common[k])] = false;
    }
  }
  part.common = std::move(kept);
  part.values = std::move(values);
}

SlowLevels slow_levels_of(const Problem& problem, const Part& part, const NormalEquations& equations) {
  const double flicker = part.member->record.observations->flicker;
  const bool shows = flicker > 0 || part.common.empty();
  if (part.member->record.is_points || !shows) return {};
  return slow_levels(equations, level_change(problem.model, part.p), part.free, flicker);
}

}  // namespace tribofit::sharing
