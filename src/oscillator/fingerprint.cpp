#include "tribofit/oscillator/fingerprint.hpp"
#include "tribofit/ingest/units.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <utility>

#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

using View = SketchView;

const FingerprintAxis kMu = {"mu", "", 1}, kLeft = {"mu minus bare law", "", 1}, kSpeed = {"v_r", "mm/s", 1e-3},
                      kTime = {"time", "s", 1};

/// A record with the effect, and what it is compared with.
struct Scene {
  PublishedTest test = published_test(0.015, ExponentialLaw{});
  SimulatedRecording with, without;
  const Trace& trace() const { return with.recording.trace; }
  double stated() const { return test.speed * test.radius; }

  /// v_r as a reader of the record makes it.
  double relative_velocity(std::size_t i) const {
    return with.motion.disc_speed.empty() ? 0 : stated_disc(i) - trace().velocity[i];
  }
  double stated_disc(std::size_t i) const {
    return trace().disc_speed.empty() ? stated() : trace().disc_speed[i] * test.radius;
  }
  double left(std::size_t i) const {
    const double v = relative_velocity(i);
    const double law =
        test.friction[1] + (test.friction[0] - test.friction[1]) * std::exp(-test.friction[2] * std::abs(v));
    return trace().friction[i] - (v < 0 ? -law : law);
  }
};

bool is_slow(View view) {
  return view == View::time || view == View::distance || view == View::angle || view == View::load ||
         view == View::temperature || view == View::ripple;
}

Drive drive_for(View view, const PublishedTest& test) {
  Drive drive;
  drive.speed = constant_speed(test.speed);
  drive.radius = test.radius;
  drive.mean_load = test.load;
  if (view == View::directions) drive.speed = stepped_speed({0, 1}, {test.speed, -test.speed});
  if (view == View::stick_time) {
    drive.speed = stepped_speed({0, 12, 19, 23}, {0.5 * kRpm, 1 * kRpm, 2 * kRpm, 8 * kRpm});
  }
  if (view == View::since_reversal) drive.speed = reversing_speed(10 * test.speed, 0.2);
  if (view == View::load) drive.load = [](double t) { return 50 + 25 * std::sin(2 * std::numbers::pi * t / 20); };
  if (view == View::temperature) {
    drive.temperature = [](double t) { return 40 - 20 * std::cos(2 * std::numbers::pi * t / 40); };
    drive.mean_temperature = 40;
  }
  return drive;
}

Scene play(View view, const FrictionModel& model, const std::vector<double>& effect) {
  Scene scene;
  // Strokes of 100 mm, on a rig that does not stick.
  if (view == View::since_reversal) scene.test.rig = rig_with_damping_ratio(2, 1e6, 1);
  const PublishedTest& test = scene.test;
  std::vector<double> p = test.friction;
  const std::vector<double> bare = p;
  p.insert(p.end(), effect.begin(), effect.end());
  SimulationOptions options{.duration = 1.2, .settle = 1.6, .tolerance = 1e-8};
  if (view == View::stick_time) options.duration = 26;
  if (view == View::directions) options.duration = 2;
  if (view == View::since_reversal) options.duration = 10;
  if (is_slow(view)) options.duration = 42;
  if (options.duration > 5) options.rate = 1000;
  const Drive drive = drive_for(view, test);
  scene.with = simulate_recording(model, p, test.rig, drive, options);
  const bool compares =
      view == View::curve || view == View::stick_time || view == View::creep || view == View::since_reversal;
  if (compares) scene.without = simulate_recording(FrictionModel(ExponentialLaw{}), bare, test.rig, drive, options);
  return scene;
}

/// Samples of every slip that is recorded whole.
std::vector<std::pair<std::size_t, std::size_t>> slips_of(const SimulatedMotion& motion) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (const SimulatedSlip& slip : motion.slips) {
    if (!(slip.break_away_time > 0) || std::isnan(slip.restick_time)) continue;
    const auto index = [&](double t) { return static_cast<std::size_t>(std::ceil(t * motion.rate)); };
    found.emplace_back(index(slip.break_away_time), std::min(index(slip.restick_time), motion.size()));
  }
  return found;
}

void add(FingerprintCloud& cloud, double x, double y) {
  cloud.x.push_back(x);
  cloud.y.push_back(y);
}

using Channel = std::function<double(std::size_t)>;

/// What the bare law leaves of each slip, on average, over a channel at its beginning.
Fingerprint over_slips(const Scene& scene, FingerprintAxis axis, const Channel& x) {
  FingerprintCloud cloud;
  for (const auto& [begin, end] : slips_of(scene.with.motion)) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += scene.left(i);
    if (end > begin) add(cloud, x(begin), sum / static_cast<double>(end - begin));
  }
  return {.x = std::move(axis), .y = kLeft, .clouds = {std::move(cloud)}, .conditions = ""};
}

