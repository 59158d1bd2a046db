#include "tribofit/study/fingerprint.hpp"
#include "tribofit/ingest/units.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "oscillator/simulation_checks.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

using View = SketchView;

const FingerprintAxis kMu = {"mu", "", 1}, kLeft = {"mu minus bare law", "", 1}, kSpeed = {"v_r", "mm/s", 1e-3},
                      kTime = {"time", "s", 1}, kTurns = {"turns of the disc", "", 1};

/// A record with the effect, and what it is compared with.
struct Scene {
  Law law = law_catalogue().front();
  PublishedTest test = published_test(0.015, law);
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
  /// What the bare law leaves of friction.
  std::vector<double> left() const {
    std::vector<double> speed, out = trace().friction;
    for (std::size_t i = 0; i < out.size(); ++i) speed.push_back(std::abs(relative_velocity(i)));
    std::vector<double> bare(speed.size());
    Slip slip;
    slip.time = with.motion.time;
    slip.velocity = speed;
    evaluate<double>(FrictionModel(law), test.friction.data(), slip, speed, bare);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= relative_velocity(i) < 0 ? -bare[i] : bare[i];
    return out;
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

Scene play(View view, const Effect& effect, const std::vector<double>& values) {
  Scene scene;
  // Strokes of 100 mm, on a rig that does not stick.
  if (view == View::since_reversal) scene.test.rig = rig_with_damping_ratio(2, 1e6, 1);
  const PublishedTest& test = scene.test;
  std::vector<double> p = test.friction;
  p.insert(p.end(), values.begin(), values.end());
  SimulationOptions options{.duration = 1.2, .settle = 1.6, .tolerance = 1e-8};
  if (view == View::stick_time) options.duration = 26;
  if (view == View::directions) options.duration = 2;
  if (view == View::since_reversal) options.duration = 10;
  if (is_slow(view)) options.duration = 42;
  if (options.duration > 5) options.rate = 1000;
  const Drive drive = drive_for(view, test);
  scene.with = simulate_recording(FrictionModel(scene.law, {effect}), p, test.rig, drive, options);
  const bool compares =
      view == View::curve || view == View::stick_time || view == View::creep || view == View::since_reversal;
  if (compares) scene.without = simulate_recording(FrictionModel(scene.law), test.friction, test.rig, drive, options);
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

using Range = std::pair<std::size_t, std::size_t>;

/// Clouds of these names, still empty.
Fingerprint blank(const FingerprintAxis& x, const FingerprintAxis& y, const std::vector<std::string>& names = {""}) {
  Fingerprint out{.x = x, .y = y};
  for (const std::string& name : names) out.clouds.push_back({.name = name});
  return out;
}

void add(FingerprintCloud& cloud, double x, double y) {
  cloud.x.push_back(x);
  cloud.y.push_back(y);
}

double turn_of(double angle) {
  const double turns = angle / (2 * std::numbers::pi);
  return turns - std::floor(turns);
}

/// What the bare law leaves of each slip, on average, over a channel at its beginning.
Fingerprint over_slips(const Scene& scene, const FingerprintAxis& axis, const std::vector<double>& channel) {
  Fingerprint out = blank(axis, kLeft);
  const std::vector<double> left = scene.left();
  for (const auto& [begin, end] : slips_of(scene.with.motion)) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += left[i];
    const double x = &channel == &scene.with.motion.disc_angle ? turn_of(channel[begin]) : channel[begin];
    if (end > begin) add(out.clouds[0], x, sum / static_cast<double>(end - begin));
  }
  return out;
}

/// Views of a record with the effect beside one without.
void compare(View view, const SimulatedRecording& record, const Scene& scene, FingerprintCloud& cloud) {
  const SimulatedMotion& motion = record.motion;
  const std::vector<double>& read = record.recording.trace.friction;
  const std::vector<Range> slips = slips_of(motion);
  if (view == View::curve) {
    for (std::size_t i = slips.at(1).first; i < slips.at(1).second; ++i)
      add(cloud, motion.relative_velocity[i], read[i]);
  } else if (view == View::creep) {
    // The second half of a stick, without its end: what re-stick struck has died away.
    const std::size_t begin = slips.at(1).second, end = slips.at(2).first, part = (end - begin) / 30;
    for (std::size_t i = begin + 15 * part; i < end - part; ++i) add(cloud, read[i], motion.relative_velocity[i]);
  } else if (view == View::stick_time) {
    for (const SimulatedSlip& slip : motion.slips) {
      if (slip.stick_time > 0 && slip.break_away_time > 0) add(cloud, slip.stick_time, slip.break_away_friction);
    }
  } else {  // since reversal, of the whole strokes of the record with the effect
    const SimulatedMotion& with = scene.with.motion;
    for (const auto& [begin, end] : slips_of(with)) {
      for (std::size_t i = begin; i < end; i += 5) {
        const double direction = with.relative_velocity[i] < 0 ? -1 : 1;
        add(cloud, with.distance[i] - with.distance[begin], direction * motion.friction[i]);
      }
    }
  }
}

Fingerprint comparison(View view, const Scene& scene) {
  const std::vector<std::string> names = {"with", "without"};
  Fingerprint out = view == View::curve        ? blank(kSpeed, kMu, names)
                    : view == View::creep      ? blank({"mu in stick", "", 1}, kSpeed, names)
                    : view == View::stick_time ? blank({"stick time", "s", 1}, {"mu at break-away", "", 1}, names)
                                               : blank({"since reversal", "mm", 1e-3}, kMu, names);
  compare(view, scene.with, scene, out.clouds[0]);
  compare(view, scene.without, scene, out.clouds[1]);
  return out;
}

/// Views of one slip, or of the stick behind it.
Fingerprint of_one_cycle(View view, const Scene& scene) {
  const SimulatedMotion& motion = scene.with.motion;
  const std::vector<Range> slips = slips_of(motion);
  const auto [begin, end] = slips.at(1);
  const std::vector<double> left = scene.left();
  Fingerprint out;
  if (view == View::loop) {
    out = blank(kSpeed, kLeft, {"gaining speed", "losing speed"});
    for (std::size_t i = begin; i + 1 < end; ++i) {
      const double v = scene.relative_velocity(i);
      add(out.clouds[scene.relative_velocity(i + 1) > v ? 0 : 1], v, left[i]);
    }
  } else if (view == View::since_break_away) {
    out = blank({"time since break-away", "ms", 1e-3}, kLeft);
    for (std::size_t i = begin; i < end; ++i) add(out.clouds[0], motion.time[i] - motion.time[begin], left[i]);
  } else if (view == View::plateau) {  // against omega r as stated
    out = blank({"time in stick", "s", 1}, {"v_b", "mm/s", 1e-3}, {"v_b as read", "omega r as stated"});
    for (std::size_t i = end; i < slips.at(2).first; ++i) {
      const double t = static_cast<double>(i - end) / motion.rate;
      add(out.clouds[0], t, scene.trace().velocity[i]);
      add(out.clouds[1], t, scene.stated());
    }
  } else {
    out = blank({"time in stick", "ms", 1e-3}, {"mu as read minus mu", "", 1});
    for (std::size_t i = end; i < end + 2000; ++i)
      add(out.clouds[0], motion.time[i] - motion.time[end], scene.trace().friction[i] - motion.friction[i]);
  }
  return out;
}

/// Views of all samples.
Fingerprint of_samples(View view, const Scene& scene) {
  const SimulatedMotion& motion = scene.with.motion;
  const Trace& trace = scene.trace();
  const std::vector<double> left = scene.left();
  Fingerprint out = view == View::ripple         ? blank(kTurns, {"v_b in stick", "mm/s", 1e-3})
                    : view == View::acceleration ? blank({"acceleration of the block", "m/s^2", 1}, kLeft)
                    : view == View::load_channel
                        ? blank(kMu, {"load channel", "N", 1})
                        : blank({"|v_r|", "mm/s", 1e-3}, {"|mu|", "", 1}, {"forward", "backward"});
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double v = motion.relative_velocity[i];
    if (view == View::ripple) {
      if (motion.sticks[i] != 0) add(out.clouds[0], turn_of(motion.disc_angle[i]), trace.velocity[i]);
    } else if (view == View::acceleration) {
      if (motion.sticks[i] == 0) add(out.clouds[0], motion.acceleration[i], left[i]);
    } else if (view == View::load_channel) {
      add(out.clouds[0], trace.friction[i], trace.load[i]);
    } else if (std::abs(v) >= 1e-4 && v * motion.disc_speed[i] > 0) {
      add(out.clouds[v > 0 ? 0 : 1], std::abs(v), std::abs(trace.friction[i]));
    }
  }
  return out;
}

Fingerprint draw(View view, const Scene& scene) {
  const SimulatedMotion& motion = scene.with.motion;
  switch (view) {
    case View::time:
      return over_slips(scene, kTime, motion.time);
    case View::distance:
      return over_slips(scene, {"distance slid", "mm", 1e-3}, motion.distance);
    case View::angle:
      return over_slips(scene, kTurns, motion.disc_angle);
    case View::load:
      return over_slips(scene, {"load", "N", 1}, scene.trace().load);
    case View::temperature:
      return over_slips(scene, {"temperature", "degC", 1}, scene.trace().temperature);
    case View::curve:
    case View::stick_time:
    case View::creep:
    case View::since_reversal:
      return comparison(view, scene);
    case View::ripple:
    case View::acceleration:
    case View::load_channel:
    case View::directions:
      return of_samples(view, scene);
    default:
      return of_one_cycle(view, scene);
  }
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
  const Scene scene = play(sketch.view, effect, p);
  Fingerprint print = draw(sketch.view, scene);
  print.conditions = list_of(info.parameters, [&](std::size_t i) { return sketch.values[i]; });
  return print;
}

}  // namespace tribofit
