#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/kinematics/health_names.hpp"

namespace tribofit {
namespace {

std::string verdict_on(const Identification& r, const Fit& fit) {
  const auto level = [&](double value) { return significant(value, 2) + (friction_unit(r.motion) == "N" ? " N" : ""); };
  const bool bare = fit.model.effects().empty();
  const std::string name = (bare ? "The " : "The law ") + fit.model.name() + (bare ? " law" : "");
  const std::string held_out = level(fit.error.held_out_rmse), floor = level(fit.floor.rmse);
  const std::string typical = percent(fit.error.mean_relative);
  std::string remains = "its held-out error is " + held_out;
  const double ratio = over_floor(fit);
  if (ratio > kFarAboveFloor) {
    remains += ", far above the noise floor of " + floor;
  } else if (ratio <= kFarAboveFloor) {
    remains += fmt::format(", {} times the noise floor of {}", significant(ratio, 2), floor);
  }
  switch (quality_of(fit)) {
    case FitQuality::floor_too_high:
      return fmt::format(
          "{} has a held-out error of {}, less than the noise floor of {}: the noise floor is overestimated here, so "
          "the data do not say whether an effect is missing.",
          name, held_out, floor);
    case FitQuality::not_transferable:
      return fmt::format(
          "{} does not carry over to held-out cycles: its error there is {}, and {} on the cycles it was fitted to. Do "
          "not rely on its values.",
          name, held_out, level(fit.error.rmse));
    case FitQuality::at_floor:
      return fmt::format(
          "{} describes this trace as well as its noise allows: the held-out error is {}, the noise floor {}.", name,
          held_out, floor);
    case FitQuality::close:
      return fmt::format("{} is close (typically {} off), but {}: it lacks a small effect.", name, typical, remains);
    case FitQuality::outline:
      return fmt::format("{} gives the outline only (typically {} off): {}, so it lacks an effect.", name, typical,
                         remains);
    case FitQuality::poor:
    case FitQuality::unusable:
      break;
  }
  return fmt::format("{} does not describe this trace (typically {} off): {}. Do not rely on its values.", name,
                     typical, remains);
}

/// Parameters that these data do not fix, as a sentence; empty where all are fixed.
std::string undetermined(const Fit& fit) {
  std::string names;
  for (const FitParameter& p : fit.parameters) {
    if (is_fixed(p)) continue;
    names += (names.empty() ? "" : ", ") + (p.effect.empty() ? "" : p.effect + " ") + p.parameter.name;
  }
  return names.empty() ? "" : " Not determined by these data: " + names + ".";
}

/// Checks of the data that bear on the values and are not in order.
std::string open_problems(const Identification& r) {
  constexpr std::array<std::string_view, 5> kBearing = {health_check::kPlateauSpeed, health_check::kSpeedRipple,
                                                        health_check::kChannelDelay, health_check::kClipping,
                                                        health_check::kDropOuts};
  std::string names;
  for (const HealthItem& item : r.motion.health) {
    const bool bears = std::find(kBearing.begin(), kBearing.end(), item.check) != kBearing.end();
    if (bears && item.status != HealthItem::Status::ok) names += (names.empty() ? "" : ", ") + item.check;
  }
  return names.empty() ? "" : " The values depend on what the health check says of " + names + ".";
}

}  // namespace

std::string verdict(const Identification& result) {
  if (!result.analysed) return "No law was fitted; what the trace does show stands above.";
  if (result.fits.empty() || quality_of(result.fits[result.best]) == FitQuality::unusable) {
    return "No fit can be trusted here; the notes at the fits say why.";
  }
  return verdict_on(result, result.fits[result.best]) + undetermined(result.fits[result.best]) + open_problems(result);
}

Suggestion next_command(const Identification& result, const TerminalOptions& options) {
  const std::vector<std::string> csv = {"--csv", csv_folder_for(result.path)};
  const bool fitted =
      result.analysed && !result.fits.empty() && quality_of(result.fits[result.best]) != FitQuality::unusable;
  if (!fitted) {
    if (result.motion.trimmed > 0 && !has_option(options.arguments, "--no-trim")) {
      return {"to see whether the run-up that was left out shows more",
              command_line(options, {"--no-trim"}, result.path)};
    }
    if (!options.csv_written) {
      return {"to look at the trace sample by sample", command_line(options, csv, result.path)};
    }
    return {"to see which options there are", "identify --help"};
  }
  if (over_floor(result.fits[result.best]) > kAtFloor) {
    return {"to see where the law fails and which effect is missing",
            command_line(words_of({"diagnose"}, options.arguments, {"--profile"}, {"--protocol"}), {result.path})};
  }
  if (!options.csv_written) {
    return {"to plot the curve, the residuals and the cycles", command_line(options, csv, result.path)};
  }
  if (!has_option(options.arguments, "--profile")) {
    return {"to check the intervals by profile likelihood", command_line(options, {"--profile"}, result.path)};
  }
  return {"to see which effects can be added", "identify effects"};
}

}  // namespace tribofit
