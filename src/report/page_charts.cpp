#include "page_charts.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "drawing.hpp"
#include "law_points.hpp"
#include "measures.hpp"
#include "numbers.hpp"
#include "page_series.hpp"

namespace tribofit {
namespace {

constexpr double kZoom = 5e-3;  // s, to either side of a break-away or re-stick
/// Stretches into which series are cut for drawing.
constexpr std::size_t kRecordBins = 1200, kCycleBins = 1200, kZoomBins = 300, kMeasureBins = 200, kLineBins = 800;
constexpr std::size_t kShownCycles = 3;

/// What the velocity charts show: v_b where the block moves against a disc of known speed, else v_r.
class VelocityChannel {
 public:
  explicit VelocityChannel(const Motion& motion) : motion_(motion) {
    of_block_ = motion.velocity_kind != VelocityKind::fixed_block &&
                (!motion.disc_velocity.empty() || motion.constant_disc_velocity != 0);
  }
  bool of_block() const { return of_block_; }
  double operator[](std::size_t i) const {
    const double v_r = motion_.relative_velocity[i];
    return (of_block_ ? motion_.disc_velocity_at(i) - v_r : v_r) / kMillimetre;
  }

 private:
  const Motion& motion_;
  bool of_block_ = false;
};

/// A trace with what its models say of every sample.
struct Drawn {
  const Identification& trace;
  const Motion& motion;
  VelocityChannel velocity;
  const std::vector<DrawnModel>& models;
  std::vector<std::vector<double>> predictions;  ///< of each model, NaN outside slips
  double share = 1;

  std::size_t bins(std::size_t whole) const {
    constexpr std::size_t kFewest = 50;
    return std::max(kFewest, static_cast<std::size_t>(share * static_cast<double>(whole)));
  }
  /// Index of the first sample at or after a time.
  std::size_t index_at(double time) const {
    return static_cast<std::size_t>(std::lower_bound(motion.time.begin(), motion.time.end(), time) -
                                    motion.time.begin());
  }
};

/// Friction, velocity, disc and models over samples [begin, end).
Json window_json(const Drawn& d, std::size_t begin, std::size_t end, std::size_t bins) {
  const auto at_times = [&](const auto& channel) {
    std::vector<double> values(end - begin);
    for (std::size_t i = begin; i < end; ++i) values[i - begin] = channel[i];
    Series series;
    for (const std::size_t k : drawn_samples(values, bins)) series.add(d.motion.time[begin + k], values[k]);
    return series.json(kTimeDigits);
  };
  Json json = {{"friction", at_times(d.motion.friction)}, {"velocity", at_times(d.velocity)}};
  json["models"] = Json::array();
  for (const std::vector<double>& prediction : d.predictions) json["models"].push_back(at_times(prediction));
  if (!d.velocity.of_block()) return json;
  if (d.motion.disc_velocity.empty()) {
    const double level = d.motion.constant_disc_velocity / kMillimetre;
    Series disc;
    disc.add(d.motion.time[begin], level);
    disc.add(d.motion.time[end - 1], level);
    json["disc"] = disc.json(kTimeDigits);
  } else {
    std::vector<double> level = d.motion.disc_velocity;
    for (double& v : level) v /= kMillimetre;
    json["disc"] = at_times(level);
  }
  return json;
}

/// The first of three cycles in a row that are all there, as near to the middle of the record as they come; else the
/// first of any three in a row.
std::size_t first_shown(const std::vector<Cycle>& cycles) {
  const std::size_t last = cycles.size() - kShownCycles;
  const auto complete = [&](std::size_t k) {
    return std::all_of(cycles.begin() + static_cast<std::ptrdiff_t>(k),
                       cycles.begin() + static_cast<std::ptrdiff_t>(k + kShownCycles),
                       [](const Cycle& c) { return c.stick_complete && c.slip_complete; });
  };
  const std::size_t middle = last / 2;
  for (std::size_t off = 0; off <= last; ++off) {
    if (middle + off <= last && complete(middle + off)) return middle + off;
    if (off <= middle && complete(middle - off)) return middle - off;
  }
  return middle;
}

Json zoom_json(const Drawn& d, double at) {
  const std::size_t begin = d.index_at(at - kZoom), end = d.index_at(at + kZoom);
  if (end < begin + 2) return nullptr;
  Json json = window_json(d, begin, end, d.bins(kZoomBins));
  json["at"] = rounded(at, kTimeDigits);
  return json;
}

/// Three cycles with stick and slip, and what happens within 5 ms of a break-away and a re-stick.
void add_cycles(const Drawn& d, Json& json) {
  const std::vector<Cycle>& cycles = d.trace.segmentation.cycles;
  if (d.trace.segmentation.kind != MotionKind::stick_slip || cycles.size() < kShownCycles) return;
  const std::size_t first = first_shown(cycles);
  const Cycle& head = cycles[first];
  const Cycle& tail = cycles[first + kShownCycles - 1];
  const std::size_t begin = head.stick.size() > 0 ? head.stick.begin : head.slip.begin;
  const std::size_t margin = (tail.slip.end - begin) / 20;  // a little of the next stick
  const std::size_t end = std::min(d.motion.size(), tail.slip.end + margin);
  if (end < begin + 2) return;
  Json window = window_json(d, begin, end, d.bins(kCycleBins));
  window["phases"] = Json::array();
  for (std::size_t k = first; k < first + kShownCycles; ++k) {
    const auto add = [&](const char* phase, double from, double to) {
      window["phases"].push_back(
          {{"phase", phase}, {"from", rounded(from, kTimeDigits)}, {"to", rounded(to, kTimeDigits)}});
    };
    const Cycle& c = cycles[k];
    if (c.stick.size() > 0) add("stick", d.motion.time[c.stick.begin], c.break_away_time);
    const double end_time = std::isfinite(c.restick_time) && c.slip_complete
                                ? c.restick_time
                                : d.motion.time[std::min(c.slip.end, d.motion.size() - 1)];
    if (c.slip.size() > 0) add("slip", c.break_away_time, end_time);
  }
  window["first"] = first;
  json["cycles"] = std::move(window);
  const Cycle& shown = cycles[first + kShownCycles / 2];
  if (shown.stick.size() > 0) json["break_away"] = zoom_json(d, shown.break_away_time);
  if (shown.slip_complete) json["restick"] = zoom_json(d, shown.restick_time);
}

Json measures_json(const Drawn& d) {
  const std::vector<Cycle>& cycles = d.trace.segmentation.cycles;
  const std::size_t bins = d.bins(kMeasureBins);
  const auto measure = [&](double Cycle::*which, double unit) {
    std::vector<double> values;
    for (const Cycle& c : cycles) values.push_back(c.*which / unit);
    Series series;
    for (const std::size_t k : drawn_samples(values, bins)) series.add(cycles[k].break_away_time, values[k]);
    return series.json(kTimeDigits);
  };
  return {{"break_away_friction", measure(&Cycle::break_away_friction, 1)},
          {"static_friction", measure(&Cycle::stick_maximum, 1)},
          {"kinetic_friction", measure(&Cycle::slip_minimum, 1)},
          {"peak_velocity", measure(&Cycle::peak_velocity, kMillimetre)},
          {"stick_time", measure(&Cycle::stick_time, kMillisecond)},
          {"slip_time", measure(&Cycle::slip_time, kMillisecond)},
          {"period", measure(&Cycle::period, kMillisecond)}};
}

/// Amplitudes of v_r up to twelve times the stick-slip frequency, or the whole band where nothing repeats.
Json spectrum_json(const Drawn& d) {
  constexpr double kHarmonics = 12, kSamplesPerHarmonic = 4;
  const std::vector<double>& v_r = d.motion.relative_velocity;
  if (v_r.size() < 16) return nullptr;
  const double peak = d.trace.spectral_peak.frequency;
  // Means over neighbours do for what is far below the rate, and cost less.
  const double top = peak > 0 ? std::min(kHarmonics * peak, 0.5 / d.motion.step) : 0.5 / d.motion.step;
  const auto every = static_cast<std::size_t>(std::max(1.0, 1 / (kSamplesPerHarmonic * top * d.motion.step)));
  std::vector<double> reduced(v_r.size() / every);
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < every; ++k) sum += v_r[i * every + k];
    reduced[i] = sum / static_cast<double>(every) / kMillimetre;
  }
  if (reduced.size() < 8) return nullptr;
  const Spectrum spectrum = amplitude_spectrum(reduced, d.motion.step * static_cast<double>(every));
  std::vector<double> amplitude = spectrum.amplitude;
  amplitude.resize(std::min(amplitude.size(), static_cast<std::size_t>(top / spectrum.bin_width) + 1));
  Series series;
  for (const std::size_t k : drawn_samples(amplitude, d.bins(kLineBins))) {
    series.add(static_cast<double>(k) * spectrum.bin_width, amplitude[k]);
  }
  return series.json();
}

}  // namespace

