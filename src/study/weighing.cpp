#include "weighing.hpp"

#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/limits.hpp"
#include "diagnosis/ruling.hpp"
#include "limits.hpp"
#include "run_measures.hpp"
#include "tap.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit {

namespace {

double normal_tail_below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Chance that the p-value of another record of the same truth is below `level`, from those of some draws. cycles: so
/// many times as many as the draws had.
double chance_of_p(const std::vector<Evidence>& draws, double level, double cycles) {
  const boost::math::normal_distribution<double> normal;
  const auto z_of = [&](double p) { return boost::math::quantile(normal, 1 - std::clamp(p, 1e-15, 1 - 1e-15)); };
  double sum = 0;
  for (const Evidence& draw : draws) sum += z_of(draw.p_value);
  const auto n = static_cast<double>(draws.size());
  return normal_tail_below((std::sqrt(cycles) * sum / n - z_of(level)) / std::sqrt(1 + 1 / n));
}

/// Chance that another record of the same truth distinguishes it from a rival that was `now` behind before the run.
///
/// What the run adds to the difference has, with the right one known, a variance of four times its mean; what the
/// records gave before is what it is. Draws of other parameters spread more, which shows in the draws: the theory
/// counts as kDrawsOfTheory of them. The mean is that of the draws, with its error.
double chance_to_distinguish(const std::vector<Evidence>& draws, std::size_t rival, double now,
                             const Lengthening& lengthening) {
  const double longer = lengthening.of_runs;
  double sum = 0, squares = 0, n = 0, size = 0;
  for (const Evidence& draw : draws) {
    if (!std::isfinite(draw.ahead[rival])) continue;
    sum += draw.ahead[rival] - now, n += 1;
    size += draw.least_by_size * lengthening.of_cycles;
  }
  const auto all = static_cast<double>(draws.size());
  if (n == 0) return 1;
  const double added = sum / n, of_theory = 4 * std::max(added, 1.0);
  for (const Evidence& draw : draws) {
    if (std::isfinite(draw.ahead[rival])) squares += std::pow(draw.ahead[rival] - now - added, 2);
  }
  const double variance = longer * (kDrawsOfTheory * of_theory + squares) / (kDrawsOfTheory + n - 1);
  const double mean = now + longer * added;
  const double least = std::max(diagnosis::limits::kDistinguishable, size / n);
  const double beyond = (mean - least) / std::sqrt(variance * (1 + longer / n));
  return (all - n + n * normal_tail_below(beyond)) / all;
}

/// A machine of the model, drawn from its posterior.
Machine drawn_machine(const OpenQuestion& question, std::size_t model, std::uint64_t seed) {
  const IdentifiedMachine& known = question.machines[model];
  std::vector<Machine> drawn = draws_of(known.machine, known.covariance, 1, seed);
  return drawn.empty() ? known.machine : std::move(drawn.front());
}

std::uint64_t seed_of(const PlanOptions& options, std::size_t truth, std::uint64_t draw) {
  return options.seed * 1000003 + draw * 101 + truth;
}

/// The runs of an experiment with one drawn machine; empty where they cannot be simulated.
std::vector<SimulatedRun> runs_of(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                  std::uint64_t seed) {
  std::vector<SimulatedRun> out;
  try {
    const Machine machine = drawn_machine(question, truth, seed);
    for (std::size_t k = 0; k < experiment.runs.size(); ++k) {
      out.push_back(simulate_run(machine, experiment.runs[k], question.record, seed + 7919 * (k + 1)));
    }
  } catch (const InputError&) {  // numbers that cannot be simulated
    out.clear();
  }
  return out;
}

/// The records as they are, then the simulated ones.
std::vector<Record> with_runs(const DiagnosedTraces& diagnosed, const std::vector<SimulatedRun>& runs) {
  std::vector<Record> records = records_of(diagnosed);
  for (const SimulatedRun& run : runs) {
    if (run.segmentation.kind != MotionKind::always_sticking) records.push_back({&run.motion, &run.segmentation});
  }
  return records;
}

}  // namespace

double chance_beyond(double sigmas) {
  return normal_tail_below(sigmas - diagnosis::limits::kDeclaredSigmas);
}

