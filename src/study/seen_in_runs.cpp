#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limits.hpp"
#include "open_question.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// The runs of every draw of every model: [model][draw]; empty where they could not be simulated.
using SimulatedDraws = std::vector<std::vector<std::vector<SimulatedRun>>>;

SimulatedDraws draws_to_see(const OpenQuestion& question, const Experiment& experiment) {
  SimulatedDraws out(question.models.size(), std::vector<std::vector<SimulatedRun>>(kDrawsToSee));
  run_tasks(question.models.size() * kDrawsToSee, question.options.threads, [&](std::size_t t) {
    const std::size_t model = t / kDrawsToSee, draw = t % kDrawsToSee;
    out[model][draw] = runs_of(question, experiment, model, 1000 + draw);
  });
  return out;
}

struct MeanAndSpread {
  double mean = std::numeric_limits<double>::quiet_NaN(), spread = 0;
  PredictedValue range95() const {
    return {mean, mean - kNormalQuantile95 * spread, mean + kNormalQuantile95 * spread};
  }
};
/// Of those that are known, where most are.
MeanAndSpread spread_of(std::vector<double> values) {
  const std::size_t all = values.size();
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.size() < 2 || 2 * values.size() < all) return {};
  return {mean_of(values), standard_deviation(values)};
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

PredictedCurves named_as(RunView view) {
  if (view == RunView::loop) return {"sliding speed v_{r}", "mm/s", 1e-3, "friction of the mean slip", {}};
  if (view == RunView::time) return {"time", "s", 1, "mean friction of a slip", {}};
  return {"stick time", "s", 1, "friction at break-away", {}};
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
    const PredictedValue range = s.range95();
    out.x.push_back(x), out.y.push_back(range.value);
    out.lower95.push_back(range.lower95), out.upper95.push_back(range.upper95);
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

std::vector<Prediction> predict_measures(const SimulatedDraws& draws) {
  std::vector<Prediction> out;
  for (const MotionMeasureInfo& info : run_measures()) out.push_back({info.name, info.unit, info.si});
  std::vector<std::vector<MeanAndSpread>> spreads(out.size());
  for (const auto& model : draws) {
    std::vector<std::vector<double>> values(out.size());
    for (const auto& runs : model) {
      const auto seen = runs.empty() ? std::vector<double>(out.size(), std::nan("")) : measure_run(runs.back());
      for (std::size_t k = 0; k < out.size(); ++k) values[k].push_back(seen[k]);
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      spreads[k].push_back(spread_of(values[k]));
      out[k].models.push_back(spreads[k].back().range95());
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k) out[k].apart = apart(spreads[k]);
  std::erase_if(out, [](const Prediction& one) { return !(one.apart > 0); });
  std::stable_sort(out.begin(), out.end(), [](const Prediction& a, const Prediction& b) { return a.apart > b.apart; });
  return out;
}

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

std::vector<PredictedCurves> predict_curves(const OpenQuestion& question, const SimulatedDraws& draws) {
  std::vector<PredictedCurves> out;
  std::vector<RunView> views = {RunView::loop};
  if (view_of(question) != RunView::loop) views.insert(views.begin(), view_of(question));
  for (const RunView view : views) {
    PredictedCurves& curves = out.emplace_back(named_as(view));
    for (const auto& model : draws) {
      std::vector<RunCurve> own;
      for (const auto& runs : model) {
        if (!runs.empty()) own.push_back(curve_of_run(runs.back(), view));
      }
      std::erase_if(own, [](const RunCurve& curve) { return curve.x.empty(); });
      curves.models.push_back(band_of(own, view));
    }
  }
  if (out.back().models.front().y.size() > 1) {
    const std::string& first = question.models.front().name;
    out.push_back(less_first(out.back(), first.empty() ? "no effect more" : first));
  }
  return out;
}

}  // namespace

void predict_seen(const OpenQuestion& question, PlannedExperiment& one, std::vector<PredictedCurves>* curves) {
  if (one.experiment.is_by_hand()) {
    one.predictions = predict_by_hand(question, one.experiment);
    return;
  }
  const SimulatedDraws draws = draws_to_see(question, one.experiment);
  one.predictions = predict_measures(draws);
  if (curves != nullptr) *curves = predict_curves(question, draws);
}

}  // namespace tribofit
