#include "model_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dual.hpp"
#include "statistics/linear_algebra.hpp"
#include "stick_evidence.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/friction/creep.hpp"

namespace tribofit {

namespace {

/// sign(r) sqrt(rho(r^2)) for a residual whose weight has the square root given.
template <class T>
T robust_residual(const T& r, const ModelResiduals::Options& options, double root_weight) {
  using std::abs;
  using std::sqrt;
  if (options.loss == Loss::squares || options.loss_width <= 0) return r;
  const double s = options.loss_width * root_weight;
  const T u = abs(r) / s;
  T root = u;
  if (options.loss == Loss::huber) {
    if (scalar_part(u) > 1) root = sqrt(2.0 * u - 1.0);
  } else if (scalar_part(u) > 1e-8) {
    root = sqrt(2.0 * (sqrt(1.0 + u * u) - 1.0));
  }
  return scalar_part(r) < 0 ? T(-s * root) : T(s * root);
}

}  // namespace

std::vector<std::size_t> all_slips(const Observations& observations) {
  std::vector<std::size_t> slips(observations.slips.size());
  std::iota(slips.begin(), slips.end(), std::size_t{0});
  return slips;
}

ModelResiduals::ModelResiduals(const FrictionModel& model, const Observations& observations,
                               std::vector<std::size_t> slips, const Options& options)
    : model_(model), observations_(observations), slips_(std::move(slips)), options_(options) {
  if (observations_.sticks.empty() || !model_.acts_in_stick()) return;
  const CreepLaw law = creep_law(model_);
  first_part_ = law.first_part;
  weights_ = stick_weights(observations_, law);
}

/// Weighted differences between v_r and the creep of the model in the stick before a slip.
template <class T>
void ModelResiduals::add_stick_residuals(const Observations::SlipObservation& range, const T* p,
                                         std::vector<T>& rows) const {
  const auto n = static_cast<std::size_t>(stick_rows(range));
  if (n == 0) return;
  const std::size_t first = rows.size();
  rows.resize(first + n, T(0.0 * p[0]));
  const Eigen::MatrixXd& weights = weights_[range.record];
  const StickCreep& stick = observations_.sticks[range.stick];
  const Slip slip = observations_.slip(range);
  for (std::size_t k = 0; k + first_part_ < stick.parts.size(); ++k) {
    const StickPart& part = stick.parts[first_part_ + k];
    const T left = part.relative_velocity -
                   creep_in_stick(model_, p, slip, StickMoment{part.friction, part.friction_rate, range.disc_speed});
    for (std::size_t j = 0; j < n; ++j) rows[first + j] += weights(Eigen::Index(j), Eigen::Index(k)) * left;
  }
}

template <class T>
bool ModelResiduals::run(const Observations::SlipObservation& range, const T* p, double level,
                         Arrays<T>& arrays) const {
  if (level != 0) {
    arrays.at_level.assign(p, p + parameter_count());
    arrays.at_level[0] += level;
    p = arrays.at_level.data();
  }
  const Slip slip = observations_.slip(range);
  const std::size_t n = slip.size();
  std::vector<T>& rows = arrays.rows;
  rows.resize(n);
  arrays.mu.resize(n);
  arrays.velocity.resize(n);
  for (std::size_t i = 0; i < n; ++i) arrays.velocity[i] = T(slip.velocity[i]);
  tribofit::evaluate<T>(model_, p, slip, arrays.velocity, arrays.mu);
  for (std::size_t i = 0; i < n; ++i) {
    const double root_weight = observations_.root_weight[range.begin + i];
    rows[i] = root_weight * (observations_.friction[range.begin + i] - arrays.mu[i]);
  }
  if (range.from_stick) {
    const double read = range.read_at_break_away(model_.acts_in_stick());
    rows.push_back(range.break_away_root_weight * (read - break_away_level(model_, p, slip)));
  }
  if (options_.loss != Loss::squares) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double root_weight = i < n ? observations_.root_weight[range.begin + i] : range.break_away_root_weight;
      rows[i] = robust_residual(rows[i], options_, root_weight);
    }
  }
  add_stick_residuals(range, p, rows);
  return std::all_of(rows.begin(), rows.end(), [](const T& r) { return std::isfinite(scalar_part(r)); });
}

