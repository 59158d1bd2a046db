#pragma once

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

/// The models of the NIST StRD problems, for any scalar type T with the usual functions (double, automatic
/// differentiation). Each is called as model(b, x) with `parameters` values at b and the predictors of one
/// observation at x. Equations as in the header of each .dat file; Nelson's is of log y.
namespace nist {

/// b1 (1 - exp(-b2 x)): Misra1a, BoxBOD
struct Saturation {
  static constexpr int parameters = 2;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] * (1.0 - exp(-b[1] * x[0]));
  }
};

struct Misra1b {
  static constexpr int parameters = 2;
  template <class T>
  T operator()(const T* b, const double* x) const {
    const T root = 1.0 + b[1] * x[0] / 2.0;
    return b[0] * (1.0 - 1.0 / (root * root));
  }
};

struct Misra1c {
  static constexpr int parameters = 2;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::sqrt;
    return b[0] * (1.0 - 1.0 / sqrt(1.0 + 2.0 * b[1] * x[0]));
  }
};

struct Misra1d {
  static constexpr int parameters = 2;
  template <class T>
  T operator()(const T* b, const double* x) const {
    return b[0] * b[1] * x[0] / (1.0 + b[1] * x[0]);
  }
};

/// Chwirut1, Chwirut2
struct Chwirut {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return exp(-b[0] * x[0]) / (b[1] + b[2] * x[0]);
  }
};

/// Lanczos1, Lanczos2, Lanczos3
struct Lanczos {
  static constexpr int parameters = 6;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-b[3] * x[0]) + b[4] * exp(-b[5] * x[0]);
  }
};

/// Gauss1, Gauss2, Gauss3
struct Gauss {
  static constexpr int parameters = 8;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    const T first = (x[0] - b[3]) / b[4];
    const T second = (x[0] - b[6]) / b[7];
    return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-first * first) + b[5] * exp(-second * second);
  }
};

struct DanWood {
  static constexpr int parameters = 2;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] * exp(b[1] * std::log(x[0]));
  }
};

struct Kirby2 {
  static constexpr int parameters = 5;
  template <class T>
  T operator()(const T* b, const double* x) const {
    return (b[0] + x[0] * (b[1] + x[0] * b[2])) / (1.0 + x[0] * (b[3] + x[0] * b[4]));
  }
};

/// Cubic over cubic: Hahn1, Thurber
struct RationalCubic {
  static constexpr int parameters = 7;
  template <class T>
  T operator()(const T* b, const double* x) const {
    return (b[0] + x[0] * (b[1] + x[0] * (b[2] + x[0] * b[3]))) / (1.0 + x[0] * (b[4] + x[0] * (b[5] + x[0] * b[6])));
  }
};

/// Of log y.
struct Nelson {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] - b[1] * x[0] * exp(-b[2] * x[1]);
  }
};

struct Mgh17 {
  static constexpr int parameters = 5;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] + b[1] * exp(-x[0] * b[3]) + b[2] * exp(-x[0] * b[4]);
  }
};

struct Roszman1 {
  static constexpr int parameters = 4;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::atan;
    return b[0] - b[1] * x[0] - atan(b[2] / (x[0] - b[3])) / std::numbers::pi;
  }
};

struct Enso {
  static constexpr int parameters = 9;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::cos, std::sin;
    const double turn = 2.0 * std::numbers::pi * x[0];
    return b[0] + b[1] * std::cos(turn / 12.0) + b[2] * std::sin(turn / 12.0) + b[4] * cos(turn / b[3]) +
           b[5] * sin(turn / b[3]) + b[7] * cos(turn / b[6]) + b[8] * sin(turn / b[6]);
  }
};

struct Mgh09 {
  static constexpr int parameters = 4;
  template <class T>
  T operator()(const T* b, const double* x) const {
    return b[0] * (x[0] * x[0] + x[0] * b[1]) / (x[0] * x[0] + x[0] * b[2] + b[3]);
  }
};

struct Rat42 {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] / (1.0 + exp(b[1] - b[2] * x[0]));
  }
};

struct Rat43 {
  static constexpr int parameters = 4;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp, std::pow;
    return b[0] / pow(1.0 + exp(b[1] - b[2] * x[0]), 1.0 / b[3]);
  }
};

struct Eckerle4 {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    const T distance = (x[0] - b[2]) / b[1];
    return b[0] / b[1] * exp(-0.5 * distance * distance);
  }
};

struct Mgh10 {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::exp;
    return b[0] * exp(b[1] / (x[0] + b[2]));
  }
};

struct Bennett5 {
  static constexpr int parameters = 3;
  template <class T>
  T operator()(const T* b, const double* x) const {
    using std::pow;
    return b[0] * pow(b[1] + x[0], -1.0 / b[2]);
  }
};

/// Calls visit(model) with the model of the problem named `problem`, one of problem_names.
template <class Visitor>
auto with_model(std::string_view problem, Visitor&& visit) {
  if (problem == "Misra1a" || problem == "BoxBOD") return visit(Saturation{});
  if (problem == "Misra1b") return visit(Misra1b{});
  if (problem == "Misra1c") return visit(Misra1c{});
  if (problem == "Misra1d") return visit(Misra1d{});
  if (problem == "Chwirut1" || problem == "Chwirut2") return visit(Chwirut{});
  if (problem.starts_with("Lanczos")) return visit(Lanczos{});
  if (problem.starts_with("Gauss")) return visit(Gauss{});
  if (problem == "DanWood") return visit(DanWood{});
  if (problem == "Kirby2") return visit(Kirby2{});
  if (problem == "Hahn1" || problem == "Thurber") return visit(RationalCubic{});
  if (problem == "Nelson") return visit(Nelson{});
  if (problem == "MGH17") return visit(Mgh17{});
  if (problem == "Roszman1") return visit(Roszman1{});
  if (problem == "ENSO") return visit(Enso{});
  if (problem == "MGH09") return visit(Mgh09{});
  if (problem == "Rat42") return visit(Rat42{});
  if (problem == "Rat43") return visit(Rat43{});
  if (problem == "Eckerle4") return visit(Eckerle4{});
  if (problem == "MGH10") return visit(Mgh10{});
  if (problem == "Bennett5") return visit(Bennett5{});
  throw std::runtime_error("no model for the NIST problem " + std::string(problem));
}

}  // namespace nist
