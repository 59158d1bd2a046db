#include "displacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "resolution.hpp"
#include "smoothing.hpp"
#include "statistics/derivatives.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::kinematics {

namespace {

/// As the fastest fall of a displacement shows it, or its fastest rise where the disc turns backwards [rad/s].
double frequency_of(const std::vector<double>& position, double step) {
  const auto fastest = [&](double sign) {
    double most = 0;
    for (std::size_t i = kShortestHalf; i < position.size(); i += kShortestHalf)
      most = std::max(most, sign * (position[i] - position[i - kShortestHalf]));
    return most;
  };
  if (fastest(-1) >= fastest(1)) return frequency_of_falls(position, step);
  std::vector<double> mirrored = position;
  for (double& x : mirrored) x = -x;
  return frequency_of_falls(mirrored, step);
}

/// Samples to either side for the slope of a position, as they predict it best about where it is fastest; as many at
/// least as pass some levels of a converter there.
std::size_t window_of_slope(std::span<const double> position, double step) {
  const std::size_t widest = std::min(kWidestHalf, position.size() / 20);
  std::size_t fastest = 0;
  double most = 0;
  for (std::size_t i = 0; i + kShortestHalf < position.size(); ++i) {
    const double change = std::abs(position[i + kShortestHalf] - position[i]);
    if (change > most) most = change, fastest = i;
  }
  const std::size_t some = std::min(position.size(), kThinned);
  const std::size_t from = std::min(fastest - std::min(fastest, some / 2), position.size() - some);
  const double levels = static_cast<double>(kFewestLevels * kShortestHalf) * find_resolution(position) / most;
  const std::size_t narrowest =
      std::clamp(levels > 0 ? static_cast<std::size_t>(levels) : 0, kShortestHalf, std::max(kShortestHalf, widest));
  const std::span<const double> part = position.subspan(from, some);
  const auto error_over = [&](std::size_t half) { return local_derivatives(part, step, half).prediction_error; };
  const std::size_t of_value = window_by_prediction(part, step, narrowest, widest);
  const double least = error_over(of_value);
  std::size_t half = std::clamp(static_cast<std::size_t>(kSlopeOverValue * static_cast<double>(of_value)), narrowest,
                                std::max(narrowest, widest));
  // A window that fits between two corners no more follows neither of them.
  while (half > of_value && error_over(half) > kSlopeOverValue * least) half = std::max(of_value, 9 * half / 10);
  return half;
}

void clean(std::vector<double>& position, const char* name, std::vector<std::string>& notes) {
  const std::size_t lone = remove_lone_samples(position);
  if (lone > 0) notes.push_back(fmt::format("{}: {} lone samples were replaced by their neighbours", name, lone));
}

void note_window(const char* what, std::size_t half, double step, std::vector<std::string>& notes) {
  notes.push_back(fmt::format("{} over {} samples ({} ms)", what, 2 * half + 1,
                              general(1e3 * static_cast<double>(2 * half + 1) * step, 3)));
}

/// Of a drive that was not recorded: it stands still.
LocalDerivatives at_rest(std::size_t n) {
  LocalDerivatives out;
  for (auto* part :
       {&out.value, &out.slope, &out.second_derivative, &out.slope_std_error, &out.second_derivative_std_error})
    part->assign(n, 0.0);
  return out;
}

/// Part of the power of friction over its size that it takes from a motion: 1 where it always resists.
double resistance(const std::vector<double>& friction, const std::vector<double>& velocity) {
  double taken = 0, all = 0;
  for (std::size_t i = 0; i < friction.size(); ++i) {
    taken += friction[i] * velocity[i];
    all += std::abs(friction[i] * velocity[i]);
  }
  return all > 0 ? taken / all : 0;
}

/// Medians of friction over the swings in one direction, without those that are slow throughout.
Estimate level_of(const std::vector<double>& friction, const std::vector<double>& velocity, double fast, int sign) {
  std::vector<double> levels, swing;
  const auto end = [&] {
    if (swing.size() > 2) levels.push_back(median(swing));
    swing.clear();
  };
  for (std::size_t i = 0; i < friction.size(); ++i) {
    if (sign * velocity[i] > fast) {
      swing.push_back(friction[i]);
    } else if (sign * velocity[i] < 0) {
      end();
    }
  }
  end();
  return mean_with_error(std::move(levels));
}

/// Takes off the force that the zeros of the displacements make.
void balance_directions(Trace& trace, std::vector<std::string>& notes) {
  double largest = 0;
  for (const double v : trace.velocity) largest = std::max(largest, std::abs(v));
  const double fast = kSlidesFreely * largest;
  const Estimate forth = level_of(trace.friction, trace.velocity, fast, 1);
  const Estimate back = level_of(trace.friction, trace.velocity, fast, -1);
  if (!(forth.std_error >= 0) || !(back.std_error >= 0)) {
    notes.emplace_back(
        "motion: too few swings in both directions to find the zero of the spring: a wrong zero adds a constant to "
        "friction");
    return;
  }
  const double offset = 0.5 * (forth.value + back.value);
  for (double& friction : trace.friction) friction -= offset;
  notes.push_back(
      fmt::format("motion: friction was balanced between the two directions by {} +/- {} N ({} um of the spring): "
                  "the "
                  "zeros of the displacements are arbitrary, so asymmetric friction cannot be seen",
                  general_with_sign(-offset, 3), general(0.5 * std::hypot(forth.std_error, back.std_error), 2),
                  general_with_sign(1e6 * offset / trace.spring.stiffness.value, 3)));
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double x : values) squares += x * x;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

/// Terms of the balance, from the derivatives of the mass and of its base.
struct Balance {
  std::vector<double> inertia, stretch;  ///< x'' [m/s^2], x - y [m]
};

Balance balance_forces(const LocalDerivatives& x, const LocalDerivatives& y, Trace& trace) {
  const double m = trace.spring.mass.value, k = trace.spring.stiffness.value;
  const double c = trace.spring.damping.known() ? trace.spring.damping.value : 0;
  const std::size_t n = trace.size();
  Balance out{x.second_derivative, std::vector<double>(n)};
  trace.friction.resize(n);
  trace.friction_std_error.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out.stretch[i] = x.value[i] - y.value[i];
    trace.friction[i] = -(m * x.second_derivative[i] + c * (x.slope[i] - y.slope[i]) + k * out.stretch[i]);
    const double of_slopes = c * std::hypot(x.slope_std_error[i], y.slope_std_error[i]);
    trace.friction_std_error[i] =
        std::hypot(m * x.second_derivative_std_error[i], std::hypot(of_slopes, k * x.noise, k * y.noise));
  }
  return out;
}

