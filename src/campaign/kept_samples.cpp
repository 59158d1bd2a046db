#include "kept_samples.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "described_results.hpp"
#include "limits.hpp"
#include "tribofit/output/whole_file.hpp"

namespace tribofit {
namespace {

/// Mean square of what samples are off the values that are their means.
double square_within(const Motion& motion, const Observations& observations) {
  double squares = 0, count = 0;
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.samples.begin; i < slip.samples.end; ++i) {
      if (motion.has_fault(i, SampleFault::any)) continue;
      const std::size_t value = slip.begin + (i - slip.samples.begin) / observations.samples_per_value;
      squares += std::pow(motion.friction[i] - observations.friction[value], 2);
      count += 1;
    }
  }
  return count > 0 ? squares / count : 0;
}

/// Up to kMostCondensedValues values are those of its own fit; beyond that each is a mean over more samples, with the
/// variance of speed within it.
CondensedRun condensed(const Identification& result) {
  CondensedRun out;
  out.is_points = result.motion.is_points();
  const std::size_t slips = std::max<std::size_t>(1, result.segmentation.cycles.size());
  const std::size_t values = std::clamp(kMostCondensedValues / slips, kFewestCondensedOfSlip, kMostCondensedOfSlip);
  out.observations = observe(result.motion, result.segmentation, {}, values);
  out.within = square_within(result.motion, out.observations);
  for (const Fit& fit : result.fits) {
    if (fit.protocol != Protocol::joint || fit.parameters.empty()) continue;
    CondensedRun::OfFit& of_fit = out.fits.emplace_back();
    of_fit.law = to_string(fit.model.law());
    of_fit.effects = fit.model.effect_keys();
    for (const FitParameter& p : fit.parameters) {
      of_fit.lower.push_back(p.parameter.lower * p.parameter.si);
      of_fit.upper.push_back(p.parameter.upper * p.parameter.si);
    }
  }
  return out;
}

/// Whether slips and values fit together: another program may have written the file.
bool is_consistent(const Observations& o) {
  std::size_t end = 0;
  for (const auto& slip : o.slips) {
    if (slip.begin != end || slip.end < slip.begin) return false;
    end = slip.end;
  }
  const std::size_t variances = o.velocity_variance.empty() ? end : o.velocity_variance.size();
  return o.velocity.size() == end && o.friction.size() == end && o.weight.size() == end && variances == end;
}

/// What follows from the values that were kept.
void complete(Observations& o) {
  o.slowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < o.slips.size(); ++k) {
    o.slips[k].segment = k;
    o.cycles = std::max(o.cycles, o.slips[k].cycle + 1);
    if (o.slips[k].from_stick) o.slowest = 0;
  }
  o.time.assign(o.velocity.size(), 0.0);  // laws of speed know none
  for (std::size_t i = 0; i < o.size(); ++i) {
    o.root_weight.push_back(std::sqrt(o.weight[i]));
    o.slowest = std::min(o.slowest, std::abs(o.velocity[i]));
    o.fastest = std::max(o.fastest, std::abs(o.velocity[i]));
    o.largest_friction = std::max(o.largest_friction, std::abs(o.friction[i]));
  }
  o.friction_scale = std::max(1.0, o.largest_friction);  // what kind of friction it is was not kept
}

std::string path_of(const std::string& results, const std::string& name, const char* what) {
  return (std::filesystem::path(results) / kept_folder / (name + "." + what + ".json")).string();
}

template <class Struct>
void keep(const std::string& path, const std::string& settings, const Struct& what) {
  Json json = json_of(what);
  json["settings"] = settings;
  write_whole(path, sealed(line_of(json)));
}

/// Nothing where there is none of these settings and this make.
template <class Struct>
std::optional<Struct> kept(const std::string& results, const PlannedRun& run, const char* what) {
  try {
    const auto json = read_sealed(path_of(results, run.name, what));
    if (json && json->value("settings", std::string()) == run.settings) return read_from<Struct>(*json);
  } catch (const Json::exception&) {  // whole, but of another make
  }
  return std::nullopt;
}

}  // namespace

void keep_samples(const std::string& results, const RunRecord& run, const Identification* result) {
  const std::string figures = path_of(results, run.name, "figures"), values = path_of(results, run.name, "condensed");
  std::error_code ignored;  // a file that cannot be written says so
  if (result == nullptr || !result->analysed) {
    std::filesystem::remove(figures, ignored);  // of an earlier analysis
    std::filesystem::remove(values, ignored);
    return;
  }
  std::filesystem::create_directory(std::filesystem::path(results) / kept_folder, ignored);
  keep(figures, run.settings, figures_of(*result));
  keep(values, run.settings, condensed(*result));
}

std::optional<RunFigures> ResultReader::figures(std::size_t k) const {
  return kept<RunFigures>(folder_, plan_.runs.at(k), "figures");
}

std::optional<CondensedRun> ResultReader::condensed(std::size_t k) const {
  auto out = kept<CondensedRun>(folder_, plan_.runs.at(k), "condensed");
  if (!out || !is_consistent(out->observations)) return std::nullopt;
  complete(out->observations);
  return out;
}

}  // namespace tribofit
