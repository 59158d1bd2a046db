#include "tribofit/instruments/static_response.hpp"

#include <cmath>

namespace tribofit {

double StaticResponse::lost(double x) const {
  const double u = x / full_scale;
  return form == Form::square ? u * u : form == Form::linear ? std::abs(u) : u < 0 ? 1 : 0;
}

double StaticResponse::reading(double x) const {
  return any() ? x * (1 - part * lost(x)) : x;
}

double StaticResponse::gain(double x) const {
  const double power = form == Form::square ? 2 : form == Form::linear ? 1 : 0;
  return any() ? 1 - (power + 1) * part * lost(x) : 1;
}

double StaticResponse::undone(double reading) const {
  if (!any()) return reading;
  constexpr int kSteps = 4;  // from the reading: each squares what is left
  constexpr double kFlattest = 0.1;
  double x = reading;
  for (int k = 0; k < kSteps; ++k) x -= (this->reading(x) - reading) / std::fmax(gain(x), kFlattest);
  return x;
}

}  // namespace tribofit