Json trace_charts(const Identification& trace, const std::vector<DrawnModel>& models, double share) {
  Drawn d = {trace, trace.motion, VelocityChannel(trace.motion), models, {}, share};
  for (const DrawnModel& model : models) d.predictions.push_back(predict(*model.fit, d.motion, trace.segmentation));
  Json json = {{"path", trace.path},
               {"friction_unit", friction_unit(d.motion)},
               {"velocity", d.velocity.of_block() ? "v_b" : "v_r"},
               {"models", Json::array()}};
  for (const DrawnModel& model : models) json["models"].push_back(model.name);
  if (d.motion.size() < 2) return json;
  json["record"] = window_json(d, 0, d.motion.size(), d.bins(kRecordBins));
  json["record"].erase("models");  // a line through every slip hides what it is laid over
  add_cycles(d, json);
  add_law_points(trace, d.predictions, models, json);
  json["measures"] = measures_json(d);
  json["spectrum"] = spectrum_json(d);
  return json;
}

Json curve_charts(const std::vector<DrawnModel>& models) {
  constexpr std::size_t kPoints = 161;
  Json list = Json::array();
  for (const DrawnModel& model : models) {
    const Curve curve = curve_of(*model.fit, kPoints);
    std::vector<double> velocity = curve.velocity;
    for (double& v : velocity) v /= kMillimetre;
    list.push_back({{"name", model.name},
                    {"slowest", rounded(model.fit->slowest / kMillimetre)},
                    {"fastest", rounded(model.fit->fastest / kMillimetre)},
                    {"v", numbers_json(velocity)},
                    {"mu", numbers_json(curve.mu)},
                    {"low", numbers_json(curve.lower95)},
                    {"high", numbers_json(curve.upper95)}});
  }
  return list;
}

}  // namespace tribofit
