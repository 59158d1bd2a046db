#include "tribofit/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tribofit/fit/parallel.hpp"

namespace tribofit {

namespace {

/// Every model and protocol to fit: joint fits first, then the published protocol for the bare laws.
std::vector<std::pair<FrictionModel, FitOptions>> plan(const IdentifyOptions& options) {
  std::vector<std::pair<FrictionModel, FitOptions>> fits;
  FitOptions inner = options.fit;
  for (const BaseLaw law : options.laws) fits.emplace_back(FrictionModel(law, options.effects), inner);
  inner.protocol = Protocol::published;
  for (const BaseLaw law : options.laws) {
    if (options.published_protocol && law != BaseLaw::coulomb) fits.emplace_back(FrictionModel(law), inner);
  }
  return fits;
}

/// Index of the fit with the least error on held-out cycles, among those of the first fit's protocol.
std::size_t best_of(const std::vector<Fit>& fits) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < fits.size(); ++k) {
    if (fits[k].protocol != fits[0].protocol || fits[k].parameters.empty()) continue;
    if (fits[best].parameters.empty() || fits[k].error.held_out_rmse < fits[best].error.held_out_rmse) best = k;
  }
  return best;
}

/// One floor a trace, that of the best fit: the floor is a property of the data.
void share_floor(std::vector<Fit>& fits, std::size_t best) {
  const Floor floor = fits[best].floor;
  for (Fit& fit : fits) {
    if (!fit.parameters.empty()) set_floor(floor, fit);
  }
}

/// Where the instruments file contradicts what was used, or says more than is used.
void compare_declared(const Motion& motion, const Instruments& instruments, std::vector<std::string>& warnings) {
  const auto compare = [&](const Condition& used, const std::optional<Declared>& declared, const char* name) {
    if (!declared || !used.known() || used.source == "instruments file") return;
    const double allowed = std::max(1e-6 * std::abs(declared->value), 2 * declared->uncertainty);
    if (std::abs(used.value - declared->value) <= allowed) return;
    warnings.push_back(
        fmt::format("the {} from the {} ({:.4g} in SI units) is used, not that of the instruments file ({:.4g})", name,
                    used.source, used.value, declared->value));
  };
  compare(motion.conditions.radius, instruments.rig.radius, "radius");
  compare(motion.conditions.speed, instruments.rig.speed, "disc speed");
  compare(motion.conditions.load, instruments.rig.load, "load");
  const auto unused = [&](const std::optional<Declared>& declared, const char* name) {
    if (declared)
      warnings.push_back(fmt::format("{} is declared in the instruments file but nothing uses it yet", name));
  };
  unused(instruments.rig.stiffness, "rig.stiffness");
  unused(instruments.rig.ping_frequency, "rig.ping_frequency");
  unused(instruments.rig.pad_radius, "rig.pad_radius");
}

/// What the instruments file says of the conditions, where neither the user nor the manifest said it.
ReadOptions with_declared(ReadOptions read, const Instruments& instruments) {
  const auto declare = [](Condition& condition, const std::optional<Declared>& declared) {
    if (!condition.known() && declared) condition = {declared->value, "instruments file"};
  };
  if (read.step_radii.empty()) declare(read.conditions.radius, instruments.rig.radius);
  declare(read.conditions.speed, instruments.rig.speed);
  declare(read.conditions.load, instruments.rig.load);
  return read;
}

bool is_constant(const std::vector<double>& channel) {
  return std::all_of(channel.begin(), channel.end(), [&](double x) { return x == channel.front(); });
}

/// What keeps the data from carrying an analysis, as sentences; none when nothing does.
std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 16;
  std::vector<std::string> found;
  if (motion.size() < kFewestSamples) {
    found.push_back(fmt::format("there are only {} samples: too few for any analysis", motion.size()));
    return found;
  }
  if (is_constant(motion.friction))
    found.push_back("friction is the same in every sample: the channel was not recorded");
  if (is_constant(motion.relative_velocity) && !motion.sticks && motion.velocity_kind != VelocityKind::fixed_block) {
    found.push_back("the velocity is the same in every sample: the channel was not recorded");
  }
  if (found.empty() && segmentation.kind == MotionKind::always_sticking) {
    found.push_back("nothing slips in this trace: there is no friction law to fit");
  }
  return found;
}

void require_channels(const IdentifyOptions& options, const Motion& motion, std::vector<std::string>& warnings,
                      bool& analysed) {
  const Channels needs = FrictionModel(BaseLaw::exponential, options.effects).needs();
  const auto missing = [&](bool needed, bool present, const char* channel) {
    if (!needed || present) return;
    warnings.push_back(std::string("an effect needs the channel '") + channel + "', which this trace does not have");
    analysed = false;
  };
  missing(needs.load, !motion.load.empty(), "load");
  missing(needs.temperature, !motion.temperature.empty(), "temperature");
  missing(needs.angle, !motion.disc_angle.empty() || motion.conditions.speed.known(), "angle");
}

}  // namespace

Identification identify(const std::string& path, const IdentifyOptions& options) {
  Identification out;
  out.path = path;

  Trace trace = read_trace(path, with_declared(options.read, options.instruments));
  out.checksum = trace.checksum;
  out.samples = trace.size();
  out.duration = trace.duration();
  out.rate = trace.rate();
  out.notes = trace.notes;
  out.warnings = trace.warnings;

  out.motion = compute_motion(std::move(trace), options.instruments, options.motion);
  out.segmentation = find_cycles(out.motion);
  out.spectral_peak = fundamental(out.motion.relative_velocity, out.motion.step);
  out.notes.insert(out.notes.end(), out.motion.notes.begin(), out.motion.notes.end());
  out.notes.insert(out.notes.end(), out.segmentation.notes.begin(), out.segmentation.notes.end());

  compare_declared(out.motion, options.instruments, out.warnings);
  require_channels(options, out.motion, out.warnings, out.analysed);
  for (const std::string& obstacle : obstacles(out.motion, out.segmentation)) {
    out.warnings.push_back(obstacle);
    out.analysed = false;
  }
  if (!out.analysed) return out;

  // Effects may act within a few samples of break-away and re-stick; the bare laws are smooth.
  const std::size_t values_per_slip = options.effects.empty() ? 80 : 1000;
  const Observations observations = observe(
      out.motion, out.segmentation, FrictionModel(BaseLaw::exponential, options.effects).needs(), values_per_slip);
  if (observations.cycles < 3) {
    out.warnings.push_back("there are fewer than three cycles: no law can be fitted with an uncertainty");
    out.analysed = false;
    return out;
  }
  const auto fits = plan(options);
  out.fits.resize(fits.size());
  run_tasks(fits.size(), options.threads, [&](std::size_t k) {
    out.fits[k] =
        fit_model(fits[k].first, out.motion, out.segmentation, observations, options.instruments, fits[k].second);
  });
  out.best = best_of(out.fits);
  share_floor(out.fits, out.best);
  return out;
}

}  // namespace tribofit
