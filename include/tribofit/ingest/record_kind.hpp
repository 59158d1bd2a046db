#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// What was recorded, and so what its samples are evidence of.
enum class RecordKind {
  stick_slip,     ///< a block that sticks and slips
  sliding,        ///< speed-controlled, never sticks: friction at the lowest speeds counts
  points,         ///< steady points of speed and friction in any order, without time
  spring_slider,  ///< the pull of a spring of known stiffness that draws a mass
  motion_only,    ///< the motion of a mass on a known spring, without friction
  force_only,     ///< friction alone: no motion, and nothing that it would follow from
};

/// "stick-slip", "sliding", "points", "spring-slider", "motion-only", "force-only": as --kind and JSON have them.
std::string_view to_string(RecordKind kind);
/// The kind of exactly that name; nothing where there is none.
std::optional<RecordKind> find_record_kind(std::string_view name);
/// All names, in the order of RecordKind.
std::vector<std::string> record_kind_names();

}  // namespace tribofit
