#include "load_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "motion_channels.hpp"
#include "statistics/piecewise_lines.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit::kinematics {

namespace {

/// The integral of a recorded speed.
std::vector<double> displacement_from(const std::vector<double>& time, const std::vector<double>& speed) {
  std::vector<double> out(time.size(), 0.0);
  for (std::size_t i = 1; i < time.size(); ++i)
    out[i] = out[i - 1] + 0.5 * (speed[i - 1] + speed[i]) * (time[i] - time[i - 1]);
  return out;
}

/// Stretches of one speed.
std::vector<LoadPointPhase> phases_of(const std::vector<double>& time, const std::vector<double>& displacement) {
  std::vector<LoadPointPhase> out;
  for (const LinePiece& piece : piecewise_lines(time, displacement))
    out.push_back({piece.begin, piece.is_level ? 0 : piece.slope});
  return out;
}

/// Sliding has one direction, which counts as forwards.
void settle_direction(const std::string& path, std::vector<LoadPointPhase>& phases) {
  const auto is_back = [](const LoadPointPhase& phase) { return phase.speed < 0; };
  const auto moves = [](const LoadPointPhase& phase) { return phase.speed != 0; };
  const auto back = std::count_if(phases.begin(), phases.end(), is_back);
  const auto all = std::count_if(phases.begin(), phases.end(), moves);
  if (2 * back > all) {
    for (LoadPointPhase& phase : phases) phase.speed = -phase.speed;
  }
  const auto turned = std::find_if(phases.begin(), phases.end(), is_back);
  if (turned == phases.end()) return;
  throw InputError(fmt::format("the load point turns round at {:.6g} s", turned->begin),
                   "velocity steps have one direction: cut the record, or read it as --kind sliding", {path, 0, ""});
}

}  // namespace

Motion motion_of_load_point(Trace trace) {
  Motion motion;
  motion.step = trace.interval();
  std::vector<double> displacement;
  if (!trace.load_point.empty()) {
    motion.load_point = trace.load_point;
    motion.load_point_source = LoadPointSource::stated;
  } else if (!trace.load_point_speed.empty()) {
    displacement = displacement_from(trace.time, trace.load_point_speed);
    motion.load_point_source = LoadPointSource::speed;
  } else {
    displacement = std::move(trace.drive_position);
  }
  if (motion.load_point.empty()) motion.load_point = phases_of(trace.time, displacement);
  settle_direction(trace.path, motion.load_point);
  trace.velocity_kind = VelocityKind::relative;
  trace.velocity.assign(trace.size(), 0.0);
  for (std::size_t i = 0, phase = 0; i < trace.size() && !motion.load_point.empty(); ++i) {
    while (phase + 1 < motion.load_point.size() && motion.load_point[phase + 1].begin <= trace.time[i]) ++phase;
    trace.velocity[i] = motion.load_point[phase].speed;
  }
  const bool holds = std::any_of(motion.load_point.begin(), motion.load_point.end(),
                                 [](const LoadPointPhase& phase) { return phase.speed == 0; });
  if (holds && trace.kind_source != "stated") trace.kind = RecordKind::slide_hold_slide;
  require_channels(trace);
  take_kinds(trace, {}, motion);
  motion.time = std::move(trace.time);
  motion.friction = std::move(trace.friction);
  motion.relative_velocity = std::move(trace.velocity);
  motion.load = std::move(trace.load);
  motion.temperature = std::move(trace.temperature);
  motion.conditions = trace.conditions;
  motion.normal_stress = trace.normal_stress;
  motion.steps = std::move(trace.steps);
  if (motion.steps.empty()) motion.steps = {{0, motion.size(), "", motion.conditions}};
  return motion;
}

}  // namespace tribofit::kinematics