Fingerprint loop(const Scene& scene) {
  FingerprintCloud faster{.name = "gaining speed", .x = {}, .y = {}}, slower{.name = "losing speed", .x = {}, .y = {}};
  const auto [begin, end] = slips_of(scene.with.motion).at(1);
  for (std::size_t i = begin; i + 1 < end; ++i) {
    const double v = scene.relative_velocity(i);
    add(scene.relative_velocity(i + 1) > v ? faster : slower, v, scene.left(i));
  }
  return {.x = kSpeed, .y = kLeft, .clouds = {faster, slower}, .conditions = ""};
}

Fingerprint curve(const Scene& scene) {
  FingerprintCloud with{.name = "with", .x = {}, .y = {}}, without{.name = "without", .x = {}, .y = {}};
  for (const auto& [hidden, cloud] : {std::pair(&scene.with, &with), std::pair(&scene.without, &without)}) {
    const auto [begin, end] = slips_of(hidden->motion).at(1);
    for (std::size_t i = begin; i < end; ++i) {
      add(*cloud, hidden->motion.relative_velocity[i], hidden->recording.trace.friction[i]);
    }
  }
  return {.x = kSpeed, .y = kMu, .clouds = {with, without}, .conditions = ""};
}

Fingerprint directions(const Scene& scene) {
  FingerprintCloud forward{.name = "forward", .x = {}, .y = {}}, backward{.name = "backward", .x = {}, .y = {}};
  const SimulatedMotion& motion = scene.with.motion;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double v = motion.relative_velocity[i], disc = motion.disc_speed[i];
    if (std::abs(v) < 1e-4 || v * disc <= 0) continue;
    add(v > 0 ? forward : backward, std::abs(v), std::abs(scene.trace().friction[i]));
  }
  return {.x = {"|v_r|", "mm/s", 1e-3}, .y = {"|mu|", "", 1}, .clouds = {forward, backward}, .conditions = ""};
}

/// Of whole strokes.
Fingerprint since_reversal(const Scene& scene) {
  FingerprintCloud with{.name = "with", .x = {}, .y = {}}, without{.name = "without", .x = {}, .y = {}};
  const SimulatedMotion& motion = scene.with.motion;
  for (const auto& [begin, end] : slips_of(motion)) {
    for (std::size_t i = begin; i < end; i += 5) {
      const double distance = motion.distance[i] - motion.distance[begin];
      const double direction = motion.relative_velocity[i] < 0 ? -1 : 1;
      add(with, distance, direction * motion.friction[i]);
      add(without, distance, direction * scene.without.motion.friction[i]);
    }
  }
  return {.x = {"since reversal", "mm", 1e-3}, .y = kMu, .clouds = {with, without}, .conditions = ""};
}

/// The second half of a stick, without its end: what re-stick struck has died away.
Fingerprint creep(const Scene& scene) {
  FingerprintCloud with{.name = "with", .x = {}, .y = {}}, without{.name = "without", .x = {}, .y = {}};
  for (const auto& [hidden, cloud] : {std::pair(&scene.with, &with), std::pair(&scene.without, &without)}) {
    const auto slips = slips_of(hidden->motion);
    const std::size_t begin = slips.at(1).second, end = slips.at(2).first, part = (end - begin) / 30;
    for (std::size_t i = begin + 15 * part; i < end - part; ++i) {
      add(*cloud, hidden->recording.trace.friction[i], hidden->motion.relative_velocity[i]);
    }
  }
  return {.x = {"mu in stick", "", 1}, .y = kSpeed, .clouds = {with, without}, .conditions = ""};
}

Fingerprint ageing(const Scene& scene) {
  FingerprintCloud with{.name = "with", .x = {}, .y = {}}, without{.name = "without", .x = {}, .y = {}};
  for (const auto& [hidden, cloud] : {std::pair(&scene.with, &with), std::pair(&scene.without, &without)}) {
    for (const SimulatedSlip& slip : hidden->motion.slips) {
      if (slip.stick_time > 0 && slip.break_away_time > 0) add(*cloud, slip.stick_time, slip.break_away_friction);
    }
  }
  return {.x = {"stick time", "s", 1}, .y = {"mu at break-away", "", 1}, .clouds = {with, without}, .conditions = ""};
}

/// v_b in one stick, against omega r as stated.
Fingerprint plateau(const Scene& scene) {
  FingerprintCloud reading{.name = "v_b as read", .x = {}, .y = {}},
      line{.name = "omega r as stated", .x = {}, .y = {}};
  const auto slips = slips_of(scene.with.motion);
  const std::size_t begin = slips.at(1).second, end = slips.at(2).first;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = static_cast<double>(i - begin) / scene.with.motion.rate;
    add(reading, t, scene.trace().velocity[i]);
    add(line, t, scene.stated());
  }
  return {.x = {"time in stick", "s", 1}, .y = {"v_b", "mm/s", 1e-3}, .clouds = {reading, line}, .conditions = ""};
}