Evidence weigh_draw(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment,
                    std::size_t truth, std::uint64_t draw, const PlanOptions& options) {
  Evidence out;
  if (experiment.tap > 0) {
    out.known = chance_of_tap(question, truth, experiment.tap);
    return out;
  }
  const std::vector<SimulatedRun> runs = runs_of(question, experiment, truth, seed_of(options, truth, draw));
  out.simulated = !runs.empty();
  if (!out.simulated) return out;
  const diagnosis::Ruling ruling = diagnosis::rule_between(with_runs(diagnosed, runs), question.law, question.beside,
                                                           question.asked, options.instruments);
  const diagnosis::Ruling::OfEffect& own = ruling.effects[std::min(truth, ruling.effects.size() - 1)];
  out.p_value = own.p_value;
  out.least_by_size = ruling.least_by_size;
  out.ruled_out = !own.passes && own.p_value < diagnosis::Limits{}.p_value;
  for (std::size_t k = 0; k < ruling.effects.size(); ++k) {
    const bool rivals = k != truth && ruling.effects[k].passes;
    out.ahead.push_back(rivals ? ruling.effects[k].behind - own.behind : std::numeric_limits<double>::infinity());
  }
  return out;
}

double chance_to_name(const OpenQuestion& question, std::size_t truth, const std::vector<Evidence>& draws,
                      const Lengthening& lengthening) {
  using namespace diagnosis;
  std::vector<Evidence> seen;
  for (const Evidence& draw : draws) {
    if (draw.known >= 0) return draw.known;
    if (draw.simulated) seen.push_back(draw);
  }
  if (seen.empty()) return 0;
  const double simulated = static_cast<double>(seen.size()) / static_cast<double>(draws.size());
  if (question.without(truth)) return simulated * (1 - chance_of_p(seen, limits::kChanceOfPossible, 1));
  const auto ruled_out = std::count_if(seen.begin(), seen.end(), [](const Evidence& draw) { return draw.ruled_out; });
  double chance = (1 - static_cast<double>(ruled_out) / static_cast<double>(seen.size())) *
                  chance_of_p(seen, Limits{}.p_value, lengthening.of_cycles);
  if (question.kind == QuestionKind::group) {
    for (std::size_t rival = 0; rival < question.models.size(); ++rival) {
      const double now = question.behind[rival] - question.behind[truth];
      if (rival != truth) chance = std::min(chance, chance_to_distinguish(seen, rival, now, lengthening));
    }
  }
  return simulated * chance;
}

Answer diagnose_simulated(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment,
                          std::size_t truth, std::uint64_t draw, const PlanOptions& options) {
  const std::vector<SimulatedRun> runs = runs_of(question, experiment, truth, seed_of(options, truth, draw));
  if (runs.empty()) return Answer::open;
  DiagnosisOptions inner;
  inner.threads = 1;
  const std::vector<Law> laws = options.laws.empty() ? std::vector<Law>{question.law} : options.laws;
  const Diagnosis d = diagnose(with_runs(diagnosed, runs), laws, {}, options.instruments, options.fit, inner).diagnosis;
  const std::string key = describe(question.asked[std::min(truth, question.asked.size() - 1)]).key;
  const auto among = [&](const Rung& rung, const std::string& k) {
    return rung.added == k || std::find(rung.equivalent.begin(), rung.equivalent.end(), k) != rung.equivalent.end();
  };
  const auto held = std::find_if(d.ladder.begin(), d.ladder.end(), [&](const Rung& rung) { return among(rung, key); });
  if (question.without(truth)) {
    if (held != d.ladder.end()) return Answer::wrong;
    const auto finding =
        std::find_if(d.effects.begin(), d.effects.end(), [&](const EffectFinding& f) { return f.key == key; });
    return finding != d.effects.end() && finding->status == EffectStatus::possible ? Answer::open : Answer::named;
  }
  if (held != d.ladder.end()) return held->added == key && held->equivalent.empty() ? Answer::named : Answer::open;
  for (const Effect& other : question.asked) {
    const std::string rival = describe(other).key;
    for (const Rung& rung : d.ladder) {
      if (rival != key && among(rung, rival)) return Answer::wrong;
    }
  }
  return Answer::open;
}

