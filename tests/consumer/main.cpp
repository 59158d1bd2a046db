// Uses the installed library as its README shows; exits with 0 when the answers are right.
#include <tribofit/ingest/input_error.hpp>
#include <tribofit/ingest/units.hpp>
#include <tribofit/version.hpp>

#include <cmath>
#include <cstdio>

int main() {
  std::printf("tribofit %s\n", tribofit::version.data());
  const double radius = tribofit::parse_quantity("15mm", tribofit::Quantity::length, "--radius");
  if (std::abs(radius - 0.015) > 1e-15) return 1;
  try {
    tribofit::parse_quantity("15N", tribofit::Quantity::length, "--radius");
  } catch (const tribofit::InputError& error) {
    std::printf("refused, as it should be: %s\n", error.what());
    return 0;
  }
  return 1;
}
