// Uses the installed library as its README shows; exits with 0 when the answers are right.
#include <tribofit/ingest/input_error.hpp>
#include <tribofit/ingest/units.hpp>
#include <tribofit/pipeline.hpp>
#include <tribofit/version.hpp>

#include <cmath>
#include <cstdio>

int main(int count, char** arguments) {
  std::printf("tribofit %s\n", tribofit::version.data());
  const double radius = tribofit::parse_quantity("15mm", tribofit::Quantity::length, "--radius");
  if (std::abs(radius - 0.015) > 1e-15) return 1;
  try {
    tribofit::parse_quantity("15N", tribofit::Quantity::length, "--radius");
  } catch (const tribofit::InputError& error) {
    std::printf("refused, as it should be: %s\n", error.what());
  }
  if (count < 2) return 1;
  tribofit::IdentifyOptions options;
  options.read.conditions.radius = {0.015, "command line"};
  const tribofit::Identification result = tribofit::identify(arguments[1], options);
  const tribofit::Fit& fit = result.fits[result.best];
  std::printf("mu_s = %.4f, mu_k = %.4f\n", fit.parameters[0].value, fit.parameters[1].value);
  // The example was simulated with the 15 mm row of Table 4 of [D].
  return std::abs(fit.parameters[0].value - 0.509) < 0.0025 && std::abs(fit.parameters[1].value - 0.318) < 0.0016 ? 0
                                                                                                                  : 1;
}