template <std::size_t N>
bool ModelResiduals::differentiate(const Observations::SlipObservation& range, const double* p, double level,
                                   std::size_t first, std::size_t derivatives, Arrays<Dual<N>>& arrays,
                                   Block& block) const {
  const std::size_t last = std::min(derivatives, first + N);
  arrays.p.clear();
  for (std::size_t j = 0; j < parameter_count(); ++j) {
    arrays.p.push_back(j >= first && j < last ? Dual<N>(p[j], j - first) : Dual<N>(p[j]));
  }
  if (!run(range, arrays.p.data(), level, arrays)) return false;
  for (std::size_t i = 0; i < arrays.rows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    block(row, Eigen::Index(derivatives)) = arrays.rows[i].a;
    for (std::size_t j = first; j < last; ++j) block(row, Eigen::Index(j)) = arrays.rows[i].v[j - first];
  }
  return true;
}

bool ModelResiduals::fill(std::size_t k, const double* p, std::size_t derivatives, Workspace& workspace, Block& block,
                          bool plain) const {
  stop_point();
  const bool whitens = whitening_ != nullptr && whitening_->any() && !plain;
  const double level = whitens && own_levels_ ? whitening_->level[slips_[k]] : 0;
  const auto& range = observations_.slips[slips_[k]];
  const auto residual = static_cast<Eigen::Index>(derivatives);
  block.resize(friction_rows(range) + stick_rows(range), residual + 2);
  if (derivatives == 0) {
    std::vector<double>& rows = workspace.values.rows;
    if (!run(range, p, level, workspace.values)) return false;
    std::copy(rows.begin(), rows.end(), block.col(0).begin());
  }
  for (std::size_t first = 0; first < derivatives;) {
    // As few passes as eight derivatives each allow, and none wider than it has to be.
    const std::size_t left = derivatives - first, passes = (left + 7) / 8, even = (left + passes - 1) / passes;
    const std::size_t width = even <= 2 ? 2 : even <= 4 ? 4 : even <= 6 ? 6 : 8;
    const bool finite = width == 2   ? differentiate(range, p, level, first, derivatives, workspace.two, block)
                        : width == 4 ? differentiate(range, p, level, first, derivatives, workspace.four, block)
                        : width == 6 ? differentiate(range, p, level, first, derivatives, workspace.six, block)
                                     : differentiate(range, p, level, first, derivatives, workspace.eight, block);
    if (!finite) return false;
    first += width;
  }
  block.col(residual + 1).setZero();  // the scatter of stick is in its own noise
  if (whitens) {
    const Eigen::VectorXd& g = whitening_->g[slips_[k]];
    block.col(residual + 1).head(g.size()) = g;
    if (level != 0) block.col(residual).head(g.size()) -= level * g;
  }
  return true;
}

bool ModelResiduals::compressed(const double* p, bool with_jacobian, std::vector<Block>& blocks,
                                const FurtherColumns& further) const {
  blocks.resize(slips_.size());
  return in_parts([&](const ModelResiduals& own, std::size_t begin, std::size_t end) {
    return own.compress(begin, end, p, with_jacobian, blocks, further);
  });
}

std::size_t ModelResiduals::parts() const {
  constexpr std::size_t kWorthAThread = 2000;  // values: a fraction of a millisecond, a few times what a thread costs
  if (options_.threads == 1) return 1;
  std::size_t values = 0;
  for (const std::size_t k : slips_) values += observations_.slips[k].end - observations_.slips[k].begin;
  const auto threads = static_cast<std::size_t>(options_.threads > 0 ? options_.threads : available_threads());
  return std::clamp<std::size_t>(values / kWorthAThread, 1, std::min(threads, std::max<std::size_t>(1, slips_.size())));
}

