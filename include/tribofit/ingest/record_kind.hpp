#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// What was recorded, and so what its samples are evidence of.
enum class RecordKind {
  stick_slip,        ///< a block that sticks and slips
  sliding,           ///< speed-controlled, never sticks: friction at the lowest speeds counts
  points,            ///< steady points of speed and friction in any order, without time
  spring_slider,     ///< the pull of a spring of known stiffness that draws a mass
  motion_only,       ///< the motion of a mass on a known spring, without friction
  force_only,        ///< friction alone: no motion, and nothing that it would follow from
  velocity_steps,    ///< a contact on a machine whose load point changes its speed in steps
  slide_hold_slide,  ///< the same where it stops and goes on
};

/// Whether the load point of a machine is driven, and the contact follows by rate-and-state friction.
constexpr bool is_driven_in_steps(std::optional<RecordKind> kind) {
  return kind == RecordKind::velocity_steps || kind == RecordKind::slide_hold_slide;
}

/// Their names in options and JSON, in the order of RecordKind.
inline constexpr std::array<std::string_view, 8> record_kind_texts = {"stick-slip",     "sliding",         "points",
                                                                      "spring-slider",  "motion-only",     "force-only",
                                                                      "velocity-steps", "slide-hold-slide"};

constexpr std::string_view to_string(RecordKind kind) {
  return record_kind_texts.at(static_cast<std::size_t>(kind));
}
/// The kind of exactly that name; nothing where there is none.
std::optional<RecordKind> find_record_kind(std::string_view name);
inline std::vector<std::string> record_kind_names() {
  return {record_kind_texts.begin(), record_kind_texts.end()};
}

}  // namespace tribofit
