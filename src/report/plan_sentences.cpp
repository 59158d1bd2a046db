#include "plan_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/conclusions.hpp"
#include "diagnosis_sentences.hpp"
#include "numbers.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/effects/force_bandwidth.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kPredictionsShown = 4;
constexpr double kClear = 2;  // spreads by which models are apart that a person sees

std::string time_text(double seconds) {
  return seconds < 120 ? fmt::format("{:.0f} s", std::ceil(seconds)) : fmt::format("{:.1f} min", seconds / 60);
}

bool differs(double a, double b) {
  return std::abs(a - b) > 1e-6 * std::abs(b);
}

/// "9 mm at 8 rpm for 12 s".
std::string run_text(const RunConditions& run, const RunConditions& own) {
  std::vector<std::string> parts;
  const std::string speed = brief(run.speed / kRpm) + " rpm";
  if (differs(run.radius, own.radius)) parts.push_back(brief(run.radius / kMillimetre) + " mm");
  if (run.reversing > 0) {
    parts.push_back(fmt::format("forth and back at up to {}, {} s a turn", speed, brief(1 / run.reversing)));
  } else if (differs(run.speed, own.speed)) {
    parts.push_back(parts.empty() ? speed : "at " + speed);
  }
  if (differs(run.load, own.load)) parts.push_back("under " + brief(run.load) + " N");
  if (differs(run.stiffness, own.stiffness))
    parts.push_back(fmt::format("on a spring of {} N/mm", brief(run.stiffness * kMillimetre)));
  if (run.mass_below > 0)
    parts.push_back(fmt::format("with {} g more below the force sensor", brief(1e3 * run.mass_below)));
  if (!run.pauses.empty()) {
    double shortest = 1e300, longest = 0;
    for (const Pause& pause : run.pauses) {
      shortest = std::min(shortest, pause.duration), longest = std::max(longest, pause.duration);
    }
    parts.push_back(fmt::format("with {} pauses of {} to {} s", run.pauses.size(), significant(shortest, 2),
                                significant(longest, 2)));
  }
  if (differs(run.rate, own.rate)) parts.push_back("sampled at " + frequency_text(run.rate));
  if (parts.empty()) parts.emplace_back("the same again");
  return fmt::format("{} for {}", fmt::join(parts, " "), time_text(run.duration));
}

/// A name for the file of a new run, from which `identify manifest` reads its conditions.
std::string file_for(const RunConditions& run, const RunConditions& own) {
  std::string name;
  if (differs(run.radius, own.radius)) name += "r" + brief(run.radius / kMillimetre) + "mm_";
  name += brief(run.speed / kRpm) + "rpm";
  if (differs(run.load, own.load)) name += "_" + brief(run.load) + "N";
  return name + "_new.csv";
}

/// The experiment of the catalogue for the first two models.
std::string catalogue_experiment(const RunPlan& plan) {
  if (plan.models.size() < 2) return {};
  const auto key = [](const ModelInQuestion& model) { return model.name.substr(0, model.name.find(':')); };
  for (std::size_t k = 1; k < plan.models.size(); ++k) {
    const std::string known = discriminating_experiment(key(plan.models[0]), key(plan.models[k]));
    if (!known.empty()) return known;
  }
  return {};
}

}  // namespace

std::string experiment_text(const Experiment& experiment, const RunConditions& own) {
  if (experiment.tap > 0) return "tap the block";
  if (experiment.lift) return "lift the block off the disc and read the force sensor";
  if (experiment.accelerometer) return "an accelerometer beside the vibrometer";
  std::vector<std::string> runs;
  for (const RunConditions& run : experiment.runs) runs.push_back(run_text(run, own));
  return fmt::format("{}", fmt::join(runs, ", then "));
}

std::string model_text(const ModelInQuestion& model) {
  return model.name.empty() ? "nothing more" : model.name;
}

std::string question_sentence(const DiagnosedTraces& diagnosed, const RunPlan& plan) {
  if (plan.kind == QuestionKind::nothing) {
    const std::vector<Rung> found = found_effects(diagnosed.diagnosis);
    std::vector<std::string> names;
    for (const Rung& rung : found) names.push_back(rung.added);
    return found.empty() ? "These records ask for no effect, and none is possible: there is nothing to settle."
                         : fmt::format("{} {} found alone: there is nothing to settle.", capitalised(enumerated(names)),
                                       names.size() == 1 ? "is" : "are");
  }
  std::vector<std::string> answers;
  for (const ModelInQuestion& model : plan.models) {
    answers.push_back(plan.reason.empty() ? fmt::format("{} ({:.0f} %)", model_text(model), 100 * model.probability)
                                          : model_text(model));
  }
  return fmt::format("Open: {}. {}", enumerated(answers, "or"),
                     plan.kind == QuestionKind::possible ? "What it would explain may be chance."
                                                         : "These records do not distinguish them.");
}