bool ModelResiduals::compress(std::size_t begin, std::size_t end, const double* p, bool with_jacobian,
                              std::vector<Block>& blocks, const FurtherColumns& further) const {
  Workspace workspace;
  Block block;
  for (std::size_t k = begin; k < end; ++k) {
    if (!fill(k, p, with_jacobian ? parameter_count() : 0, workspace, block)) return false;
    if (further) {
      Block more = further(slips_[k]);
      const auto& range = observations_.slips[slips_[k]];
      for (std::size_t i = range.begin; i < range.end; ++i) {
        more.row(static_cast<Eigen::Index>(i - range.begin)) *= observations_.root_weight[i];
      }
      if (range.from_stick) more.row(more.rows() - 1) *= range.break_away_root_weight;
      more.conservativeResize(block.rows(), Eigen::NoChange);
      more.bottomRows(stick_rows(range)).setZero();
      Block wider(block.rows(), block.cols() + more.cols());
      wider << block.leftCols(block.cols() - 2), more, block.rightCols(2);
      block = std::move(wider);
    }
    if (whitening_ != nullptr && whitening_->slow > 0) whiten_level(whitening_->u[slips_[k]], block);
    triangular_factor(block, blocks[k]);
  }
  return true;
}

bool ModelResiduals::was_evaluated(const double* p) const {
  return cache_.last.p.size() == parameter_count() && std::equal(cache_.last.p.begin(), cache_.last.p.end(), p);
}

const std::vector<ModelResiduals::Block>* ModelResiduals::white_blocks(const double* p) const {
  const std::size_t n = parameter_count();
  if (was_evaluated(p)) return &cache_.last.blocks;
  std::vector<Block> blocks = std::exchange(cache_.last, {}).blocks;
  if (!compressed(p, true, blocks)) return nullptr;
  Eigen::MatrixXd added = corrections(blocks);
  for (Eigen::Index k = 0; k < added.cols(); ++k) add_to(blocks[static_cast<std::size_t>(k)], k, added);
  cache_.last = {{p, p + n}, std::move(blocks), std::move(added)};
  return &cache_.last.blocks;
}

bool ModelResiduals::evaluate(const double* p, double* residual, double* jacobian) const {
  if (jacobian == nullptr) {
    if (!compressed(p, false, cache_.without_slopes)) return false;
    const std::vector<double> squares = squares_of(cache_.without_slopes);
    std::fill_n(residual, count(), 0.0);
    for (std::size_t k = 0; k < squares.size(); ++k) residual[k * rows_per_slip()] = std::sqrt(squares[k]);
    return true;
  }
  const std::vector<Block>* blocks = white_blocks(p);
  if (blocks == nullptr) return false;
  const auto n = static_cast<Eigen::Index>(parameter_count());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (std::size_t k = 0; k < blocks->size(); ++k) {
    const Block& block = (*blocks)[k];
    Eigen::Map<Eigen::VectorXd>(residual + k * rows_per_slip(), n + 2) = block.col(n);
    Eigen::Map<RowMajor>(jacobian + k * rows_per_slip() * std::size_t(n), n + 2, n) = block.leftCols(n);
  }
  return true;
}

std::vector<Eigen::MatrixXd> ModelResiduals::residual_blocks(const double* p) const {
  std::vector<Block> blocks;
  if (!compressed(p, false, blocks)) blocks.clear();
  return blocks;
}

Eigen::MatrixXd ModelResiduals::residual_block(std::size_t k, const double* p) const {
  std::vector<Block> blocks(k + 1);
  return compress(k, k + 1, p, false, blocks, {}) ? std::move(blocks[k]) : Block();
}

