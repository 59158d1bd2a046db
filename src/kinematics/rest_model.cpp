#include "rest_model.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "rest_readings.hpp"
#include "static_responses.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/low_pass.hpp"
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
std::vector<Term> terms_of(const Trace& trace, const PlateauSearch& search, const RestReadings& readings,
                           const RestTerms& asked) {
  std::vector<Term> terms;
  const std::size_t length = search.blocks.length;
  const double step = search.blocks.step;
  const std::vector<double> friction = block_means(trace.friction, length, step).mean;
  std::vector<double> durations;
  for (const RestReadings::Stick& stick : readings.sticks) durations.push_back(stick.duration);
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
      low_pass(late, step / tau);
      terms.push_back({Kind::drive, tau, readings.means(late)});
    }
  }
  // A bristle creeps by 1/(1 - m), m = mu/mu_s; a disc that turns under the pad by m/sqrt(1 - m), from
  // m = 2 s (sqrt(1 + s^2) - s), s = v_r/(omega R).
  for (const double above : kStaticOverHighest) {
    VectorXd bristle(mu.size()), spin(mu.size());
    for (const RestReadings::Stick& one : readings.sticks) {
      const ArrayXd here = mu.segment(one.begin, one.size).array().abs();
      const ArrayXd part = here / (above * here.maxCoeff());
      bristle.segment(one.begin, one.size) = -1 / (1 - part);
      spin.segment(one.begin, one.size) = -part / (1 - part).sqrt();
    }
    terms.push_back({Kind::creep, above, bristle});
    terms.push_back({Kind::creep, above, spin});
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
double size_of(const RestReadings& readings, const Term& term, const LinearFit& found) {
  const auto value = found.x.tail(term.columns.cols());
  const ArrayXd moved = (term.columns * value).array();
  return (term.kind == Kind::ripple  ? value.norm()
          : term.kind == Kind::creep ? std::sqrt((moved - moved.mean()).square().mean())
                                     : moved.maxCoeff() - moved.minCoeff()) /
         readings.scale;
}

/// Large beside its error and enough to matter, and the same in both halves.
bool is_there(const RestRegression& model, const RestReadings& readings, const Term& term, const LinearFit& found,
              double creep) {
  const Index m = term.columns.cols();
  const VectorXd value = found.x.tail(m);
  const double falls = readings.velocity.mean() > 0 ? 1 : -1;  // towards zero
  if (term.kind == Kind::creep && falls * value(0) < 0) return false;
  if (term.kind == Kind::drive && falls * value(0) > 0) return false;
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
Candidate best_of(const RestRegression& model, const std::vector<Term>& terms, Kind kind) {
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
double odds_of(const RestReadings& readings, double left, double left_by_other) {
  return 0.5 * static_cast<double>(readings.velocity.size()) * std::log(left_by_other / left);
}

/// Squares of what rises in a straight line in each stick, about that line.
double noise_of(const RestReadings& readings, const VectorXd& rising) {
  double squares = 0;
  for (const RestReadings::Stick& stick : readings.sticks) {
    const std::span<const double> part(rising.data() + stick.begin, static_cast<std::size_t>(stick.size));
    const StraightLine line = fit_line(part);
    for (std::size_t k = 0; k < part.size(); ++k) squares += std::pow(part[k] - line.at(static_cast<double>(k)), 2);
  }
  return squares;
}

/// Whether a term leaves the course of the readings over a stick, in its time, straight: else it is not of that form.
bool has_its_form(const RestReadings& readings, RestRegression model, const Term& term) {
  model.add(term.columns);
  MatrixXd course(readings.velocity.size(), 2);
  for (const RestReadings::Stick& stick : readings.sticks) {
    const ArrayXd at = ArrayXd::LinSpaced(stick.size, -1, 1);
    course.middleRows(stick.begin, stick.size) << at.square(), at.cube();
  }
  const LinearFit found = model.with(course, true);
  if (found.covariance.size() == 0) return true;
  const VectorXd value = found.x.tail<2>();
  const double squares = value.dot(solve_symmetric(found.covariance.bottomRightCorner<2, 2>(), value).col(0));
  return squares < kSignificance * kSignificance;
}

/// Leaves of the terms that look alike in stick those that explain the record.
void distinguish(const Trace& trace, const PlateauSearch& search, const RestReadings& readings, const Estimate& mean,
                 std::vector<Term>& terms) {
  const RestRegression base(readings);
  const double moves = odds_of_motion(trace, search);
  const Candidate cross = best_of(base, terms, Kind::crosstalk), sag = best_of(base, terms, Kind::high_pass),
                  drive = best_of(base, terms, Kind::drive);
  constexpr double significant = 0.5 * kSignificance * kSignificance;
  bool crosses = false;
  if (cross && moves < -kClearEvidence) {
    // The block seems to go away by as much as friction adds to its velocity, and the displacement does not explain
    // more than noisy friction can.
    const double part = cross.found.x(2), away = part * mean_of(trace.friction);
    const double left = cross.found.left - part * part * noise_of(readings, cross.term->columns);
    crosses = std::abs(mean.value - away) < kZeroAgrees * std::abs(away) + kZeroErrors * mean.std_error &&
              std::abs(mean.value) > kZeroErrors * mean.std_error &&
              !(sag && odds_of(readings, sag.found.left, left) > significant);
  }
  // A contact that turns with the disc creeps nearly in proportion to friction too: a drive must explain clearly more.
  const Candidate creep = best_of(base, terms, Kind::creep);
  const bool is_true =
      !crosses && drive && !(sag && moves + odds_of(readings, drive.found.left, sag.found.left) < kClearEvidence);
  const bool drives = is_true && has_its_form(readings, base, *drive.term) &&
                      !(creep && odds_of(readings, drive.found.left, creep.found.left) < significant);
  if (!crosses) erase(terms, Kind::crosstalk);
  if (crosses || is_true) erase(terms, Kind::high_pass);
  if (!drives) erase(terms, Kind::drive);
}

/// Terms that are there, the clearest first.
std::vector<const Term*> select_terms(const RestReadings& readings, const std::vector<Term>& terms,
                                      RestRegression& model, double& creep) {
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
    // Beside creep, whose form is not known that well, what else falls in stick cannot be told; a drive that was taken
    // before it is doubted in fit_rest.
    if (best.term->kind == Kind::creep) std::erase_if(kinds, [](Kind kind) { return kind != Kind::ripple; });
    model.add(best.term->columns);
    chosen.push_back(best.term);
  }
}

/// The ripple of a model, by omega t or by the angle turned.
void read_ripple(const RestReadings& readings, double omega, int order, Index at, RestRegression& model,
                 RestModel& out) {
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
  if (model.drive_time > 0) low_pass(friction, step / model.drive_time);
  const double slows = model.drive.value / model.level.value;
  for (std::size_t i = 0; i < factor.size(); ++i) factor[i] *= 1 + slows * (friction[i] - model.friction_at_rest);
  return factor;
}

RestModel fit_rest(const Trace& trace, const PlateauSearch& search, const RestTerms& asked, const Estimate& mean) {
  RestModel out;
  const RestReadings readings = rest_readings(search);
  out.sticks = readings.sticks.size();
  if (out.sticks < kFewestForMedian) return out;
  std::vector<Term> terms = terms_of(trace, search, readings, asked);
  RestRegression model(readings);
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
  out.level = estimate_at(all, 0);
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
        out.level.value += out.drive.value * out.friction_at_rest;
        break;
      case Kind::creep:  // a real contact rings, and its static friction is not known that well
        out.level.std_error = std::hypot(out.level.std_error, kErrorOfCreep * value.value * term->columns.mean());
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
