#include "rest_model.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "static_responses.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

enum class Kind { high_pass, crosstalk, drive, creep, ripple };

/// One term of the reading; shape: time constant [s], order of a ripple, or static friction over the highest of a
/// stick.
struct Term {
  Kind kind;
  double shape = 0;
  MatrixXd columns = {};
};

/// The middles of the sticks, each in pieces: row by row one piece.
struct Readings {
  struct Stick {
    Index begin, size;
    double duration;  // [s]
  };
  std::vector<Stick> sticks;
  std::vector<std::pair<std::size_t, std::size_t>> pieces;  // in blocks
  VectorXd velocity, time;
  double scale = 0;  // |v_b| as read

  VectorXd means(std::span<const double> blocks) const {
    VectorXd out(static_cast<Index>(pieces.size()));
    for (std::size_t k = 0; k < pieces.size(); ++k)
      out(static_cast<Index>(k)) = mean_of(blocks.subspan(pieces[k].first, pieces[k].second - pieces[k].first));
    return out;
  }
};

Readings readings_of(const PlateauSearch& search, std::vector<StickPlateau> runs) {
  std::vector<double> sizes;
  for (const StickPlateau& run : runs) sizes.push_back(static_cast<double>(run.size()));
  const double least = kShortestPlateau * median(std::move(sizes));
  std::vector<double> velocity = search.blocks.mean, time(velocity.size());
  for (std::size_t b = 0; b < time.size(); ++b) {
    time[b] = (static_cast<double>(b) + 0.5) * search.blocks.step;
    if (!search.disc.mean.empty()) velocity[b] -= search.disc.mean[b];
  }
  Readings readings;
  for (const StickPlateau& run : runs) {
    const std::size_t size = run.inner_end() - run.inner_begin(), count = std::min(size, kMostPieces);
    if (static_cast<double>(run.size()) < least || count < 3) continue;
    readings.sticks.push_back({static_cast<Index>(readings.pieces.size()), static_cast<Index>(count),
                               static_cast<double>(run.size()) * search.blocks.step});
    for (std::size_t k = 0; k < count; ++k)
      readings.pieces.emplace_back(run.inner_begin() + k * size / count, run.inner_begin() + (k + 1) * size / count);
  }
  if (readings.sticks.empty()) return readings;
  readings.velocity = readings.means(velocity);
  readings.scale = readings.means(search.blocks.mean).cwiseAbs().mean();
  readings.time = readings.means(time);
  return readings;
}

/// Means of a stick are its level, which wanders from stick to stick: they weigh by the part of their variance that is
/// noise (random effects, the transformation of Fuller and Battese 1974). used: sticks that take part.
struct Weighting {
  std::vector<double> of_mean;
  std::vector<bool> used;
};

struct LinearFit {
  VectorXd x;
  MatrixXd covariance;  // from stick to stick
  double left = HUGE_VAL;
};

LinearFit fit(const Readings& readings, const MatrixXd& design, const Weighting& weighting, bool with_errors) {
  const Index n = design.cols();
  MatrixXd rows(design.rows(), n + 1);
  rows << design, readings.velocity;
  MatrixXd normal = MatrixXd::Zero(n + 1, n + 1);
  for (std::size_t k = 0; k < readings.sticks.size(); ++k) {
    auto part = rows.middleRows(readings.sticks[k].begin, readings.sticks[k].size);
    if (!weighting.used[k]) continue;
    part.rowwise() -= (weighting.of_mean[k] * part.colwise().mean()).eval();
    normal += part.transpose() * part;
  }
  LinearFit out;
  const VectorXd scale = normal.diagonal().cwiseSqrt();
  if (!(scale.head(n).minCoeff() > 0)) return out;
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const SymmetricSystem solved = solve_symmetric_system(scaled.topLeftCorner(n, n), scaled.col(n).head(n));
  if (!(solved.reciprocal_condition >= kFittable)) return out;
  const VectorXd back = scale.head(n).cwiseInverse();
  out.x = scale(n) * back.cwiseProduct(solved.x);
  out.left = normal(n, n) * (1 - scaled.col(n).head(n).dot(solved.x));
  if (!with_errors) return out;
  MatrixXd scores = MatrixXd::Zero(n, n);
  double sticks = 0;
  for (std::size_t k = 0; k < readings.sticks.size(); ++k) {
    const auto part = rows.middleRows(readings.sticks[k].begin, readings.sticks[k].size);
    if (!weighting.used[k]) continue;
    const VectorXd score = part.leftCols(n).transpose() * (part.col(n) - part.leftCols(n) * out.x);
    scores += score * score.transpose(), sticks += 1;
  }
  const MatrixXd inverse = back.asDiagonal() * solved.inverse * back.asDiagonal();
  out.covariance = sticks / std::max(1.0, sticks - static_cast<double>(n)) * inverse * scores * inverse;
  return out;
}