void refuse_unknown(const Trace& trace) {
  const InputLocation where{trace.path, 0, ""};
  const char* advice = "give --mass 3.08kg --stiffness 1191N/m, and --damping 0.67Ns/m where it is known";
  if (!trace.spring.mass.known() || !(trace.spring.mass.value > 0))
    throw InputError("friction from a motion needs the moving mass, which is not known", advice, where);
  if (!trace.spring.stiffness.known())
    throw InputError("friction from a motion needs the stiffness of the spring, which is not known", advice, where);
}

/// v_r against what the mass rubs on.
void set_velocity(const LocalDerivatives& x, const LocalDerivatives& y, Trace& trace) {
  trace.velocity = x.slope;
  trace.velocity_std_error = x.slope_std_error;
  for (std::size_t i = 0; i < trace.size() && trace.spring.counterface == Counterface::base; ++i) {
    trace.velocity[i] -= y.slope[i];
    trace.velocity_std_error[i] = std::hypot(x.slope_std_error[i], y.slope_std_error[i]);
  }
}

/// Corners where the mass turns round without a rest: it is fast within a window before and behind them.
std::vector<std::size_t> free_reversals(const Trace& trace, std::size_t half) {
  const std::vector<double>& v = trace.velocity;
  double largest = 0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  const double fast = kTurnsRound * largest;
  std::vector<std::size_t> corners;
  for (std::size_t i = half; i + half < v.size(); ++i) {
    if ((v[i - 1] < 0) == (v[i] < 0)) continue;
    if (std::abs(v[i - half]) < fast || std::abs(v[i + half - 1]) < fast) continue;
    if (corners.empty() || corners.back() < i - 1) corners.push_back(i - 1);
    corners.push_back(i + 1);
  }
  return corners;
}

