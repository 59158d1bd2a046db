#include "tribofit/study/fingerprint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "oscillator/simulation_checks.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

using View = SketchView;

using Clouds = std::vector<FingerprintCloud>;

/// A record with the effect, and what it is compared with.
struct Scene {
  Law law = law_catalogue().front();
  PublishedTest test = published_test(0.015, law);
  SimulatedRecording with, without;
  const Trace& trace() const { return with.recording.trace; }
  double stated() const { return test.speed * test.radius; }

  /// v_r as a reader of the record makes it.
  double relative_velocity(std::size_t i) const {
    if (with.motion.disc_speed.empty()) return 0;
    return (trace().disc_speed.empty() ? stated() : trace().disc_speed[i] * test.radius) - trace().velocity[i];
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

double turn_of(double angle) {
  const double turns = angle / (2 * std::numbers::pi);
  return turns - std::floor(turns);
}

/// Of a record with the effect, or of one without.
void add_record(View view, const SimulatedRecording& record, const Scene& scene, FingerprintCloud& cloud) {
  const SimulatedMotion& motion = record.motion;
  const std::vector<double>& read = record.recording.trace.friction;
  const auto slips = slips_of(motion);
  if (view == View::curve) {
    for (std::size_t i = slips.at(1).first; i < slips.at(1).second; ++i)
      cloud.add(motion.relative_velocity[i], read[i]);
  } else if (view == View::creep) {
    // The second half of a stick, without its end: what re-stick struck has died away.
    const std::size_t begin = slips.at(1).second, end = slips.at(2).first, part = (end - begin) / 30;
    for (std::size_t i = begin + 15 * part; i < end - part; ++i) cloud.add(read[i], motion.relative_velocity[i]);
  } else if (view == View::stick_time) {
    for (const SimulatedSlip& slip : motion.slips) {
      if (slip.stick_time > 0 && slip.break_away_time > 0) cloud.add(slip.stick_time, slip.break_away_friction);
    }
  } else {  // since reversal, of the whole strokes of the record with the effect
    const SimulatedMotion& with = scene.with.motion;
    for (const auto& [begin, end] : slips_of(with)) {
      for (std::size_t i = begin; i < end; i += 5) {
        const double direction = with.relative_velocity[i] < 0 ? -1 : 1;
        cloud.add(with.distance[i] - with.distance[begin], direction * motion.friction[i]);
      }
    }
  }
}

void add_compared(View view, const Scene& scene, Clouds& clouds) {
  add_record(view, scene.with, scene, clouds[0]);
  add_record(view, scene.without, scene, clouds[1]);
}

/// What the bare law leaves of each slip, on average, over a channel at its beginning.
void add_slips(View view, const Scene& scene, Clouds& clouds) {
  const SimulatedMotion& motion = scene.with.motion;
  const std::vector<double>& channel = view == View::distance      ? motion.distance
                                       : view == View::angle       ? motion.disc_angle
                                       : view == View::load        ? scene.trace().load
                                       : view == View::temperature ? scene.trace().temperature
                                                                   : motion.time;
  const std::vector<double> left = scene.left();
  for (const auto& [begin, end] : slips_of(motion)) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += left[i];
    const double x = view == View::angle ? turn_of(channel[begin]) : channel[begin];
    if (end > begin) clouds[0].add(x, sum / static_cast<double>(end - begin));
  }
}

/// Of one slip, or of the stick behind it.
void add_cycle(View view, const Scene& scene, Clouds& clouds) {
  const SimulatedMotion& motion = scene.with.motion;
  const Trace& trace = scene.trace();
  const auto slips = slips_of(motion);
  const auto [begin, end] = slips.at(1);
  const std::vector<double> left = scene.left();
  if (view == View::loop) {
    for (std::size_t i = begin; i + 1 < end; ++i) {
      const double v = scene.relative_velocity(i);
      clouds[scene.relative_velocity(i + 1) > v ? 0 : 1].add(v, left[i]);
    }
  } else if (view == View::since_break_away) {
    for (std::size_t i = begin; i < end; ++i) clouds[0].add(motion.time[i] - motion.time[begin], left[i]);
  } else if (view == View::plateau) {  // against omega r as stated
    for (std::size_t i = end; i < slips.at(2).first; ++i) {
      const double t = static_cast<double>(i - end) / motion.rate;
      clouds[0].add(t, trace.velocity[i]);
      clouds[1].add(t, scene.stated());
    }
  } else {
    for (std::size_t i = end; i < end + 2000; ++i) {
      clouds[0].add(motion.time[i] - motion.time[end], trace.friction[i] - motion.friction[i]);
    }
  }
}

/// Of all samples.
void add_samples(View view, const Scene& scene, Clouds& clouds) {
  const SimulatedMotion& motion = scene.with.motion;
  const Trace& trace = scene.trace();
  const std::vector<double> left = scene.left();
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double v = motion.relative_velocity[i];
    if (view == View::ripple) {
      if (motion.sticks[i] != 0) clouds[0].add(turn_of(motion.disc_angle[i]), trace.velocity[i]);
    } else if (view == View::acceleration) {
      if (motion.sticks[i] == 0) clouds[0].add(motion.acceleration[i], left[i]);
    } else if (view == View::load_channel) {
      clouds[0].add(trace.friction[i], trace.load[i]);
    } else if (std::abs(v) >= 1e-4 && v * motion.disc_speed[i] > 0) {
      clouds[v > 0 ? 0 : 1].add(std::abs(v), std::abs(trace.friction[i]));
    }
  }
}