/// From what a model leaves: how much the levels of sticks wander, and which of them are far off.
Weighting weighting_of(const Readings& readings, const VectorXd& residuals) {
  double within = 0, freedom = 0;
  std::vector<double> levels, off;
  for (const Readings::Stick& stick : readings.sticks) {
    const auto part = residuals.segment(stick.begin, stick.size);
    levels.push_back(part.mean());
    within += (part.array() - part.mean()).square().sum(), freedom += static_cast<double>(stick.size) - 1;
  }
  const double centre = median(levels);
  for (const double level : levels) off.push_back(std::abs(level - centre));
  const double spread = kSigmaPerMad * median(off), rounding = kRoundingOfLevel * readings.scale;
  const double limit = std::max(kFarLevel * spread, rounding);
  Weighting out;
  within = std::max(within / freedom, rounding * rounding);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double size = static_cast<double>(readings.sticks[k].size);
    const double level = std::max(0.0, spread * spread - within / size);
    out.of_mean.push_back(level > 0 ? 1 - std::sqrt(within / (within + size * level)) : 0);
    out.used.push_back(off[k] <= limit);
  }
  if (static_cast<double>(std::count(out.used.begin(), out.used.end(), true)) <
      kLevelsKept * static_cast<double>(out.used.size()))
    out.used.assign(out.used.size(), true);
  return out;
}

/// A model of some terms, and the fit of one more.
class Model {
 public:
  explicit Model(const Readings& readings) : readings_(readings), design_(readings.velocity.size(), 2) {
    const double middle = readings.time.mean(), half = 0.5 * (readings.time.maxCoeff() - readings.time.minCoeff());
    design_ << VectorXd::Ones(design_.rows()), (readings.time.array() - middle) / half;
    settle();
  }
  void add(const Term& term) {
    design_.conservativeResize(Eigen::NoChange, design_.cols() + term.columns.cols());
    design_.rightCols(term.columns.cols()) = term.columns;
    settle();
  }
  LinearFit with(const MatrixXd& columns, bool with_errors) const {
    MatrixXd design(design_.rows(), design_.cols() + columns.cols());
    design << design_, columns;
    return fit(readings_, design, weighting_, with_errors);
  }
  /// The same in the first half of the sticks, or the second, the rest of the model as in the whole.
  LinearFit in_half(const MatrixXd& columns, const LinearFit& whole, bool second) const {
    Readings left = readings_;
    left.velocity -= design_ * whole.x.head(design_.cols());
    Weighting half = weighting_;
    for (std::size_t k = 0; k < half.used.size(); ++k)
      half.used[k] = half.used[k] && (2 * k >= half.used.size()) == second;
    MatrixXd design(design_.rows(), 1 + columns.cols());
    design << VectorXd::Ones(design_.rows()), columns;
    return fit(left, design, half, false);
  }
  const LinearFit& settled() const { return fit_; }
  const MatrixXd& design() const { return design_; }
  /// Other columns in the place of those from `at` on, nothing else changed.
  void replace(Index at, const MatrixXd& columns) {
    design_.middleCols(at, columns.cols()) = columns;
    fit_ = fit(readings_, design_, weighting_, true);
  }
  std::size_t sticks() const {
    return static_cast<std::size_t>(std::count(weighting_.used.begin(), weighting_.used.end(), true));
  }

