#include "condition_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "numbers.hpp"

namespace tribofit {
namespace {

/// "15 mm (command line)", or every step's own where they differ.
std::string condition(const Motion& motion, Condition Conditions::*which, double unit, std::string_view name) {
  const Condition& whole = motion.conditions.*which;
  const auto with_source = [](std::string text, const std::string& source) {
    return source.empty() ? text : text + " (" + source + ")";
  };
  if (whole.known()) return with_source(brief(whole.value / unit) + " " + std::string(name), whole.source);
  std::string list;
  std::string source;
  for (const Step& step : motion.steps) {
    const Condition& own = step.conditions.*which;
    if (!own.known()) continue;
    list += (list.empty() ? "" : ", ") + brief(own.value / unit);
    source = own.source;
  }
  if (list.empty()) return "not known";
  return with_source(list + " " + std::string(name) + " by step", source);
}

std::string speed_text(const Motion& motion) {
  if (motion.disc_speed.empty()) return condition(motion, &Conditions::speed, kRpm, "rpm");
  const auto [low, high] = std::minmax_element(motion.disc_speed.begin(), motion.disc_speed.end());
  return fmt::format("{} to {} rpm (recorded)", brief(*low / kRpm), brief(*high / kRpm));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> condition_texts(const Motion& motion) {
  return {{"radius", condition(motion, &Conditions::radius, kMillimetre, "mm")},
          {"disc speed", speed_text(motion)},
          {"load", condition(motion, &Conditions::load, 1, "N")}};
}

}  // namespace tribofit
