#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "content_hash.hpp"
#include "limits.hpp"
#include "recording.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

/// Linear interpolation of evenly or unevenly spaced samples at `base - offset`, which must lie within `time`.
std::vector<double> interpolate(const std::vector<double>& base, double offset, const std::vector<double>& time,
                                const std::vector<double>& values) {
  std::vector<double> result(base.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const double t = base[i] - offset;
    while (k + 2 < time.size() && time[k + 1] <= t) ++k;
    const double part = std::clamp((t - time[k]) / (time[k + 1] - time[k]), 0.0, 1.0);
    result[i] = values[k] + part * (values[k + 1] - values[k]);
  }
  return result;
}

/// Keeps rows [begin, end) and starts their time at 0.
void crop(FileRecord& run, std::size_t begin, std::size_t end) {
  run.keep_rows(begin, end);
  auto& time = run[Channel::time];
  const double start = time.front();
  for (double& t : time) t -= start;
}

double find_offset(FileRecord& run, const FileRecord& other, const ClockOffsetFinder& find) {
  const double as_written = other.clock_start - run.clock_start;
  const bool overlap = std::abs(as_written) < run[Channel::time].back();
  ClockOffset found;
  if (find && run.has_friction() && other.has_velocity()) {
    found = find(run[Channel::time], run.friction, other[Channel::time], other.velocity);
  } else if (find && run.has_velocity() && other.has_friction()) {
    found = find(other[Channel::time], other.friction, run[Channel::time], run.velocity);
    found.offset = -found.offset, found.drift = -found.drift;
  }
  if (!run.has_friction() && !other.has_friction()) {
    run.notes.push_back(overlap ? "the times of the two files were taken as written"
                                : "the two files were taken to start together");
    return overlap ? as_written : 0;
  }
  if (found.events < kFewestBreakAways) {
    run.warnings.push_back(std::string(find ? "the two files show too few break-aways to compare their clocks; "
                                            : "the clocks of the two files were not compared; ") +
                           (overlap ? "the times were taken as written" : "both were taken to start together"));
    run.clock_offset_std_error = std::numeric_limits<double>::quiet_NaN();
    return overlap ? as_written : 0;
  }
  run.notes.push_back(
      fmt::format("clock offset from {} break-aways: {} s (+-{} s) added to the times of {}, right in the middle "
                  "of the common time as one clock drifts by {} ppm (+-{}) against the other; it holds any lag "
                  "of friction behind velocity too",
                  found.events, with_sign(found.offset - as_written, 6), general(found.uncertainty, 2), other.path,
                  with_sign(1e6 * found.drift, 1), fixed(1e6 * found.drift_uncertainty, 1)));
  run.clock_offset_std_error = found.uncertainty;
  return found.offset;
}

/// Cuts `run` to the time that both share and interpolates the channels of `other` on it.
void add_channels(FileRecord& run, const FileRecord& other, double offset) {
  const auto& base = run[Channel::time];
  const auto& time = other[Channel::time];
  const auto begin = std::lower_bound(base.begin(), base.end(), time.front() + offset) - base.begin();
  const auto end = std::upper_bound(base.begin(), base.end(), time.back() + offset) - base.begin();
  const bool one_file = run.path == other.path;
  if (end - begin < 2) {
    throw InputError(one_file ? "the channels do not overlap in time" : "the two files do not overlap in time",
                     "check that they are of the same run", other.file());
  }
  const double start = base[static_cast<std::size_t>(begin)];
  const auto dropped = static_cast<std::ptrdiff_t>(base.size()) - (end - begin);
  crop(run, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
  if (dropped > 0) {
    run.notes.push_back(fmt::format("{} rows outside the common time of the two {} were cut off", dropped,
                                    one_file ? "sets of channels" : "files"));
  }
  run.second_path = other.path;
  std::vector<std::string> names;
  for (const Column& column : other.columns.used) {
    const Channel channel = column.channel;
    if (channel == Channel::time || channel == Channel::step || run.has(channel)) continue;
    const auto same_place = [&](const Column& c) { return info_of(c.channel).target == info_of(channel).target; };
    const auto there = std::find_if(run.columns.used.begin(), run.columns.used.end(), same_place);
    if (there != run.columns.used.end()) {  // mu beside a force, v_b beside v_r: the first of them is meant
      if (index_of(there->channel) < index_of(channel)) continue;
      run.columns.used.erase(there);
    }
    run[channel] = interpolate(run[Channel::time], offset - start, time, other[channel]);
    run.columns.used.push_back(column);
    run.second_channels.push_back(channel);
    names.push_back(column.name);
  }
  run.notes.push_back(fmt::format(
      "the channels {} ({}) were interpolated linearly at {}", one_file ? listed(names) : "of " + other.path,
      frequency_text(1 / typical_interval(time)), frequency_text(1 / typical_interval(run[Channel::time]))));
}

}  // namespace

void join(FileRecord& run, FileRecord other, const ClockOffsetFinder& find) {
  if (!run.has_friction() && other.has_friction()) {
    std::swap(run, other);
    run.notes.push_back("the friction is in the second file, whose time was kept");
  }
  for (const Channel channel :
       {Channel::mu, Channel::force, Channel::torque, Channel::v_b, Channel::v_r, Channel::x_b, Channel::x_d}) {
    if (!run.has(channel) || !other.has(channel)) continue;
    throw InputError(fmt::format("holds {} like {}", to_string(channel), run.path),
                     "two instruments must record different channels; files of one run are continued, not joined",
                     other.file());
  }
  for (const std::string& note : other.notes) run.notes.push_back("second file: " + note);
  for (const std::string& warning : other.warnings) run.warnings.push_back("second file: " + warning);
  add_channels(run, other, find_offset(run, other, find));
  run.checksum = xxh64(other.checksum, run.checksum);
}

void join_on_one_clock(FileRecord& run, FileRecord other) {
  run.notes.insert(run.notes.end(), other.notes.begin(), other.notes.end());
  run.warnings.insert(run.warnings.end(), other.warnings.begin(), other.warnings.end());
  add_channels(run, other, other.clock_start - run.clock_start);
}

}  // namespace tribofit
