#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "plateau_search.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

// What becomes of the channels of a trace when they become those of a motion.

namespace tribofit::kinematics {

/// Throws InputError where the trace cannot be made a motion.
inline void require_channels(const Trace& trace) {
  const std::size_t n = trace.size();
  const InputLocation where{trace.path, 0, ""};
  if (n < 2) throw InputError("the trace has fewer than two samples", "give a longer record", where);
  if (trace.friction.size() != n)
    throw InputError("the trace has no friction for every sample", "name the friction column", where);
  if (trace.velocity_kind != VelocityKind::fixed_block && trace.velocity.size() != n) {
    throw InputError("the trace has no velocity for every sample",
                     "name the column with --columns v_b=NAME or v_r=NAME", where);
  }
}

/// A channel that was not recorded, or a handful of samples: valid, but nothing can be found in it.
inline bool is_useless(const Trace& trace) {
  constexpr std::size_t few = 16;
  const Extremes range = extremes(trace.velocity);
  return range.low == range.high || (trace.size() < few && trace.conditions.radius.known());
}

/// The kinds of record, friction and velocity, with the rule of stick that goes with it, beside what the user says of
/// stick.
inline void take_kinds(const Trace& trace, const StickRule& stick, Motion& motion) {
  motion.kind = trace.kind;
  motion.kind_source = trace.kind_source;
  motion.spring = trace.spring;
  motion.friction_kind = trace.friction_kind;
  motion.velocity_kind = trace.velocity_kind;
  motion.stick = stick;
  motion.stick.never |= trace.kind == RecordKind::sliding;
  motion.stick.always |= trace.kind == RecordKind::stick_slip;
}

inline void take_conditions_from_instruments(Conditions& conditions, const Instruments::Rig& rig) {
  const auto take = [](Condition& condition, const std::optional<Declared>& declared) {
    if (!condition.known() && declared) condition = {declared->value, "instruments"};
  };
  take(conditions.radius, rig.radius);
  take(conditions.speed, rig.speed);
  take(conditions.load, rig.load);
}

template <class T>
void drop_ends(std::vector<T>& channel, std::size_t head, std::size_t tail) {
  if (channel.empty()) return;
  channel.resize(channel.size() - tail);
  if (head > 0) channel.erase(channel.begin(), channel.begin() + static_cast<std::ptrdiff_t>(head));
}

inline std::vector<Step> steps_within(const std::vector<Step>& steps, std::size_t head, std::size_t size) {
  std::vector<Step> kept;
  for (Step step : steps) {
    step.begin = step.begin > head ? step.begin - head : 0;
    step.end = std::min(step.end > head ? step.end - head : 0, size);
    if (step.begin < step.end) kept.push_back(std::move(step));
  }
  return kept;
}

/// What was recorded, of a trace with v_r that no stage changes any more; the record is one step where it has none.
inline void take_channels(Trace& trace, Motion& motion) {
  motion.time = std::move(trace.time);
  motion.friction = std::move(trace.friction);
  motion.relative_velocity = std::move(trace.velocity);
  motion.load = std::move(trace.load);
  motion.temperature = std::move(trace.temperature);
  motion.conditions = trace.conditions;
  motion.steps = std::move(trace.steps);
  if (motion.steps.empty()) motion.steps = {{0, motion.size(), "", motion.conditions}};
}

/// v_r in the place of v_b.
inline void make_relative(std::vector<double>& velocity, const Disc& disc, int threads) {
  run_over_parts(velocity.size(), threads, [&](std::size_t begin, std::size_t end) {
    const double constant = disc.constant;
    if (disc.varying.empty()) {
      for (std::size_t i = begin; i < end; ++i) velocity[i] = constant - velocity[i];
    } else {
      for (std::size_t i = begin; i < end; ++i) velocity[i] = disc.varying[i] - velocity[i];
    }
  });
}

}  // namespace tribofit::kinematics