std::string plan_verdict(const DiagnosedTraces& diagnosed, const RunPlan& plan) {
  if (!plan.reason.empty()) return "Nothing could be planned: " + plan.reason + ".";
  if (plan.kind == QuestionKind::nothing) {
    const std::string& next = diagnosed.diagnosis.next_experiment;
    return next.empty() ? "A repeat of the run, held back with --confirm, would confirm the law." : next;
  }
  const std::string known = catalogue_experiment(plan), instead = known.empty() ? "" : " What would: " + known + ".";
  if (plan.kind == QuestionKind::plateau && plan.experiments.empty())
    return "No run distinguishes them: they move the plateau alike in every one." + instead;
  if (plan.experiments.empty()) return "None of the stated means changes anything that could be seen." + instead;
  const PlannedExperiment& best = plan.experiments.front();
  const std::string run = experiment_text(best.experiment, plan.own),
                    chance = fmt::format("{:.0f} %", 100 * best.probability);
  if (plan.hopeless) {
    return fmt::format(
        "Nothing within the stated means is likely to settle it: the best, {}, does so with a probability of {}.{}",
        run, chance, instead);
  }
  return fmt::format("Best: {}. It names the effect alone with a probability of {}.", run, chance);
}

ReportTable experiments_table(const RunPlan& plan) {
  ReportTable table("Experiments, the best first");
  table.text({"what to do"}).numbers({"minutes", "names it"});
  for (const ModelInQuestion& model : plan.models) table.columns.push_back({"if " + model_text(model), true, 1, {}});
  table.columns.push_back({"diagnosed", true, 2, {}});
  for (const PlannedExperiment& one : plan.experiments) {
    std::vector<std::string> row = {experiment_text(one.experiment, plan.own), fixed(one.minutes(), 1),
                                    one.reason.empty() ? fmt::format("{:.0f} %", 100 * one.probability) : "-"};
    for (const double p : one.of_models) row.push_back(std::isfinite(p) ? fmt::format("{:.0f} %", 100 * p) : "-");
    row.push_back(one.simulated > 0 ? fmt::format("{} of {}", one.named, one.simulated) : "");
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable predictions_table(const RunPlan& plan, const PlannedExperiment& one, bool force) {
  ReportTable table("What is to be seen: " + experiment_text(one.experiment, plan.own));
  table.text({""});
  for (const ModelInQuestion& model : plan.models) table.numbers({"if " + model_text(model)});
  table.text({"unit"});
  for (const Prediction& prediction : one.predictions) {
    if (table.rows.size() >= kPredictionsShown || (prediction.apart < kClear && !table.rows.empty())) break;
    std::vector<std::string> row = {prediction.name};
    for (const PredictedValue& value : prediction.models) {
      const double spread = 0.25 * (value.upper95 - value.lower95) / prediction.si;
      row.push_back(std::isfinite(value.value) ? with_error(value.value / prediction.si, spread) : "-");
    }
    row.push_back(prediction.unit.empty() && force ? "N" : prediction.unit);
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> plan_notes(const RunPlan& plan) {
  std::vector<std::string> notes = plan.messages;
  if (plan.usual_means && plan.kind != QuestionKind::nothing && plan.reason.empty()) {
    notes.emplace_back(
        "No means were stated: planned with a quarter to four times the disc speed, at the same radius, and with a "
        "longer record. --speeds, --radii, --loads, --springs, --pauses, --reversing, --tap, --lift and --rates say "
        "what can be done.");
  }
  if (!plan.experiments.empty() && plan.experiments.front().experiment.tap > 0) {
    notes.push_back(
        fmt::format("A slower edge of the tap is the filter itself: fit it with --effect {}.", ForceBandwidth::key));
  }
  if (!plan.not_asked.empty()) {
    notes.push_back("Not asked, because these records cannot show them: " + enumerated(plan.not_asked) + ".");
  }
  return notes;
}

Suggestion next_after_plan(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  const std::vector<std::string> inputs =
      options.inputs.empty() ? std::vector<std::string>{diagnosed.traces.front().path} : options.inputs;
  const auto with_lab = [&] {
    return command_line(words_of({"diagnose", "--instruments", "lab.json"}, options.arguments, {}, {"--instruments"}),
                        inputs);
  };
  if (!plan.reason.empty() || plan.kind == QuestionKind::nothing || plan.experiments.empty())
    return {"to see the diagnosis behind it", command_line(words_of({"diagnose"}, options.arguments), inputs)};
  const PlannedExperiment& best = plan.experiments.front();
  if (best.experiment.accelerometer) {
    return {"once the gain that it shows stands in lab.json (vibrometer.gain)", with_lab()};
  }
  if (best.experiment.lift) return {"once its zero stands in lab.json (force_sensor.zero)", with_lab()};
  if (best.experiment.tap > 0) {
    return {
        "once the shift that the tap shows stands in lab.json (vibrometer.delay), and what a sharp edge allows "
        "(force_sensor.bandwidth_at_least)",
        with_lab()};
  }
  std::vector<std::string> files;
  bool same_place = true, repeats = false;
  for (const RunConditions& run : best.experiment.runs) {
    files.push_back(file_for(run, plan.own));
    same_place &= !differs(run.radius, plan.own.radius) && !differs(run.load, plan.own.load);
    repeats |= !differs(run.speed, plan.own.speed) && run.pauses.empty() && !(run.reversing > 0);
  }
  if (same_place) {  // a diagnosis would keep a repeat to confirm what it finds; a plan goes on from it
    const std::string verb = repeats ? "plan" : "diagnose";
    return {"with the new run beside the record",
            command_line(words_of({verb}, options.arguments, {}, {"--speed"}), joined(inputs, files))};
  }
  return {fmt::format("with all records in runs/, the new one as {}", enumerated(files)),
          command_line({"manifest", "runs/", "--out", "runs/manifest.csv"}, {})};
}

}  // namespace tribofit
