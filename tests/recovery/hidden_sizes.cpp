#include <algorithm>
#include <stdexcept>

#include "hidden_recipes.hpp"

namespace recovery {

using namespace tribofit;

namespace {

struct Row {
  std::string_view key;
  HiddenCases cases;
};

const ValueDraw kAnyPhase = {.lower = -3.14, .upper = 3.14};

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {"viscous", {.sizes = {0.0008, 0.0011, 0.0015}}},
      {"stribeck-exponent", {.sizes = {0.6, 1.4, 1.8}}},
      {"frictional-lag", {.sizes = {0.5, 1, 2}}},
      {"rate-state", {.sizes = {20, 50, 90}, .others = {{.choices = {0}}}}},
      {"bristle", {.sizes = {100, 60, 30}, .others = {{.choices = {0.001}}}}},
      {"contact-spin", {.sizes = {0.5, 1, 2}}},
      {"ageing", {.sizes = {0.01, 0.015, 0.02}, .others = {{.lower = 0.05, .upper = 0.2}}}},
      {"asymmetry", {.sizes = {0.93, 1.07, 1.15}}},
      {"hysteresis", {.sizes = {0.02, 0.04, 0.08}, .others = {{.lower = 3, .upper = 20}}}},
      {"heating", {.sizes = {0.05, 0.1}, .either_sign = true, .others = {{.lower = 8, .upper = 15}}}},
      {"run-in", {.sizes = {0.05, 0.08}, .either_sign = true, .others = {{.lower = 30, .upper = 80}}}},
      {"drift", {.sizes = {0.0006, 0.0009, 0.0012}, .either_sign = true}},
      {"step", {.sizes = {0.015, 0.03}, .either_sign = true, .others = {{.lower = 8, .upper = 32}}}},
      {"load-dependence", {.sizes = {0.1, 0.2, 0.3}}},
      {"temperature-dependence", {.sizes = {0.003, 0.006}, .either_sign = true}},
      {"runout", {.sizes = {0.02, 0.04, 0.06}, .others = {kAnyPhase}}},
      {"disc-pattern", {.sizes = {0.02, 0.04}, .others = {kAnyPhase, {.choices = {0, 0.02}}, kAnyPhase}}},
      {"speed-ripple", {.sizes = {0.03, 0.07}, .others = {{.choices = {1, 2, 3}}, kAnyPhase}}},
      {"load-coupling", {.sizes = {0.1, 0.2}, .either_sign = true}},
      {"ringing",
       {.sizes = {0.008, 0.014}, .others = {{.lower = 150, .upper = 400}, {.lower = 0.02, .upper = 0.06}, kAnyPhase}}},
      {"backlash", {.sizes = {0.05, 0.1, 0.2}, .others = {{.lower = 3, .upper = 30}}}},
      {"sensor-inertia", {.sizes = {0.1, 0.2}}},
      {"sensor-offset", {.sizes = {0.01, 0.02}, .either_sign = true}},
      {"zero-drift", {.sizes = {0.0006, 0.0012}, .either_sign = true}},
      {"crosstalk", {.sizes = {0.01, 0.02}, .either_sign = true}},
      {"force-bandwidth", {.sizes = {300, 200, 100}, .others = {{.lower = 0.5, .upper = 0.9}}}},
      {"channel-delay", {.sizes = {0.5, 1, 2}, .either_sign = true}},
      {"radius-offset", {.sizes = {0.94, 1.05}}},
      {"velocity-gain", {.sizes = {0.93, 1.08}}},
      {"velocity-highpass", {.sizes = {0.1, 0.3}}},
      {"velocity-offset", {.sizes = {0.3, 1}, .either_sign = true}},
      {"velocity-bandwidth", {.sizes = {800, 400, 200}}},
      {"velocity-compression", {.sizes = {0.05, 0.1}, .either_sign = true}},
      {"friction-compression", {.sizes = {0.03, 0.1, 0.2}}},
      {"clock-drift", {.sizes = {1e-4, 2e-4}, .either_sign = true}},
      {"interference", {.sizes = {0.005, 0.012}, .others = {{.choices = {50, 60, 133}}, kAnyPhase}}},
  };
  return all;
}

}  // namespace

const HiddenCases& hidden_cases(std::string_view key) {
  const auto at = std::find_if(rows().begin(), rows().end(), [&](const Row& row) { return row.key == key; });
  if (at == rows().end()) throw std::invalid_argument("no size is stated at which to hide " + std::string(key));
  return at->cases;
}

}  // namespace recovery