 private:
  void settle() {
    constexpr int kRounds = 4;
    weighting_ = {std::vector<double>(readings_.sticks.size(), 0.0), std::vector<bool>(readings_.sticks.size(), true)};
    for (int round = 0; round < kRounds; ++round) {
      fit_ = fit(readings_, design_, weighting_, true);
      if (fit_.x.size() == 0) return;
      weighting_ = weighting_of(readings_, readings_.velocity - design_ * fit_.x);
    }
  }

  const Readings& readings_;
  MatrixXd design_;
  Weighting weighting_;
  LinearFit fit_;
};

/// Where a disc that has turned by theta is on its orbit: a speed 1 + a cos(u), u = n theta + phase, is that of the
/// true anomaly u of an orbit of eccentricity a, whose eccentric anomaly grows in proportion to time.
double eccentric_anomaly(double a, double u) {
  const double b = a / (1 + std::sqrt(1 - a * a));
  return u - 2 * std::atan2(b * std::sin(u), 1 + b * std::cos(u));
}

double true_anomaly(double a, double e) {
  const double b = a / (1 + std::sqrt(1 - a * a));
  return e + 2 * std::atan2(b * std::sin(e), 1 - b * std::cos(e));
}

/// n theta at a time.
double ripple_angle(const DiscRipple& ripple, bool true_angle, double omega, double time) {
  const double turned = ripple.order * omega * time, a = ripple.amplitude;
  if (!true_angle) return turned;
  return true_anomaly(a, eccentric_anomaly(a, ripple.phase) + std::sqrt(1 - a * a) * turned) - ripple.phase;
}

MatrixXd waves(const VectorXd& angle) {
  MatrixXd columns(angle.size(), 2);
  columns << angle.array().cos(), angle.array().sin();
  return columns;
}

/// From the coefficients of its two waves, which stand at `at`; level: of the readings without it [m/s].
DiscRipple ripple_of(const LinearFit& found, Index at, double level, int order) {
  const double sign = level > 0 ? 1 : -1;
  const Eigen::Vector2d wave = found.x.segment<2>(at);
  const double size = wave.norm();
  const Eigen::Matrix2d covariance = found.covariance.block<2, 2>(at, at);
  const Eigen::Vector2d along = wave / size, across(-along(1), along(0));
  return {.amplitude = size / std::abs(level),
          .order = order,
          .phase = std::atan2(-sign * wave(1), sign * wave(0)),
          .amplitude_std_error = std::sqrt(along.dot(covariance * along)) / std::abs(level),
          .phase_std_error = std::sqrt(across.dot(covariance * across)) / size};
}

/// All terms that are asked for, with all shapes that are tried.
std::vector<Term> terms_of(const Trace& trace, const PlateauSearch& search, const Readings& readings,
                           const RestTerms& asked) {
  std::vector<Term> terms;
  const std::size_t length = search.blocks.length;
  const double step = search.blocks.step;
  const std::vector<double> friction = block_means(trace.friction, length, step).mean;
  std::vector<double> durations;
  for (const Readings::Stick& stick : readings.sticks) durations.push_back(stick.duration);
  const double stick = median(std::move(durations));
  const VectorXd mu = readings.means(friction);
  if (asked.high_pass) {
    std::vector<double> way(friction.size());
    double sum = 0;
    for (std::size_t b = 0; b < way.size(); ++b) {
      way[b] = sum + 0.5 * step * search.blocks.mean[b];
      sum += step * search.blocks.mean[b];
    }
    terms.push_back({Kind::high_pass, 0, readings.means(way)});
  }
  if (asked.crosstalk) terms.push_back({Kind::crosstalk, 0, mu});
  if (asked.drive) {
    terms.push_back({Kind::drive, 0, mu});
    for (double tau = kFastestDrive * stick; tau < kSlowestDrive * stick; tau *= kNextDrive) {
      if (tau < step) continue;
      std::vector<double> late = friction;
      low_pass(late, tau, step);
      terms.push_back({Kind::drive, tau, readings.means(late)});
    }
  }
  for (const double above : kStaticOverHighest) {
    VectorXd creep(mu.size());
    for (const Readings::Stick& one : readings.sticks) {
      const ArrayXd here = mu.segment(one.begin, one.size).array().abs();
      creep.segment(one.begin, one.size) = -1 / (1 - here / (above * here.maxCoeff()));
    }
    terms.push_back({Kind::creep, above, creep});
  }
  const double span = readings.time.maxCoeff() - readings.time.minCoeff();
  const double turns = std::abs(asked.disc_speed) * span / (2 * std::numbers::pi);
  if (turns < kFewestRevolutions || readings.sticks.size() < kFewestPlateaus) return terms;
  for (int n = 1; n <= kHighestOrder; ++n) {
    if (static_cast<double>(readings.sticks.size()) < kFewestPlateausAPeriod * n * turns) break;
    terms.push_back({Kind::ripple, static_cast<double>(n), waves(n * asked.disc_speed * readings.time)});
  }
  return terms;
}

