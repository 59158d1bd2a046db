#include "fixed_decimals.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

void append_fixed(std::string& text, double value, int decimals) {
  constexpr double kLargest = 1e9;
  if (!(std::abs(value) < kLargest)) {
    if (!std::isfinite(value)) {
      throw InputError("the simulated record holds a value that is no finite number",
                       "give friction, rig and sensors smaller values");
    }
    text += fixed(value, decimals);
    return;
  }
  constexpr std::array<double, 10> kPower = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  const auto scaled = std::llround(value * kPower[static_cast<std::size_t>(decimals)]);
  const auto unit = static_cast<long long>(kPower[static_cast<std::size_t>(decimals)]);
  std::array<char, 24> digits{};
  const long long magnitude = scaled < 0 ? -scaled : scaled;
  if (scaled < 0) text += '-';
  const auto put = [&](long long n, std::size_t width) {
    const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), n).ptr;
    const auto length = static_cast<std::size_t>(end - digits.data());
    if (length < width) text.append(width - length, '0');
    text.append(digits.data(), length);
  };
  put(magnitude / unit, 1);
  if (decimals == 0) return;
  text += '.';
  put(magnitude % unit, static_cast<std::size_t>(decimals));
}

int time_decimals(double rate) {
  double ticks = 1 / rate;
  int decimals = 0;
  while (decimals < 9 && std::abs(ticks - std::round(ticks)) > 1e-9 * ticks) {
    ticks *= 10;
    ++decimals;
  }
  return decimals;
}

}  // namespace tribofit