/// What is simulated for a view, and what is drawn of it.
struct ViewPlan {
  FingerprintAxis x, y;
  double duration;  ///< [s]
  void (*add)(View, const Scene&, Clouds&);
  std::vector<std::string> clouds = {""};
};

/// In the order of SketchView.
const ViewPlan& plan_of(View view) {
  const FingerprintAxis mu = {"mu", "", 1}, left = {"mu minus bare law", "", 1}, speed = {"v_r", "mm/s", 1e-3},
                        turns = {"turns of the disc", "", 1};
  const std::vector<std::string> beside = {"with", "without"};
  static const std::vector<ViewPlan> plans = {
      {speed, left, 1.2, add_cycle, {"gaining speed", "losing speed"}},
      {speed, mu, 1.2, add_compared, beside},
      {{"|v_r|", "mm/s", 1e-3}, {"|mu|", "", 1}, 2, add_samples, {"forward", "backward"}},
      {{"mu in stick", "", 1}, speed, 1.2, add_compared, beside},
      {{"stick time", "s", 1}, {"mu at break-away", "", 1}, 26, add_compared, beside},
      {{"time", "s", 1}, left, 42, add_slips},
      {{"distance slid", "mm", 1e-3}, left, 42, add_slips},
      {{"since reversal", "mm", 1e-3}, mu, 10, add_compared, beside},
      {turns, left, 42, add_slips},
      {{"load", "N", 1}, left, 42, add_slips},
      {{"temperature", "degC", 1}, left, 42, add_slips},
      {{"time since break-away", "ms", 1e-3}, left, 1.2, add_cycle},
      {{"acceleration of the block", "m/s^2", 1}, left, 1.2, add_samples},
      {mu, {"load channel", "N", 1}, 1.2, add_samples},
      {{"time in stick", "s", 1}, {"v_b", "mm/s", 1e-3}, 1.2, add_cycle, {"v_b as read", "omega r as stated"}},
      {turns, {"v_b in stick", "mm/s", 1e-3}, 42, add_samples},
      {{"time in stick", "ms", 1e-3}, {"mu as read minus mu", "", 1}, 1.2, add_cycle},
  };
  return plans[static_cast<std::size_t>(view)];
}

Drive drive_for(View view, const PublishedTest& test) {
  Drive drive{.speed = constant_speed(test.speed), .radius = test.radius, .mean_load = test.load};
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
  SimulationOptions options{.duration = plan_of(view).duration, .settle = 1.6, .tolerance = 1e-8};
  if (options.duration > 5) options.rate = 1000;
  const Drive drive = drive_for(view, test);
  scene.with = simulate_recording(FrictionModel(scene.law, {effect}), p, test.rig, drive, options);
  if (plan_of(view).add == add_compared) {
    scene.without = simulate_recording(FrictionModel(scene.law), test.friction, test.rig, drive, options);
  }
  return scene;
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
  const ViewPlan& plan = plan_of(sketch.view);
  Fingerprint print{.x = plan.x, .y = plan.y};
  for (const std::string& name : plan.clouds) print.clouds.push_back({.name = name});
  plan.add(sketch.view, play(sketch.view, effect, p), print.clouds);
  print.conditions = list_of(info.parameters, [&](std::size_t i) { return sketch.values[i]; });
  return print;
}

}  // namespace tribofit
