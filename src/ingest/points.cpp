#include "points.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "content_hash.hpp"
#include "limits.hpp"

namespace tribofit {

namespace {

std::vector<double> numbers_from_zero(std::size_t count) {
  std::vector<double> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return numbers;
}

}  // namespace

bool are_columns_of_points(const Columns& columns) {
  const auto has = [&](Channel channel) { return columns.find(channel) != nullptr; };
  const bool friction = has(Channel::mu) || has(Channel::force) || has(Channel::torque);
  if (has(Channel::v_r) || has(Channel::speed)) return friction;
  const Column* block = columns.find(Channel::v_b);
  if (block == nullptr) return false;
  const std::string base = parse_column_name(block->name).base;
  return friction && base != "vb" && base.find("block") == std::string::npos && base.find("vib") == std::string::npos;
}

bool is_no_clock(const std::vector<double>& time) {
  std::size_t back = 0;
  for (std::size_t i = 1; i < time.size(); ++i) back += time[i] < time[i - 1] ? 1U : 0U;
  return kIntervalsPerReturn * back > time.size();
}

void set_points(FileRecord& recording) {
  std::size_t rows = 0;
  for (const Channel channel : recording.present()) rows = std::max(rows, recording[channel].size());
  recording[Channel::time] = numbers_from_zero(rows);
  for (const Channel of_time : {Channel::step, Channel::angle}) recording[of_time].clear();
  recording.clock_end = rows > 0 ? static_cast<double>(rows - 1) : 0;
  recording.steps = {{0, rows, "", recording.file_conditions}};
  recording.recipe_steps = {0};
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
