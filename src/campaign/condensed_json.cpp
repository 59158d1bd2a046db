#include "condensed_json.hpp"

#include <cmath>

#include "output/json.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

constexpr int kCondensedDigits = 8;

double scaled_back(const Json& json, double unit) {
  return json.is_number() ? json.get<double>() * unit : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> scaled_back(const Json& list, double unit, std::size_t count) {
  std::vector<double> out;
  out.reserve(list.size());
  for (const Json& value : list) out.push_back(scaled_back(value, unit));
  if (!out.empty() && out.size() != count) list.at(list.size());  // throws: another make
  return out;
}

Json scaled_list(const std::vector<double>& values, double unit) {
  return list_of(values, [&](double value) { return rounded(value / unit, kCondensedDigits); });
}

Json slip_json(const Observations::SlipObservation& slip) {
  return Json::array({slip.end - slip.begin, slip.cycle, slip.direction, slip.from_stick,
                      rounded(slip.break_away_friction, kCondensedDigits),
                      rounded(slip.break_away_root_weight, kCondensedDigits),
                      rounded(slip.slow_variance, kCondensedDigits)});
}

void read_slip(const Json& json, Observations& out) {
  Observations::SlipObservation slip;
  slip.begin = out.slips.empty() ? 0 : out.slips.back().end;
  slip.end = slip.begin + json.at(0).get<std::size_t>();
  slip.cycle = json.at(1).get<std::size_t>();
  slip.direction = json.at(2).get<double>();
  slip.from_stick = json.at(3).get<bool>();
  slip.break_away_friction = scaled_back(json.at(4), 1);
  slip.break_away_root_weight = json.at(5).get<double>();
  slip.slow_variance = json.at(6).get<double>();
  slip.segment = out.slips.size();
  out.cycles = std::max(out.cycles, slip.cycle + 1);
  out.slips.push_back(slip);
}

void set_extent(Observations& out) {
  out.slowest = std::numeric_limits<double>::infinity();
  for (const auto& slip : out.slips) {
    if (slip.from_stick) out.slowest = 0;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out.slowest = std::min(out.slowest, std::abs(out.velocity[i]));
    out.fastest = std::max(out.fastest, std::abs(out.velocity[i]));
    out.largest_friction = std::max(out.largest_friction, std::abs(out.friction[i]));
  }
  out.friction_scale = std::max(1.0, out.largest_friction);  // what kind of friction it is was not kept
}

}  // namespace

std::string condensed_text(const CondensedRun& run) {
  const Observations& o = run.observations;
  const auto flicker = [](const RecordNoise& noise) {
    const FlickerNoise& f = noise.flicker;
    return Json::array({rounded(f.power, kCondensedDigits), rounded(f.samples, kCondensedDigits)});
  };
  const auto fit = [](const CondensedRun::OfFit& f) {
    return object("law", f.law, "effects", f.effects, "lower", list_of(f.lower, number), "upper",
                  list_of(f.upper, number));
  };
  return line_of(object("points", run.is_points, "within", rounded(run.within, kCondensedDigits), "flicker",
                        rounded(o.flicker, kCondensedDigits), "flicker_noise", list_of(o.noise, flicker), "mean_load_N",
                        rounded(o.mean_load, kCondensedDigits), "slips", list_of(o.slips, slip_json), "velocity_mm_s",
                        scaled_list(o.velocity, kMillimetre), "friction", scaled_list(o.friction, 1), "weight",
                        scaled_list(o.weight, 1), "velocity_variance_mm2_s2",
                        scaled_list(o.velocity_variance, kMillimetre * kMillimetre), "fits", list_of(run.fits, fit)));
}

CondensedRun condensed_from(const Json& json) {
  CondensedRun run;
  run.is_points = json.at("points").get<bool>();
  run.within = json.at("within").get<double>();
  Observations& o = run.observations;
  o.flicker = json.at("flicker").get<double>();
  for (const Json& noise : json.at("flicker_noise"))
    o.noise.push_back({{}, 0, {noise.at(0).get<double>(), noise.at(1).get<double>()}});
  o.mean_load = json.at("mean_load_N").get<double>();
  for (const Json& slip : json.at("slips")) read_slip(slip, o);
  const std::size_t count = o.slips.empty() ? 0 : o.slips.back().end;
  o.velocity = scaled_back(json.at("velocity_mm_s"), kMillimetre, count);
  o.friction = scaled_back(json.at("friction"), 1, count);
  o.weight = scaled_back(json.at("weight"), 1, count);
  o.velocity_variance = scaled_back(json.at("velocity_variance_mm2_s2"), kMillimetre * kMillimetre, count);
  for (const double weight : o.weight) o.root_weight.push_back(std::sqrt(weight));
  o.time.assign(count, 0.0);  // laws of speed know none
  set_extent(o);
  for (const Json& fit : json.at("fits")) {
    run.fits.push_back({fit.at("law").get<std::string>(), fit.at("effects").get<std::vector<std::string>>(),
                        scaled_back(fit.at("lower"), 1, fit.at("lower").size()),
                        scaled_back(fit.at("upper"), 1, fit.at("upper").size())});
  }
  return run;
}

}  // namespace tribofit
