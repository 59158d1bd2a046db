#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "numbers.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/kinematics/health_names.hpp"

namespace tribofit {
namespace {

/// Held-out error over the floor up to which nothing worth naming is left.
constexpr double kAtTheFloor = 1.15;
/// Held-out error over that of the fitted cycles from which a model has learnt its cycles by heart.
constexpr double kCarriesOver = 1.5;
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
  if (ratio < 1 / kAtTheFloor) {
    return fmt::format(
        "{} leaves {} on data it has not seen, less than the floor of {}: the floor is overestimated here, so whether "
        "anything is missing cannot be told from it.",
        name, held_out, floor);
  }
  if (fit.error.held_out_rmse > kCarriesOver * fit.error.rmse) {
    return fmt::format(
        "{} does not carry over to cycles it has not seen: it leaves {} there and {} on those it was fitted to. Do not "
        "rely on its values.",
        name, held_out, significant(fit.error.rmse, 2) + unit);
  }
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

/// Parameters that these data do not fix, as a sentence; empty where all are fixed.
std::string undetermined(const Fit& fit) {
  std::string names;
  for (const FitParameter& p : fit.parameters) {
    if (!p.at_bound && p.upper95 - p.lower95 < std::abs(p.value)) continue;
    names += (names.empty() ? "" : ", ") + (p.effect.empty() ? "" : p.effect + " ") + p.parameter.name;
  }
  return names.empty() ? "" : " Not determined by these data: " + names + ".";
}

/// Checks of the data that bear on the values and are not in order.
std::string open_problems(const Identification& r) {
  std::string names;
  for (const HealthItem& item : r.motion.health) {
    const bool bears = item.check == health_check::kPlateauSpeed || item.check == health_check::kSpeedRipple ||
                       item.check == health_check::kChannelDelay || item.check == health_check::kClipping ||
                       item.check == health_check::kDropOuts;
    if (bears && item.status != HealthItem::Status::ok) names += (names.empty() ? "" : ", ") + item.check;
  }
  return names.empty() ? "" : " The values stand or fall with what the health check says of " + names + ".";
}

bool has_option(const std::vector<std::string>& arguments, const std::string& name) {
  return std::any_of(arguments.begin(), arguments.end(),
                     [&](const std::string& a) { return a == name || a.rfind(name + "=", 0) == 0; });
}

/// `identify diagnose` with the user's own options, as far as it knows them.
std::string diagnose_command(const TerminalOptions& options, const std::string& path) {
  TerminalOptions known = options;
  known.arguments = {"diagnose"};
  for (std::size_t k = 0; k < options.arguments.size(); ++k) {
    const std::string& name = options.arguments[k];
    if (name == "--profile") continue;
    if (name == "--protocol") {
      ++k;  // its value
      continue;
    }
    known.arguments.push_back(name);
  }
  return command_line(known, "", path);
}

}  // namespace

std::string verdict(const Identification& result) {
  if (!result.analysed) return "No law was fitted; what the trace does show stands above.";
  if (result.fits.empty() || !usable(result.fits[result.best])) {
    return "No fit can be trusted here; the notes at the fits say why.";
  }
  return verdict_on(result, result.fits[result.best]) + undetermined(result.fits[result.best]) + open_problems(result);
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
  if (over_floor(best) > kAtTheFloor) {
    return {"to see where the law fails and which effect is missing", diagnose_command(options, result.path)};
  }
  if (!options.csv_written) {
    return {"to plot the curve, the residuals and the cycles", command_line(options, "--csv " + folder, result.path)};
  }
  if (!has_option(options.arguments, "--profile")) {
    return {"to check the intervals by profile likelihood", command_line(options, "--profile", result.path)};
  }
  return {"to see which effects can be added", "identify effects"};
}

std::string command_line(const TerminalOptions& options, const std::string& more, const std::string& path) {
  std::string text = "identify";
  for (const std::string& argument : options.arguments) text += " " + shell_quoted(argument);
  if (!more.empty()) text += " " + more;
  return text + " " + shell_quoted(path.rfind('-', 0) == 0 ? "./" + path : path);
}

std::string shell_quoted(const std::string& argument) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace tribofit