/// v_r in the trace, against what the mass rubs on.
void settle_counterface(const LocalDerivatives& x, const LocalDerivatives& y, bool base_moves, Trace& trace,
                        std::vector<std::string>& notes) {
  std::vector<double> against_base(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) against_base[i] = x.slope[i] - y.slope[i];
  std::optional<Counterface>& counterface = trace.spring.counterface;
  if (!base_moves && !counterface) counterface = Counterface::ground;
  if (!counterface) {
    const double ground = resistance(trace.friction, x.slope), base = resistance(trace.friction, against_base);
    counterface = ground >= base ? Counterface::ground : Counterface::base;
    notes.push_back(fmt::format(
        "motion: the mass rubs on {}: friction would drive that motion in {} % of its power, and in {} % "
        "against "
        "the {} ({} --rubs-on)",
        ground >= base ? "ground that stands still" : "the moving base", general(50 * (1 - std::max(ground, base)), 3),
        general(50 * (1 - std::min(ground, base)), 3), ground >= base ? "base" : "ground",
        1 - std::max(ground, base) > kAlikePowers * (1 - std::min(ground, base)) ? "not clear: state it with"
                                                                                 : "state another with"));
  }
  set_velocity(x, y, trace);
}

/// Over the load, where one is stated.
void divide_by_load(Trace& trace, std::vector<std::string>& notes) {
  const Condition& load = trace.conditions.load;
  trace.friction_kind = load.known() && trace.load.empty() ? FrictionKind::coefficient : FrictionKind::force;
  if (trace.friction_kind == FrictionKind::force) {
    notes.emplace_back("no normal force is known: friction is a force in N (state --load for a coefficient)");
    return;
  }
  for (double& friction : trace.friction) friction /= load.value;
  for (double& error : trace.friction_std_error) error /= load.value;
}

}  // namespace

void make_velocity_of_displacement(Trace& trace, std::vector<std::string>& notes) {
  const double step = trace.interval();
  const bool block = !trace.block_position.empty(), drive = !trace.drive_position.empty();
  std::vector<double>& leading = block ? trace.block_position : trace.drive_position;
  clean(trace.block_position, "x_b", notes);
  clean(trace.drive_position, "x_d", notes);
  const std::size_t half = window_of_slope(leading, step);
  const LocalDerivatives b = block ? local_derivatives(trace.block_position, step, half) : at_rest(trace.size());
  const LocalDerivatives d = drive ? local_derivatives(trace.drive_position, step, half) : at_rest(trace.size());
  trace.velocity = b.slope;
  trace.velocity_std_error = b.slope_std_error;
  for (std::size_t i = 0; i < trace.size() && drive; ++i) {
    trace.velocity[i] = d.slope[i] - b.slope[i];
    trace.velocity_std_error[i] = std::hypot(d.slope_std_error[i], b.slope_std_error[i]);
  }
  // Friction is as it was recorded; what its samples scatter is not known here.
  trace.friction_std_error.assign(trace.size(), std::nan(""));
  note_window(drive && block ? "displacement: v_r is the slope of x_d - x_b"
              : drive        ? "displacement: the block is taken as fixed, v_r is the slope of x_d"
                             : "displacement: v_b is the slope of x_b",
              half, step, notes);
}

void make_friction_of_motion(Trace& trace, std::vector<std::string>& notes) {
  refuse_unknown(trace);
  const double step = trace.interval(), m = trace.spring.mass.value, k = trace.spring.stiffness.value;
  const bool base_moves = !trace.drive_position.empty();
  clean(trace.block_position, "x_b", notes);
  clean(trace.drive_position, "x_d", notes);
  const double frequency = std::max(std::sqrt(k / m), frequency_of(trace.block_position, step));
  const std::size_t half = half_window(frequency, step);
  LocalDerivatives x = local_derivatives(trace.block_position, step, half);
  const LocalDerivatives y = base_moves ? local_derivatives(trace.drive_position, step, half) : at_rest(trace.size());
  trace.velocity_kind = VelocityKind::relative;
  const Balance terms = balance_forces(x, y, trace);
  settle_counterface(x, y, base_moves, trace, notes);
  x = local_derivatives(trace.block_position, step, half, free_reversals(trace, half));
  balance_forces(x, y, trace);
  set_velocity(x, y, trace);
  balance_directions(trace, notes);
  note_window("motion: friction is -(m x'' + c (x' - y') + k (x - y)), with derivatives", half, step, notes);
  notes.push_back(fmt::format("motion: one per cent of the stated mass is {} N, one per cent of the stiffness {} N",
                              general(0.01 * m * root_mean_square(terms.inertia), 2),
                              general(0.01 * k * root_mean_square(terms.stretch), 2)));
  divide_by_load(trace, notes);
}

}  // namespace tribofit::kinematics
