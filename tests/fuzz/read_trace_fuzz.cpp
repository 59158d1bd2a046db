// Any bytes are read as a valid trace or refused with an InputError that says what to do; nothing else may happen.

#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void require_channel(const std::vector<double>& values, std::size_t size) {
  require(values.empty() || values.size() == size);
  for (const double value : values) require(std::isfinite(value));
}

void require_valid(const tribofit::Trace& trace) {
  const std::size_t size = trace.size();
  require(size >= 2 && trace.friction.size() == size && trace.time.front() == 0);
  for (std::size_t i = 1; i < size; ++i) require(trace.time[i] > trace.time[i - 1]);
  for (const auto* channel :
       {&trace.friction, &trace.velocity, &trace.load, &trace.temperature, &trace.disc_speed, &trace.disc_angle}) {
    require_channel(*channel, size);
  }
  std::size_t next = 0;
  for (const tribofit::Step& step : trace.steps) {
    require(step.begin == next && step.end > step.begin);
    next = step.end;
  }
  require(next == size);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path =
      (std::filesystem::temp_directory_path() / ("tribofit-fuzz-" + std::to_string(::getpid()) + ".csv")).string();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  tribofit::ReadOptions options;
  options.threads = 1;
  options.conditions.radius = {0.015, "command line"};
  try {
    require_valid(tribofit::read_trace(path, options));
  } catch (const tribofit::InputError& error) {
    require(!error.problem().empty() && !error.advice().empty());
  }
  return 0;
}