/// By how much a term moves the readings, over their level.
double size_of(const Readings& readings, const Term& term, const LinearFit& found) {
  const auto value = found.x.tail(term.columns.cols());
  const ArrayXd moved = (term.columns * value).array();
  return (term.kind == Kind::ripple  ? value.norm()
          : term.kind == Kind::creep ? std::sqrt((moved - moved.mean()).square().mean())
                                     : moved.maxCoeff() - moved.minCoeff()) /
         readings.scale;
}

/// Large beside its error and enough to matter, and the same in both halves.
bool is_there(const Model& model, const Readings& readings, const Term& term, const LinearFit& found, double creep) {
  const Index m = term.columns.cols();
  const VectorXd value = found.x.tail(m);
  const double falls = readings.velocity.mean() > 0 ? 1 : -1;  // towards zero
  if (term.kind == Kind::creep && falls * value(0) < 0) return false;
  if (term.kind == Kind::high_pass && value(0) > 0) return false;
  const VectorXd along = value / value.norm();
  const double error = std::sqrt(along.dot(found.covariance.bottomRightCorner(m, m) * along));
  const double size = size_of(readings, term, found);
  const double least = term.kind == Kind::creep ? kLeastCreep : std::max(kLeastOfRest, creep);
  const double swing = term.kind == Kind::drive ? (term.columns * value).cwiseAbs().maxCoeff() / readings.scale : size;
  const double most = term.kind == Kind::ripple || term.kind == Kind::drive ? kMostOfDisc : HUGE_VAL;
  if (!(value.norm() > kSignificance * error) || size < least || swing > most) return false;
  const LinearFit early = model.in_half(term.columns, found, false), late = model.in_half(term.columns, found, true);
  if (early.x.size() == 0 || late.x.size() == 0) return false;
  const double apart = (early.x.tail(m) - late.x.tail(m)).norm();
  return apart < kHalvesOfRest * value.norm() + kSignificance * error;
}

struct Candidate {
  const Term* term = nullptr;
  LinearFit found = {};
  explicit operator bool() const { return term != nullptr; }
};

/// The term of a kind that leaves least.
Candidate best_of(const Model& model, const std::vector<Term>& terms, Kind kind) {
  Candidate best;
  for (const Term& term : terms) {
    if (term.kind != kind) continue;
    LinearFit found = model.with(term.columns, false);
    if (found.left < best.found.left) best = {&term, std::move(found)};
  }
  if (best) best.found = model.with(best.term->columns, true);
  return best.found.covariance.size() > 0 ? best : Candidate{};
}

void erase(std::vector<Term>& terms, Kind kind) {
  std::erase_if(terms, [kind](const Term& term) { return term.kind == kind; });
}

/// Logarithm of the odds that what falls in stick is a velocity and not only its reading, from how straight friction
/// is.
double odds_of_motion(const Trace& trace, const PlateauSearch& search) {
  const StickBends bends = bends_in_stick(trace, search);
  if (!(bends.std_error > 0)) return 0;
  return 0.5 * (std::pow(bends.over_disc / bends.std_error, 2) - std::pow(bends.over_way / bends.std_error, 2));
}