namespace {

/// Every draw of every model: [model][draw]; empty where they could not be simulated.
std::vector<std::vector<std::vector<SimulatedRun>>> draws_to_see(const OpenQuestion& question,
                                                                 const Experiment& experiment,
                                                                 const PlanOptions& options) {
  std::vector<std::vector<std::vector<SimulatedRun>>> out(question.models.size());
  for (auto& draws : out) draws.resize(kDrawsToSee);
  run_tasks(question.models.size() * kDrawsToSee, options.threads, [&](std::size_t t) {
    const std::size_t model = t / kDrawsToSee, draw = t % kDrawsToSee;
    out[model][draw] = runs_of(question, experiment, model, seed_of(options, model, 1000 + draw));
  });
  return out;
}

struct MeanAndSpread {
  double mean = std::numeric_limits<double>::quiet_NaN(), spread = 0;
};
/// Of those that are known, where most are.
MeanAndSpread spread_of(const std::vector<double>& values) {
  double sum = 0, squares = 0, n = 0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v, n += 1;
  }
  if (n < 2 || 2 * n < static_cast<double>(values.size())) return {};
  for (const double v : values) {
    if (std::isfinite(v)) squares += std::pow(v - sum / n, 2);
  }
  return {sum / n, std::sqrt(squares / (n - 1))};
}

/// By how many of their spreads two models are apart that are furthest.
double apart(const std::vector<MeanAndSpread>& models) {
  double most = 0;
  for (const MeanAndSpread& a : models) {
    for (const MeanAndSpread& b : models) {
      const double spread = std::hypot(a.spread, b.spread);
      if (std::isfinite(a.mean) && std::isfinite(b.mean) && spread > 0)
        most = std::max(most, std::abs(a.mean - b.mean) / spread);
    }
  }
  return most;
}

RunView view_of(const OpenQuestion& question) {
  for (const Effect& effect : question.asked) {
    const SketchView view = describe(effect).sketch.view;
    if (view == SketchView::stick_time) return RunView::stick_time;
    if (view == SketchView::time || view == SketchView::distance || view == SketchView::angle) return RunView::time;
  }
  return RunView::loop;
}

/// y at `x` of points in order of x, by straight lines; NaN outside.
double interpolate(const RunCurve& points, double x) {
  const auto at = std::lower_bound(points.x.begin(), points.x.end(), x);
  if (at == points.x.end() || (at == points.x.begin() && *at > x)) return std::numeric_limits<double>::quiet_NaN();
  if (at == points.x.begin()) return points.y.front();
  const auto k = static_cast<std::size_t>(at - points.x.begin());
  return points.y[k - 1] + (points.y[k] - points.y[k - 1]) * (x - points.x[k - 1]) / (points.x[k] - points.x[k - 1]);
}

/// Means of the points between equal steps of x (of its logarithm).
RunCurve binned(const RunCurve& points, double low, double high, bool logarithmic, std::size_t bins) {
  RunCurve out;
  std::vector<double> sum(bins, 0), at(bins, 0), n(bins, 0);
  for (std::size_t k = 0; k < points.x.size(); ++k) {
    const double u =
        logarithmic ? std::log(points.x[k] / low) / std::log(high / low) : (points.x[k] - low) / (high - low);
    const auto bin =
        static_cast<std::size_t>(std::clamp(u * static_cast<double>(bins), 0.0, static_cast<double>(bins - 1)));
    sum[bin] += points.y[k], at[bin] += points.x[k], n[bin] += 1;
  }
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (n[bin] > 0) out.x.push_back(at[bin] / n[bin]), out.y.push_back(sum[bin] / n[bin]);
  }
  return out;
}

/// One curve with a band from the curves of the draws.
PredictedCurves::OfModel band_of(const std::vector<RunCurve>& draws, RunView view) {
  PredictedCurves::OfModel out;
  if (draws.empty()) return out;
  const auto add = [&](double x, const std::vector<double>& values) {
    const MeanAndSpread s = spread_of(values);
    if (!std::isfinite(s.mean)) return;
    out.x.push_back(x);
    out.y.push_back(s.mean);
    out.lower95.push_back(s.mean - 1.96 * s.spread);
    out.upper95.push_back(s.mean + 1.96 * s.spread);
  };
  if (view == RunView::loop) {  // the same phases of the slip
    for (std::size_t k = 0; k < draws.front().x.size(); ++k) {
      std::vector<double> x, y;
      for (const RunCurve& draw : draws) x.push_back(draw.x[k]), y.push_back(draw.y[k]);
      add(spread_of(x).mean, y);
    }
    return out;
  }
  double low = 1e300, high = -1e300;
  for (const RunCurve& draw : draws) {
    for (const double x : draw.x) low = std::min(low, x), high = std::max(high, x);
  }
  if (!(high > low)) return out;
  const bool logarithmic = view == RunView::stick_time && low > 0;
  constexpr std::size_t kBins = 24;
  std::vector<RunCurve> means;
  for (const RunCurve& draw : draws) means.push_back(binned(draw, low, high, logarithmic, kBins));
  for (std::size_t k = 0; k < means.front().x.size(); ++k) {
    std::vector<double> y;
    for (const RunCurve& mean : means) y.push_back(interpolate(mean, means.front().x[k]));
    add(means.front().x[k], y);
  }
  return out;
}

}  // namespace

