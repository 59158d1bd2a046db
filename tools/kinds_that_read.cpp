#include <fmt/format.h>

#include <array>

#include "settings.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/text.hpp"

using namespace tribofit;

namespace {

constexpr unsigned only(RecordKind kind) {
  return 1U << static_cast<unsigned>(kind);
}

constexpr unsigned kStickSlip = only(RecordKind::stick_slip), kMotionOnly = only(RecordKind::motion_only),
                   kSpring = only(RecordKind::spring_slider), kDisc = kStickSlip | only(RecordKind::sliding),
                   kDriven = only(RecordKind::velocity_steps) | only(RecordKind::slide_hold_slide),
                   kTimed = kDisc | kSpring | kMotionOnly, kOfLaws = kTimed | only(RecordKind::points);

/// The options of a section that only some kinds of record read.
struct KindsThatRead {
  const char* section;
  std::string_view options;  ///< divided by blanks; empty: all others of the section
  unsigned kinds;
};

/// Each option is where it is met first; what is not here is read of every kind.
constexpr std::array kTable = {KindsThatRead{section::kReading, "--stick-below", kDisc},
                               KindsThatRead{section::kReading, "--trim", kTimed},
                               KindsThatRead{section::kReading, "--never-sticks", only(RecordKind::sliding)},
                               KindsThatRead{section::kSpring, "--stiffness --mass", kSpring | kMotionOnly},
                               KindsThatRead{section::kSpring, "", kMotionOnly},
                               KindsThatRead{section::kSteps, "--kind", kOfLaws | kDriven},
                               KindsThatRead{section::kSteps, "", kDriven},
                               KindsThatRead{section::kFit, "--start --bounds --exclude", kOfLaws | kDriven},
                               KindsThatRead{section::kFit, "", kOfLaws},
                               KindsThatRead{section::kRig, "", kOfLaws},
                               KindsThatRead{section::kFriction, "", kOfLaws},
                               KindsThatRead{section::kDrive, "--speed-steps", kStickSlip | kDriven},
                               KindsThatRead{section::kDrive, "", kStickSlip},
                               KindsThatRead{section::kScatter, "", kStickSlip},
                               KindsThatRead{section::kSensors, "--noise-mu --noise-colour", kStickSlip | kDriven},
                               KindsThatRead{section::kSensors, "", kStickSlip}};

std::string names_of(unsigned kinds) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < record_kind_texts.size(); ++k) {
    if ((kinds >> k & 1U) != 0) names.emplace_back(record_kind_texts[k]);
  }
  return enumerated(names);
}

}  // namespace

void refuse_unread(const std::vector<Command::Typed>& typed, RecordKind kind) {
  for (const Command::Typed& option : typed) {
    for (const KindsThatRead& row : kTable) {
      const bool is_meant = row.options.empty() || is_among(option.name, row.options);
      if (option.section != row.section || !is_meant) continue;
      if ((row.kinds & only(kind)) != 0) break;
      throw UsageError(fmt::format("{} means nothing for a record of the kind {}; it is for {}", option.name,
                                   to_string(kind), names_of(row.kinds)));
    }
  }
}