/// The same of one explanation against another, from what they leave.
double odds_of(const Readings& readings, double left, double left_by_other) {
  return 0.5 * static_cast<double>(readings.velocity.size()) * std::log(left_by_other / left);
}

/// Squares of what rises in a straight line in each stick, about that line.
double noise_of(const Readings& readings, const VectorXd& rising) {
  double squares = 0;
  for (const Readings::Stick& stick : readings.sticks) {
    const std::span<const double> part(rising.data() + stick.begin, static_cast<std::size_t>(stick.size));
    const StraightLine line = fit_line(part);
    for (std::size_t k = 0; k < part.size(); ++k) squares += std::pow(part[k] - line.at(static_cast<double>(k)), 2);
  }
  return squares;
}

/// Leaves of the terms that look alike in stick those that explain the record.
void distinguish(const Trace& trace, const PlateauSearch& search, const Readings& readings, const Estimate& mean,
                 std::vector<Term>& terms) {
  const Model base(readings);
  const double moves = odds_of_motion(trace, search);
  const Candidate cross = best_of(base, terms, Kind::crosstalk), sag = best_of(base, terms, Kind::high_pass),
                  drive = best_of(base, terms, Kind::drive);
  bool crosses = false;
  if (cross && moves < -kClearEvidence) {
    // The block seems to go away by as much as friction adds to its velocity, and the displacement does not explain
    // more than noisy friction can.
    const double part = cross.found.x(2), away = part * mean_of(trace.friction);
    const double left = cross.found.left - part * part * noise_of(readings, cross.term->columns);
    crosses = std::abs(mean.value - away) < kZeroAgrees * std::abs(away) + kZeroErrors * mean.std_error &&
              std::abs(mean.value) > kZeroErrors * mean.std_error &&
              !(sag && odds_of(readings, sag.found.left, left) > kClearEvidence);
  }
  const bool drives =
      !crosses && drive && !(sag && moves + odds_of(readings, drive.found.left, sag.found.left) < kClearEvidence);
  if (!crosses) erase(terms, Kind::crosstalk);
  if (crosses || drives) erase(terms, Kind::high_pass);
  if (!drives) erase(terms, Kind::drive);
}

/// Terms that are there, the clearest first.
std::vector<const Term*> select_terms(const Readings& readings, const std::vector<Term>& terms, Model& model,
                                      double& creep) {
  std::vector<const Term*> chosen;
  std::vector<Kind> kinds{Kind::high_pass, Kind::crosstalk, Kind::drive, Kind::creep, Kind::ripple};
  for (;;) {
    Candidate best;
    for (const Kind kind : kinds) {
      Candidate next = best_of(model, terms, kind);
      if (next && next.found.left < best.found.left && is_there(model, readings, *next.term, next.found, creep))
        best = std::move(next);
    }
    if (!best) return chosen;
    if (best.term->kind == Kind::creep) creep = size_of(readings, *best.term, best.found);
    std::erase(kinds, best.term->kind);
    // What creeps is no drive that slows down, and the other way round nothing is known.
    if (best.term->kind == Kind::creep) std::erase(kinds, Kind::drive);
    model.add(*best.term);
    chosen.push_back(best.term);
  }
}

/// The ripple of a model, by omega t or by the angle turned.
void read_ripple(const Readings& readings, double omega, int order, Index at, Model& model, RestModel& out) {
  const auto read = [&] {
    const VectorXd wave = model.design().middleCols(at, 2) * model.settled().x.segment<2>(at);
    return ripple_of(model.settled(), at, (readings.velocity - wave).mean(), order);
  };
  out.ripple = read();
  const double left = model.settled().left;
  const MatrixXd columns = model.design().middleCols(at, 2);
  DiscRipple turned = out.ripple;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    VectorXd angle(readings.time.size());
    for (Index k = 0; k < angle.size(); ++k) angle(k) = ripple_angle(turned, true, omega, readings.time(k));
    model.replace(at, waves(angle));
    turned = read();
    if (!(turned.amplitude <= kMostOfDisc)) break;
  }
  out.true_angle = turned.amplitude <= kMostOfDisc && model.settled().left < left;
  if (out.true_angle)
    out.ripple = turned;
  else
    model.replace(at, columns);
}

}  // namespace

