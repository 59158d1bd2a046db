#include "declared_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "limits.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

namespace {

constexpr const char* kSource = "instruments file";

}  // namespace

ReadOptions with_declared_conditions(ReadOptions read, const Instruments& instruments) {
  const auto declare = [](Condition& condition, const std::optional<Declared>& declared) {
    if (!condition.known() && declared) condition = {declared->value, kSource};
  };
  if (read.step_radii.empty()) declare(read.conditions.radius, instruments.rig.radius);
  declare(read.conditions.speed, instruments.rig.speed);
  declare(read.conditions.load, instruments.rig.load);
  return read;
}

std::vector<std::string> warnings_beside_declared(const Conditions& used, const Instruments& instruments,
                                                  bool rig_is_wanted) {
  std::vector<std::string> warnings;
  const auto compare = [&](const Condition& condition, const std::optional<Declared>& declared, const char* name) {
    if (!declared || !condition.known() || condition.source == kSource) return;
    const double allowed =
        std::max(kDeclaredRounding * std::abs(declared->value), kDeclaredWithin * declared->uncertainty);
    if (std::abs(condition.value - declared->value) <= allowed) return;
    warnings.push_back(fmt::format("the {} from the {} ({} in SI units) is used, not that of the instruments file ({})",
                                   name, condition.source, general(condition.value, 4), general(declared->value, 4)));
  };
  compare(used.radius, instruments.rig.radius, "radius");
  compare(used.speed, instruments.rig.speed, "disc speed");
  compare(used.load, instruments.rig.load, "load");
  const auto only_for_rig = [&](const std::optional<Declared>& declared, const char* name) {
    if (declared && !rig_is_wanted)
      warnings.push_back(fmt::format("{} is declared in the instruments file; only `identify rig` uses it", name));
  };
  only_for_rig(instruments.rig.stiffness, "rig.stiffness");
  only_for_rig(instruments.rig.ping_frequency, "rig.ping_frequency");
  if (instruments.rig.pad_radius)
    warnings.emplace_back("rig.pad_radius is declared in the instruments file but nothing uses it yet");
  return warnings;
}

}  // namespace tribofit
