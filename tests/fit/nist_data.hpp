#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace nist {

/// The 27 nonlinear regression problems of the NIST Statistical Reference Datasets (StRD), easiest level first.
inline constexpr std::array<std::string_view, 27> problem_names = {
    "Misra1a", "Chwirut2", "Chwirut1", "Lanczos3", "Gauss1",   "Gauss2",   "DanWood", "Misra1b", "Kirby2",
    "Hahn1",   "Nelson",   "MGH17",    "Lanczos1", "Lanczos2", "Gauss3",   "Misra1c", "Misra1d", "Roszman1",
    "ENSO",    "MGH09",    "Thurber",  "BoxBOD",   "Rat42",    "Eckerle4", "MGH10",   "Rat43",   "Bennett5"};

/// One problem as certified by NIST: data, two starts, and the certified answer.
struct Problem {
  std::string name;
  std::vector<double> response;                 ///< y as printed (for Nelson the model is of log y)
  std::vector<std::vector<double>> predictors;  ///< predictors[i]: x (or x1, x2) of observation i
  std::array<std::vector<double>, 2> starts;
  std::vector<double> certified;            ///< parameters, 11 digits
  std::vector<double> standard_deviations;  ///< of the parameters, 11 digits
  double residual_sum_of_squares = 0;

  /// Observations less parameters. (The file of Rat43 prints 9; its certified residual deviation is that of 11.)
  std::size_t degrees_of_freedom() const { return response.size() - certified.size(); }
};

/// Reads a .dat file as NIST publishes it. Throws std::runtime_error naming the file when it is not complete.
Problem read_problem(const std::string& path);

/// Mean over i of the correct digits of values[i]: -log10(|v - c|/|c|), at most 11 each as no more are certified.
double mean_log_relative_error(const std::vector<double>& values, const std::vector<double>& certified);

/// The least such number of digits over i.
double least_log_relative_error(const std::vector<double>& values, const std::vector<double>& certified);

}  // namespace nist