void low_pass(std::span<double> signal, double time_constant, double step) {
  if (!(time_constant > 0) || signal.empty()) return;
  const auto first = std::clamp<std::size_t>(static_cast<std::size_t>(time_constant / step), 1, signal.size());
  const double follows = -std::expm1(-step / time_constant);
  double state = mean_of(signal.first(first));
  for (double& x : signal) x = state += follows * (x - state);
}

std::vector<double> disc_factor(const RestModel& model, double omega, const Trace& trace, double step) {
  std::vector<double> factor(trace.size(), 1.0);
  const DiscRipple& ripple = model.ripple;
  if (model.ripple_is_found) {
    for (std::size_t i = 0; i < factor.size(); ++i)
      factor[i] +=
          ripple.amplitude * std::cos(ripple_angle(ripple, model.true_angle, omega, trace.time[i]) + ripple.phase);
  }
  if (!model.drive.any()) return factor;
  std::vector<double> friction = trace.friction;
  low_pass(friction, model.drive_time, step);
  const double slows = model.drive.value / model.level;
  for (std::size_t i = 0; i < factor.size(); ++i) factor[i] *= 1 + slows * (friction[i] - model.friction_at_rest);
  return factor;
}

RestModel fit_rest(const Trace& trace, const PlateauSearch& search, const RestTerms& asked, const Estimate& mean) {
  RestModel out;
  const Readings readings = readings_of(search, search.plateaus.runs);
  out.sticks = readings.sticks.size();
  if (out.sticks < kFewestForMedian) return out;
  std::vector<Term> terms = terms_of(trace, search, readings, asked);
  Model model(readings);
  const auto corner = [](const Estimate& slope) {
    return Estimate{-slope.value / (2 * std::numbers::pi), slope.std_error / (2 * std::numbers::pi)};
  };
  const auto estimate_at = [](const LinearFit& fit, Index at) {
    return Estimate{fit.x(at), std::sqrt(fit.covariance(at, at))};
  };
  if (const Candidate sag = best_of(model, terms, Kind::high_pass)) out.high_pass = corner(estimate_at(sag.found, 2));
  if (asked.high_pass || asked.drive) distinguish(trace, search, readings, mean, terms);
  if (const Candidate wave = best_of(model, terms, Kind::ripple))
    out.ripple = ripple_of(wave.found, 2, wave.found.x(0), static_cast<int>(wave.term->shape));
  std::vector<const Term*> chosen = select_terms(readings, terms, model, out.creep);
  const auto drive =
      std::find_if(chosen.begin(), chosen.end(), [](const Term* one) { return one->kind == Kind::drive; });
  if (drive != chosen.end() && out.creep > 0) {  // faster towards break-away: a contact that turns with the disc
    return fit_rest(trace, search, {.disc_speed = asked.disc_speed}, mean);
  }
  const LinearFit& all = model.settled();
  if (all.x.size() == 0) return out;
  out.sticks = model.sticks();
  out.level = all.x(0);
  out.middle = readings.time.mean();
  out.drift = all.x(1) / (0.5 * (readings.time.maxCoeff() - readings.time.minCoeff()));
  Index at = 2;
  for (const Term* term : chosen) {
    const Estimate value = estimate_at(all, at);
    switch (term->kind) {
      case Kind::high_pass:
        out.high_pass = corner(value), out.high_pass_is_found = true;
        break;
      case Kind::crosstalk:
        out.crosstalk = value;
        break;
      case Kind::drive:
        out.drive = value, out.drive_time = term->shape, out.friction_at_rest = term->columns.mean();
        out.level += out.drive.value * out.friction_at_rest;
        break;
      case Kind::creep:
        break;
      case Kind::ripple:
        out.ripple_is_found = true;
        read_ripple(readings, asked.disc_speed, static_cast<int>(term->shape), at, model, out);
    }
    at += term->columns.cols();
  }
  return out;
}

}  // namespace tribofit::kinematics
