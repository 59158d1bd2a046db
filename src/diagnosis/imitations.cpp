#include "imitations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "fit/errors.hpp"
#include "limits.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::diagnosis {
namespace {

/// Where the evidence of an effect is.
enum class Evidence { within_cycle, in_stick, on_plateau, at_break_away, in_time, elsewhere };

Evidence place_of(SketchView view) {
  switch (view) {
    case SketchView::loop:
    case SketchView::curve:
    case SketchView::directions:
    case SketchView::since_break_away:
    case SketchView::since_reversal:
    case SketchView::acceleration:
    case SketchView::line:  // what is wrong in every cycle comes back with their period
      return Evidence::within_cycle;
    case SketchView::creep:
      return Evidence::in_stick;
    case SketchView::plateau:
      return Evidence::on_plateau;
    case SketchView::stick_time:
      return Evidence::at_break_away;
    case SketchView::time:
    case SketchView::distance:
      return Evidence::in_time;
    case SketchView::angle:
    case SketchView::load:
    case SketchView::temperature:
    case SketchView::load_channel:
    case SketchView::ripple:
      break;
  }
  return Evidence::elsewhere;
}

bool imitates(std::string_view check, Evidence evidence) {
  using namespace health_check;
  if (evidence == Evidence::elsewhere) return false;
  if (check == kDropOuts) return evidence == Evidence::in_time;
  if (check == kClipping || check == kBandwidth) return evidence != Evidence::in_time;
  // What explains a plateau that is not at omega r, as creep does, is not imitated by it.
  if (check == kPlateauSpeed || check == kFrictionZero) return evidence == Evidence::within_cycle;
  const bool distorts = check == kResolution || check == kChannelDelay;
  return distorts && evidence != Evidence::at_break_away && evidence != Evidence::in_time;
}

/// Checks that report a problem, each once; not one that was corrected.
std::vector<std::string> problems_of(std::span<const Record> records) {
  std::vector<std::string> checks;
  for (const Record& record : records) {
    const bool is_plateau_right = record.motion->plateau_correction != PlateauCorrection::none;
    for (const HealthItem& item : record.motion->health) {
      if (is_plateau_right && item.check == health_check::kPlateauSpeed) continue;
      const bool is_known = std::find(checks.begin(), checks.end(), item.check) != checks.end();
      if (item.status == HealthItem::Status::problem && !is_known) checks.push_back(item.check);
    }
  }
  return checks;
}

/// How well the time between the channels is known where a low-pass was undone [s]; 0 where none was. A filter may hold
/// its input for a sample, which is half of one either way.
double time_left_by_filters(const Motion& motion) {
  const Estimate &v = motion.velocity_low_pass, &mu = motion.friction_low_pass;
  return v.any() || mu.any() ? std::hypot(v.std_error, mu.std_error, 0.5 * motion.step) : 0;
}

}  // namespace

double left_by_corrections(std::span<const Record> records, const Observations& observations, double noise) {
  double squares = 0;
  for (const auto& slip : observations.slips) {
    const Motion& motion = *records[slip.record].motion;
    const double time = time_left_by_filters(motion);
    if (time == 0) continue;
    // Over a part of the slip: between neighbours noise is more than the change.
    const std::size_t reach = std::max<std::size_t>(1, (slip.end - slip.begin) / limits::kPartsOfSlip);
    for (std::size_t i = slip.begin; i + reach < slip.end; ++i) {
      const std::size_t k = i + reach;
      if (observations.weight[k] < limits::kUnused) continue;
      const double passed = std::max(motion.step, observations.time[k] - observations.time[i]);
      const double change = observations.friction[k] - observations.friction[i];
      const double by_noise = noise * noise * (1 / observations.weight[i] + 1 / observations.weight[k]);
      squares += observations.weight[i] * (change * change - by_noise) * std::pow(time / passed, 2);
    }
  }
  return std::max(0.0, squares);
}

std::string imitated_by(std::span<const Record> records, SketchView view) {
  for (const std::string& check : problems_of(records)) {
    if (imitates(check, place_of(view))) return fmt::format("the check {} reports a problem that looks like it", check);
  }
  return {};
}

void add_open_problems(std::span<const Record> records, Diagnosis& diagnosis) {
  for (const std::string& check : problems_of(records)) {
    const bool stands = imitates(check, Evidence::within_cycle) || imitates(check, Evidence::in_time);
    if (!stands) continue;
    diagnosis.messages.push_back(
        fmt::format("the check {} reports a problem: effects that look like it are not named", check));
  }
}

void offer_load_variation(std::span<const Record> records, Diagnosis& diagnosis) {
  const auto has_load = [](const Record& record) { return !record.motion->load.empty(); };
  if (std::any_of(records.begin(), records.end(), has_load)) return;
  const std::span<const Effect> catalogue = effect_catalogue();
  for (EffectFinding& finding : diagnosis.effects) {
    const bool holds = finding.status == EffectStatus::found || finding.status == EffectStatus::equivalent;
    const auto is_change = [&](const Effect& effect) {
      const EffectInfo info = describe(effect);
      return info.key == finding.key &&
             std::any_of(info.parameters.begin(), info.parameters.end(),
                         [](const Parameter& p) { return p.search == ParameterSearch::moment_of_change; });
    };
    if (holds && std::any_of(catalogue.begin(), catalogue.end(), is_change))
      finding.reason += "; a step of the load that was not recorded does the same";
  }
  if (diagnosis.verdict != Verdict::unexplained) return;
  double scatter = 0;
  for (const Record& record : records) scatter = std::max(scatter, level_scatter(*record.motion, *record.segmentation));
  if (scatter < limits::kLeastSwing) return;
  for (const Effect& effect : catalogue) {
    const EffectInfo info = describe(effect);
    const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                 [&](const EffectFinding& finding) { return finding.key == info.key; });
    if (info.sketch.view != SketchView::load || at == diagnosis.effects.end()) continue;
    at->status = EffectStatus::possible;
    at->reason = fmt::format(
        "friction at break-away and in fast slip rises and falls together, by {} % from cycle to cycle: the load "
        "may vary; record the load",
        fixed(100 * scatter, 1));
    break;
  }
  diagnosis.next_experiment =
      "Record the normal load: friction swings in proportion at all speeds. " + diagnosis.next_experiment;
}

}  // namespace tribofit::diagnosis
