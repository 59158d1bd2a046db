#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "published_studies.hpp"
#include "roots.hpp"
#include "tribofit/oscillator/presets.hpp"

namespace tribofit::studies {

namespace {

constexpr double kDampingRatio = 0.02;
constexpr std::size_t kTransform = 32768;
constexpr double kRate = 20000;  // Hz

Machine machine_with(const PublishedTest& test, Law law, double stiffness, double mass) {
  return {rig_with_damping_ratio(mass, stiffness, kDampingRatio),
          FrictionModel(law),
          test.friction,
          test.load,
          test.radius,
          test.speed};
}

/// Amplitude of the line at `turns` whole turns over the signal.
double amplitude_of_line(const std::vector<double>& signal, double turns) {
  std::complex<double> sum = 0, at = 1;
  const double n = static_cast<double>(signal.size());
  const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * turns / n);
  for (const double x : signal) {
    sum += x * at;
    at *= turn;
  }
  return 2 * std::abs(sum) / n;
}

double root_mean_square(const std::vector<double>& signal) {
  double sum = 0;
  for (const double x : signal) sum += x * x;
  return std::sqrt(sum / static_cast<double>(signal.size()));
}

void count_events(CalibratedRadius& out) {
  const Machine& m = out.machine;
  const SimulatedMotion motion =
      simulate(m.rig, m.drive(), m.model, m.parameters, {.duration = 60, .rate = 0, .settle = 5});
  const auto& slips = motion.slips;
  out.least_events = 1000;
  for (std::size_t i = 0; i + 20 < slips.size(); ++i) {
    int within = 0;
    while (slips[i + static_cast<std::size_t>(within)].break_away_time < slips[i].break_away_time + 1) ++within;
    // A second that begins at a break-away holds the most, one that begins right after it the least.
    out.most_events = std::max(out.most_events, within);
    out.least_events = std::min(out.least_events, within - 1);
  }
}

}  // namespace

CalibratedRadius calibrated_radius(const PublishedRadius& published, Law law, double frequency) {
  const PublishedTest test = published_test(published.radius, law);
  const auto misses = [&](double log_k, double log_m) {
    const Settled s = settle(machine_with(test, law, std::exp(log_k), std::exp(log_m)));
    return std::pair(std::log(s.frequency / frequency), std::log(s.peak_speed / published.amplitude));
  };
  // Newton's method on the logarithms of stiffness and mass.
  double k = std::log(test.rig.stiffness), m = std::log(test.rig.mass);
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 20; ++i) {
    const auto [f, a] = misses(k, m);
    const auto [f_k, a_k] = misses(k + kStep, m);
    const auto [f_m, a_m] = misses(k, m + kStep);
    const double fk = (f_k - f) / kStep, fm = (f_m - f) / kStep, ak = (a_k - a) / kStep, am = (a_m - a) / kStep;
    const double determinant = fk * am - fm * ak;
    const double dk = (fm * a - am * f) / determinant, dm = (ak * f - fk * a) / determinant;
    k += dk;
    m += dm;
    if (std::abs(dk) + std::abs(dm) < 1e-9) break;
  }
  CalibratedRadius out;
  out.machine = machine_with(test, law, std::exp(k), std::exp(m));
  out.settled = settle(out.machine);
  const SimulatedMotion cycle = settled_motion(out.machine, out.settled, 1, 20000);
  out.line = amplitude_of_line(cycle.relative_velocity, 1);
  out.rms_block = root_mean_square(cycle.velocity);
  out.rms_relative = root_mean_square(cycle.relative_velocity);
  const SimulatedMotion record =
      simulate(out.machine.rig, out.machine.drive(), out.machine.model, out.machine.parameters,
               {.duration = static_cast<double>(kTransform) / kRate, .rate = kRate, .settle = 5});
  out.bin = amplitude_of_line(record.relative_velocity, std::round(published.frequency / kBinOfRadii));
  count_events(out);
  return out;
}

std::array<double, 4> frequencies_with_published_ratios(Law law) {
  std::array<double, 4> found{};
  const PublishedRadius& reference = kPublishedRadii[2];
  const double at_reference = calibrated_radius(reference, law, reference.frequency).bin;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PublishedRadius& published = kPublishedRadii[i];
    const double wanted = published.line / reference.line;
    const auto excess = [&](double frequency) {
      return calibrated_radius(published, law, frequency).bin / at_reference - wanted;
    };
    found[i] = std::numeric_limits<double>::quiet_NaN();
    if (i == 2) found[i] = published.frequency;
    constexpr int kParts = 10;
    const double at_centre = excess(published.frequency);
    for (int part = 1; part <= kParts && std::isnan(found[i]); ++part) {
      for (const double side : {-0.5, 0.5}) {
        const double edge = published.frequency + side * kBinOfRadii * part / kParts;
        if (at_centre * excess(edge) > 0) continue;
        found[i] = root_of(excess, std::min(edge, published.frequency), std::max(edge, published.frequency), 1e-4);
        break;
      }
    }
  }
  return found;
}

}  // namespace tribofit::studies