std::vector<Prediction> predict_seen(const OpenQuestion& question, const Experiment& experiment,
                                     const PlanOptions& options) {
  std::vector<Prediction> out;
  if (experiment.tap > 0) return predict_tap(question, experiment.tap);
  if (experiment.runs.empty()) return out;
  const auto draws = draws_to_see(question, experiment, options);
  const std::vector<RunMeasure>& measures = run_measures();
  const std::size_t last = experiment.runs.size() - 1;
  std::vector<std::vector<std::vector<double>>> values(draws.size());  // [model][draw][measure]
  for (std::size_t m = 0; m < draws.size(); ++m) {
    for (const auto& runs : draws[m]) {
      values[m].push_back(runs.empty() ? std::vector<double>(measures.size(), std::nan("")) : measure_run(runs[last]));
    }
  }
  for (std::size_t k = 0; k < measures.size(); ++k) {
    std::vector<MeanAndSpread> spreads;
    Prediction one{measures[k].name, measures[k].unit, measures[k].si, 0, {}};
    for (const auto& model : values) {
      std::vector<double> own;
      for (const auto& draw : model) own.push_back(draw[k]);
      spreads.push_back(spread_of(own));
      const MeanAndSpread& s = spreads.back();
      one.models.push_back({s.mean, s.mean - 1.96 * s.spread, s.mean + 1.96 * s.spread});
    }
    one.apart = apart(spreads);
    if (one.apart > 0) out.push_back(std::move(one));
  }
  std::stable_sort(out.begin(), out.end(), [](const Prediction& a, const Prediction& b) { return a.apart > b.apart; });
  return out;
}

namespace {

/// Friction of the mean slip less that of the first model, over the parts of the slip: drawn as they are, the loops lie
/// on one another. Bands are those of the records of a model about its own mean.
PredictedCurves less_first(const PredictedCurves& loops, const std::string& first) {
  PredictedCurves out{"part of the slip", "1", 1, "friction less that of " + first, {}};
  const PredictedCurves::OfModel& own = loops.models.front();
  for (const PredictedCurves::OfModel& model : loops.models) {
    PredictedCurves::OfModel& less = out.models.emplace_back();
    for (std::size_t k = 0; model.y.size() == own.y.size() && k < own.y.size(); ++k) {
      less.x.push_back(static_cast<double>(k) / static_cast<double>(own.y.size() - 1));
      less.y.push_back(model.y[k] - own.y[k]);
      less.lower95.push_back(model.lower95[k] - own.y[k]);
      less.upper95.push_back(model.upper95[k] - own.y[k]);
    }
  }
  return out;
}

}  // namespace

std::vector<PredictedCurves> predict_curves(const OpenQuestion& question, const Experiment& experiment,
                                            const PlanOptions& options) {
  if (experiment.runs.empty()) return {};
  const auto draws = draws_to_see(question, experiment, options);
  std::vector<PredictedCurves> out;
  std::vector<RunView> views = {RunView::loop};
  if (view_of(question) != RunView::loop) views.insert(views.begin(), view_of(question));
  for (const RunView view : views) {
    PredictedCurves curves;
    curves.name = view == RunView::loop ? "sliding speed v_{r}" : view == RunView::time ? "time" : "stick time";
    curves.unit = view == RunView::loop ? "mm/s" : "s";
    curves.si = view == RunView::loop ? 1e-3 : 1;
    curves.quantity = view == RunView::loop   ? "friction of the mean slip"
                      : view == RunView::time ? "mean friction of a slip"
                                              : "friction at break-away";
    for (const auto& model : draws) {
      std::vector<RunCurve> own;
      for (const auto& runs : model) {
        if (runs.empty()) continue;
        RunCurve curve = curve_of_run(runs.back(), view);
        if (!curve.x.empty()) own.push_back(std::move(curve));
      }
      curves.models.push_back(band_of(own, view));
    }
    out.push_back(std::move(curves));
  }
  if (out.back().models.front().y.size() > 1) {
    const std::string& first = question.models.front().name;
    out.push_back(less_first(out.back(), first.empty() ? "no effect more" : first));
  }
  return out;
}

}  // namespace tribofit
