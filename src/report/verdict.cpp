#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "numbers.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

/// Held-out error over the floor up to which nothing worth naming is left.
constexpr double kAtTheFloor = 1.15;
/// ... and up to which little is.
constexpr double kNearTheFloor = 1.5;
/// ... and from which a ratio says no more than "far".
constexpr double kFarAbove = 100;
/// Mean relative errors that count as close, and as an outline only ([D] calls 8 % good).
constexpr double kClose = 0.02, kOutline = 0.08;

bool usable(const Fit& fit) {
  return fit.converged && !fit.parameters.empty();
}

double over_floor(const Fit& fit) {
  constexpr double kRounding = 1e-9;
  if (fit.error.held_out_rmse < kRounding) return 1;  // simulated without noise
  return fit.floor.rmse > 0 ? fit.error.held_out_rmse / fit.floor.rmse : std::nan("");
}

std::string verdict_on(const Identification& r, const Fit& fit) {
  const std::string unit = friction_unit(r.motion) == "N" ? " N" : "";
  const double ratio = over_floor(fit);
  const std::string name = (fit.model.effects().empty() ? "The " : "The law ") + fit.model.name() +
                           (fit.model.effects().empty() ? " law" : "");
  const std::string held_out = significant(fit.error.held_out_rmse, 2) + unit;
  const std::string floor = significant(fit.floor.rmse, 2) + unit;
  if (ratio <= kAtTheFloor) {
    return fmt::format(
        "{} describes this trace as well as its noise allows: its error on data it has not seen is "
        "{}, and the floor is {}.",
        name, held_out, floor);
  }
  const std::string typical = percent(fit.error.mean_relative);
  std::string remains = fmt::format("its error on data it has not seen is {}", held_out);
  if (ratio > kFarAbove) remains += fmt::format(", far above the floor of {}", floor);
  if (ratio <= kFarAbove) remains += fmt::format(", {} times the floor of {}", significant(ratio, 2), floor);
  if (ratio <= kNearTheFloor && fit.error.mean_relative <= kOutline) {
    return fmt::format("{} describes this trace well (typically {} off): {}. Little is left to explain.", name, typical,
                       remains);
  }
  if (fit.error.mean_relative <= kClose) {
    return fmt::format("{} is close (typically {} off), but {}: something small is missing from it.", name, typical,
                       remains);
  }
  if (fit.error.mean_relative <= kOutline) {
    return fmt::format("{} gives the outline only (typically {} off): {}, so something is missing from it.", name,
                       typical, remains);
  }
  return fmt::format("{} does not describe this trace (typically {} off): {}. Do not rely on its values.", name,
                     typical, remains);
}

bool has_option(const std::vector<std::string>& arguments, const std::string& name) {
  return std::any_of(arguments.begin(), arguments.end(),
                     [&](const std::string& a) { return a == name || a.rfind(name + "=", 0) == 0; });
}

std::string command_line(const TerminalOptions& options, const std::string& more, const std::string& path) {
  std::string text = "identify";
  for (const std::string& argument : options.arguments) text += " " + shell_quoted(argument);
  if (!more.empty()) text += " " + more;
  return text + " " + shell_quoted(path.rfind('-', 0) == 0 ? "./" + path : path);
}

bool has_channels(const Channels& needs, const Motion& motion) {
  return (!needs.load || !motion.load.empty()) && (!needs.temperature || !motion.temperature.empty()) &&
         (!needs.angle || !motion.disc_angle.empty() || motion.conditions.speed.known());
}

/// The first effect of the catalogue that is not in the fit and whose channels the trace has.
std::optional<std::string> untried_effect(const Identification& r, const Fit& fit) {
  const std::vector<std::string> used = fit.model.effect_keys();
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    const bool tried = std::find(used.begin(), used.end(), info.key) != used.end();
    if (!tried && has_channels(info.needs, r.motion)) return info.key;
  }
  return std::nullopt;
}

}  // namespace

std::string verdict(const Identification& result) {
  if (!result.analysed) return "No law was fitted; what the trace does show stands above.";
  if (result.fits.empty() || !usable(result.fits[result.best])) {
    return "No fit can be trusted here; the notes at the fits say why.";
  }
  return verdict_on(result, result.fits[result.best]);
}

Suggestion next_command(const Identification& result, const TerminalOptions& options) {
  const std::string folder = shell_quoted(std::filesystem::path(result.path).stem().string() + "-csv");
  const bool fitted = result.analysed && !result.fits.empty() && usable(result.fits[result.best]);
  if (!fitted) {
    if (result.motion.trimmed > 0 && !has_option(options.arguments, "--no-trim")) {
      return {"to see whether the run-up that was left out shows more",
              command_line(options, "--no-trim", result.path)};
    }
    if (!options.csv_written) {
      return {"to look at the trace sample by sample", command_line(options, "--csv " + folder, result.path)};
    }
    return {"to see which options there are", "identify --help"};
  }
  const Fit& best = result.fits[result.best];
  if (!(over_floor(best) <= kAtTheFloor)) {
    if (const auto key = untried_effect(result, best)) {
      return {"to test whether '" + *key + "' is what is missing (`identify effects` explains it)",
              command_line(options, "--effect " + *key, result.path)};
    }
  }
  if (!options.csv_written) {
    return {"to plot the curve, the residuals and the cycles", command_line(options, "--csv " + folder, result.path)};
  }
  if (!has_option(options.arguments, "--profile")) {
    return {"to check the intervals by profile likelihood", command_line(options, "--profile", result.path)};
  }
  return {"to see which effects can be added", "identify effects"};
}

std::string shell_quoted(const std::string& argument) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace tribofit
