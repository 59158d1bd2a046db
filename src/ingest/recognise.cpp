#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "content_hash.hpp"
#include "limits.hpp"
#include "recording.hpp"

namespace tribofit {
namespace {

std::vector<double> numbers_from_zero(std::size_t count) {
  std::vector<double> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return numbers;
}

/// Whether times go back so often that no clock made them.
bool is_no_clock(const std::vector<double>& time) {
  std::size_t back = 0;
  for (std::size_t i = 1; i < time.size(); ++i) back += time[i] < time[i - 1] ? 1U : 0U;
  return kIntervalsPerReturn * back > time.size();
}

/// Whether values go one way for nearly all of a record: a machine goes back to where it began at the end of a test.
bool go_one_way(const std::vector<double>& values) {
  constexpr double kNearlyAll = 0.85, kStill = 1e-3;
  const std::size_t stride = 1 + values.size() / 200;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::size_t on = 0, back = 0;
  for (std::size_t i = stride; i < values.size(); i += stride) {
    const double way = values[i] - values[i - stride];
    on += way > kStill * (*high - *low) ? 1U : 0U;
    back += way < -kStill * (*high - *low) ? 1U : 0U;
  }
  return static_cast<double>(std::max(on, back)) > kNearlyAll * static_cast<double>(on + back);
}

/// Whether a speed stays what it is but for steps, and never turns, as one that is set does.
bool keeps_to_steps(const std::vector<double>& values) {
  constexpr double kStays = 0.02, kLeastStep = 1.5;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  std::size_t stays = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0)) return false;
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
    stays += i > 0 && std::abs(values[i] - values[i - 1]) <= kStays * values[i - 1] ? 1U : 0U;
  }
  return high > kLeastStep * low && stays >= values.size() - values.size() / 20;
}

bool is_velocity(const Column& column) {
  return column.channel == Channel::v_b || column.channel == Channel::v_r;
}

/// A velocity of which nothing more is known is that of a load point where it keeps to steps.
bool take_speed_of_load_point(FileRecord& recording) {
  const auto column =
      std::ranges::find_if(recording.columns.used, [](const Column& c) { return c.plain && is_velocity(c); });
  if (column == recording.columns.used.end() || !keeps_to_steps(recording[column->channel])) return false;
  recording[Channel::v_lp] = std::exchange(recording[column->channel], {});
  column->channel = Channel::v_lp;
  return true;
}

}  // namespace

std::optional<RecordKind> find_record_kind(std::string_view name) {
  const auto at = std::ranges::find(record_kind_texts, name);
  if (at == record_kind_texts.end()) return std::nullopt;
  return static_cast<RecordKind>(at - record_kind_texts.begin());
}

bool are_columns_of_points(const Columns& columns) {
  const auto has = [&](Channel channel) { return columns.find(channel) != nullptr; };
  if (!has(Channel::mu) && !has(Channel::force) && !has(Channel::torque)) return false;
  if (has(Channel::v_r) || has(Channel::speed)) return true;
  const Column* block = columns.find(Channel::v_b);
  return block != nullptr && block->base != "vb" && block->base.find("block") == std::string::npos &&
         block->base.find("vib") == std::string::npos;
}

void recognise_points(bool may_be_points, FileRecord& recording) {
  const std::vector<double>& time = recording[Channel::time];
  if (!may_be_points || !(time.empty() || (time.size() <= kMostTabulated && is_no_clock(time)))) return;
  if (time.empty() && recording.rows() > kMostTabulated) refuse_columns(recording, "no time column");
  recording.kind = RecordKind::points;
  recording.kind_source = time.empty() ? "no time column" : "the times are in no order";
}

void recognise_steps(FileRecord& recording) {
  if (recording.kind || !recording.has_friction()) return;
  std::vector<Column>& used = recording.columns.used;
  const Column* displacement = recording.columns.find(Channel::x_d);
  const bool is_named =
      recording.has(Channel::v_lp) || (displacement != nullptr && names_load_point(displacement->base));
  const bool is_of_contact = recording.has(Channel::x_b) || std::ranges::any_of(used, [](const Column& c) {
                               return is_velocity(c) && !is_among(c.base, info_of(Channel::v_lp).plain);
                             });
  const bool is_coefficient = recording.has(Channel::mu) || recording.is_stress(Channel::force);
  bool is_plain = displacement != nullptr && displacement->plain;
  if (is_plain && !(is_coefficient && go_one_way(recording[Channel::x_d]))) {
    is_plain = false;
    if (!displacement->requested) {
      recording.unused_displacement = recording.column_names[displacement->index];
      recording[Channel::x_d].clear();
      std::erase_if(used, [](const Column& c) { return c.channel == Channel::x_d; });
    }
  }
  if (is_of_contact || !(is_named || is_coefficient)) return;
  if (is_named) {
    recording.kind_source = "the motion of a load point was recorded";
  } else if (is_plain) {
    recording.kind_source = "a displacement in one direction is all the motion recorded";
  } else if (take_speed_of_load_point(recording)) {
    recording.kind_source = "a speed that is set in steps is all the motion recorded";
  } else {
    return;
  }
  recording.kind = RecordKind::velocity_steps;
}

void set_points(FileRecord& recording) {
  recording[Channel::time].clear();
  const std::size_t rows = recording.rows();
  recording[Channel::time] = numbers_from_zero(rows);
  for (const Channel of_time : {Channel::step, Channel::angle}) recording[of_time].clear();
  recording.clock_end = rows > 0 ? static_cast<double>(rows - 1) : 0;
  recording.steps = {{0, rows, "", recording.file_conditions, 0}};
}

void sort_points(Trace& trace) {
  const std::vector<std::vector<double>*> channels = {&trace.velocity,           &trace.disc_speed, &trace.friction,
                                                      &trace.friction_std_error, &trace.load,       &trace.temperature};
  std::vector<std::size_t> order(trace.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    for (const std::vector<double>* channel : channels) {
      if (channel->empty() || (*channel)[a] == (*channel)[b]) continue;
      return (*channel)[a] < (*channel)[b];
    }
    return false;
  });
  std::uint64_t hash = 0;
  for (std::vector<double>* channel : channels) {
    if (channel->empty()) continue;
    std::vector<double> sorted;
    for (const std::size_t i : order) sorted.push_back((*channel)[i]);
    *channel = std::move(sorted);
    hash = xxh64({reinterpret_cast<const char*>(channel->data()), channel->size() * sizeof(double)}, hash);
  }
  trace.checksum = hash;
  trace.time = numbers_from_zero(trace.size());
}

}  // namespace tribofit