std::vector<ModelResiduals::Normal> ModelResiduals::normal_equations(const double* p) const {
  const auto n = static_cast<Eigen::Index>(parameter_count());
  const std::vector<Block>* blocks = white_blocks(p);
  if (blocks == nullptr) return {};
  const Eigen::MatrixXd& added = cache_.last.added;
  // M'M J of a slip is (I - c P_g) of its white rows, and through the mean of all slips g' (white rows) summed over
  // them.
  std::vector<Normal> out;
  Eigen::VectorXd through_mean = Eigen::VectorXd::Zero(n);
  double weights = 0;
  for (std::size_t k = 0; k < blocks->size(); ++k) {
    const auto white = (*blocks)[k].leftCols(n);
    const auto r = (*blocks)[k].col(n), g = (*blocks)[k].col(n + 1);
    if (added.cols() == 0) {
      out.push_back({white.transpose() * white, white.transpose() * r, Eigen::VectorXd::Zero(n)});
      continue;
    }
    const double added_to_r = added(n, static_cast<Eigen::Index>(k));
    const double norm = g.squaredNorm(), own = norm > 0 ? g.dot(r) / norm - added_to_r : 0;  // of r as it was
    const Eigen::VectorXd projection = white.transpose() * g;
    const double weight = whitening_->part * own;
    out.push_back({white.transpose() * white, white.transpose() * r - (added_to_r + weight) * projection,
                   Eigen::VectorXd::Constant(n, weight * whitening_->weight[slips_[k]])});
    through_mean += projection;
    weights += whitening_->weight[slips_[k]];
  }
  if (weights > 0) {
    for (Normal& slip : out) slip.level_gradient.array() *= through_mean.array() / weights;
  }
  return out;
}

std::vector<Eigen::MatrixXd> ModelResiduals::white_rows(const double* p, const FurtherColumns& further) const {
  std::vector<Block> blocks;
  if (!further) {
    const std::vector<Block>* known = white_blocks(p);
    if (known != nullptr) blocks = *known;
  } else if (compressed(p, true, blocks, further)) {
    const Eigen::MatrixXd added = corrections(blocks);
    for (Eigen::Index k = 0; k < added.cols(); ++k) add_to(blocks[static_cast<std::size_t>(k)], k, added);
  } else {
    blocks.clear();
  }
  for (Block& block : blocks) block.conservativeResize(Eigen::NoChange, block.cols() - 1);
  return blocks;
}

std::vector<double> ModelResiduals::squares(const double* p) const {
  std::vector<double> out;
  Workspace workspace;
  Block block;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (!fill(k, p, 0, workspace, block, true)) return {};
    out.push_back(block.col(0).head(friction_rows(observations_.slips[slips_[k]])).squaredNorm());
  }
  return out;
}

double ModelResiduals::white_squares(const double* p) const {
  Eigen::VectorXd rows(static_cast<Eigen::Index>(count()));
  return evaluate(p, rows.data(), nullptr) ? rows.squaredNorm() : std::numeric_limits<double>::quiet_NaN();
}

double ModelResiduals::squares_with_scatter(const double* p) const {
  const auto n = static_cast<Eigen::Index>(parameter_count());
  double sum = 0;
  if (was_evaluated(p)) {
    for (std::size_t k = 0; k < cache_.last.blocks.size(); ++k) {
      const auto r = cache_.last.blocks[k].col(n), g = cache_.last.blocks[k].col(n + 1);
      const double added = cache_.last.added.cols() > 0 ? cache_.last.added(n, static_cast<Eigen::Index>(k)) : 0;
      sum += (r - added * g).squaredNorm();
    }
    return sum;
  }
  const std::vector<Block> blocks = residual_blocks(p);
  for (const Block& block : blocks) sum += block.col(0).squaredNorm();
  return blocks.empty() ? std::numeric_limits<double>::quiet_NaN() : sum;
}

std::vector<ModelResiduals::StickSquares> ModelResiduals::stick_squares(const double* p) const {
  std::vector<StickSquares> out(slips_.size());
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    const auto& range = observations_.slips[slips_[k]];
    if (stick_rows(range) == 0) continue;
    const Eigen::VectorXd v = stick_velocities(observations_.sticks[range.stick], first_part_);
    out[k].rigid = (weights_[range.record] * v).squaredNorm();
    out[k].rows = static_cast<double>(stick_rows(range));
    std::vector<double> left;
    add_stick_residuals(range, p, left);
    for (const double r : left) out[k].left += r * r;
  }
  return out;
}

}  // namespace tribofit
