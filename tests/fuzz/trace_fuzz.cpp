#include <cmath>
#include <cstddef>
#include <vector>

#include "scratch.hpp"
#include "targets.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit::fuzz {
namespace {

void require_channel(const std::vector<double>& values, std::size_t size) {
  require(values.empty() || values.size() == size);
  for (const double value : values) require(std::isfinite(value));
}

void require_valid(const Trace& trace) {
  const std::size_t size = trace.size();
  require(size >= 2 && trace.friction.size() == size && trace.time.front() == 0);
  for (std::size_t i = 1; i < size; ++i) require(trace.time[i] > trace.time[i - 1]);
  for (const auto* channel :
       {&trace.friction, &trace.velocity, &trace.load, &trace.temperature, &trace.disc_speed, &trace.disc_angle}) {
    require_channel(*channel, size);
  }
  std::size_t next = 0;
  for (const Step& step : trace.steps) {
    require(step.begin == next && step.end > step.begin);
    next = step.end;
  }
  require(next == size);
}

}  // namespace

void read_trace_bytes(std::string_view bytes) {
  static const Folder scratch;
  const std::string path = scratch.write("trace.csv", bytes);
  ReadOptions options;
  options.threads = 1;
  options.conditions.radius = {0.015, "command line"};
  is_read([&] { require_valid(read_trace(path, options)); });
}

}  // namespace tribofit::fuzz