double turn_of(double angle) {
  const double turns = angle / (2 * std::numbers::pi);
  return turns - std::floor(turns);
}

/// A cloud over samples [begin, end) that `keep` lets through.
Fingerprint over_samples(std::pair<std::size_t, std::size_t> range, FingerprintAxis x_axis, FingerprintAxis y_axis,
                         const Channel& x, const Channel& y, const std::function<bool(std::size_t)>& keep = nullptr) {
  FingerprintCloud cloud;
  for (std::size_t i = range.first; i < range.second; ++i) {
    if (!keep || keep(i)) add(cloud, x(i), y(i));
  }
  return {.x = std::move(x_axis), .y = std::move(y_axis), .clouds = {std::move(cloud)}, .conditions = ""};
}

Fingerprint draw(View view, const Scene& scene) {
  const SimulatedMotion& motion = scene.with.motion;
  const Trace& trace = scene.trace();
  const std::pair<std::size_t, std::size_t> all = {0, motion.size()};
  const Channel left = [&](std::size_t i) { return scene.left(i); };
  const FingerprintAxis turns = {"turns of the disc", "", 1};
  switch (view) {
    case View::loop:
      return loop(scene);
    case View::curve:
      return curve(scene);
    case View::directions:
      return directions(scene);
    case View::since_reversal:
      return since_reversal(scene);
    case View::creep:
      return creep(scene);
    case View::stick_time:
      return ageing(scene);
    case View::plateau:
      return plateau(scene);
    case View::time:
      return over_slips(scene, kTime, [&](std::size_t i) { return motion.time[i]; });
    case View::distance:
      return over_slips(scene, {"distance slid", "mm", 1e-3}, [&](std::size_t i) { return motion.distance[i]; });
    case View::angle:
      return over_slips(scene, turns, [&](std::size_t i) { return turn_of(motion.disc_angle[i]); });
    case View::load:
      return over_slips(scene, {"load", "N", 1}, [&](std::size_t i) { return trace.load[i]; });
    case View::temperature:
      return over_slips(scene, {"temperature", "degC", 1}, [&](std::size_t i) { return trace.temperature[i]; });
    case View::ripple:
      return over_samples(
          all, turns, {"v_b in stick", "mm/s", 1e-3}, [&](std::size_t i) { return turn_of(motion.disc_angle[i]); },
          [&](std::size_t i) { return trace.velocity[i]; }, [&](std::size_t i) { return motion.sticks[i] != 0; });
    case View::since_break_away: {
      const auto [begin, end] = slips_of(motion).at(1);
      const double first = motion.time[begin];
      return over_samples(
          {begin, end}, {"time since break-away", "ms", 1e-3}, kLeft,
          [&](std::size_t i) { return motion.time[i] - first; }, left);
    }
    case View::acceleration:
      return over_samples(
          all, {"acceleration of the block", "m/s^2", 1}, kLeft, [&](std::size_t i) { return motion.acceleration[i]; },
          left, [&](std::size_t i) { return motion.sticks[i] == 0; });
    case View::load_channel:
      return over_samples(
          all, kMu, {"load channel", "N", 1}, [&](std::size_t i) { return trace.friction[i]; },
          [&](std::size_t i) { return trace.load[i]; });
    case View::line:
      break;
  }
  const std::size_t begin = slips_of(motion).at(1).second;
  return over_samples(
      {begin, begin + 2000}, {"time in stick", "ms", 1e-3}, {"mu as read minus mu", "", 1},
      [&](std::size_t i) { return motion.time[i] - motion.time[begin]; },
      [&](std::size_t i) { return trace.friction[i] - motion.friction[i]; });
}

/// "sigma = 0.001 s/mm, ..."
std::string conditions(const EffectInfo& info, const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%g", values[i]);
    const Parameter& q = info.parameters[i];
    text += (text.empty() ? "" : ", ") + q.name + " = " + number + (q.unit == "1" ? "" : " " + q.unit);
  }
  return text;
}

}  // namespace

Fingerprint fingerprint(const Effect& effect) {
  const EffectInfo info = describe(effect);
  Sketch sketch = info.sketch;
  if (sketch.values.empty()) {
    for (const Parameter& q : info.parameters) sketch.values.push_back(q.lower + 0.3 * (q.upper - q.lower));
  }
  std::vector<double> p;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) p.push_back(sketch.values[i] * info.parameters[i].si);
  const Scene scene = play(sketch.view, FrictionModel(ExponentialLaw{}, {effect}), p);
  Fingerprint print = draw(sketch.view, scene);
  print.conditions = conditions(info, sketch.values);
  return print;
}

}  // namespace tribofit
