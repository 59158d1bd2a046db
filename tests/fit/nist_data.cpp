#include "nist_data.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace nist {
namespace {

bool begins_with(const std::string& line, std::string_view text) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string::npos && line.compare(first, text.size(), text) == 0;
}

/// The numbers of a line from position `from` on; stops at the first word that is none.
std::vector<double> numbers(const std::string& line, std::size_t from) {
  std::istringstream words(line.substr(from));
  std::vector<double> values;
  for (double value = 0; words >> value;) values.push_back(value);
  return values;
}

/// Some copies of Roszman1.dat have their first certified value garbled. The value of NIST's tables is the one
/// that reproduces the certified residual sum of squares; with the garbled one every residual is off by one.
std::string without_misprint(std::string line) {
  constexpr std::string_view garbled = "1.20196866396E-0 ", certified = "2.0196866396E-01 ";
  if (const auto at = line.find(garbled); at != std::string::npos) line.replace(at, garbled.size(), certified);
  return line;
}

/// "b1 =   500   250   2.3894212918E+02  2.7070075241E+00": both starts, certified value, standard deviation.
void read_parameter(const std::string& line, Problem& problem) {
  const auto values = numbers(line, line.find('=') + 1);
  if (values.size() != 4) return;
  problem.starts[0].push_back(values[0]);
  problem.starts[1].push_back(values[1]);
  problem.certified.push_back(values[2]);
  problem.standard_deviations.push_back(values[3]);
}

void read_observation(const std::string& line, Problem& problem) {
  const auto values = numbers(line, 0);
  if (values.size() < 2) return;
  problem.response.push_back(values.front());
  problem.predictors.emplace_back(values.begin() + 1, values.end());
}

double correct_digits(double value, double certified) {
  constexpr double certified_digits = 11;
  const double digits = -std::log10(std::abs(value - certified) / std::abs(certified));
  return std::isnan(digits) ? 0 : std::clamp(digits, 0.0, certified_digits);
}

}  // namespace

Problem read_problem(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  Problem problem;
  std::size_t observations = 0;
  bool in_data = false;
  for (std::string line; std::getline(file, line);) {
    if (in_data) {
      read_observation(line, problem);
    } else if (begins_with(line, "Dataset Name:")) {
      std::istringstream(line.substr(line.find(':') + 1)) >> problem.name;
    } else if (begins_with(line, "b") && line.find('=') != std::string::npos) {
      read_parameter(without_misprint(line), problem);
    } else if (begins_with(line, "Residual Sum of Squares:")) {
      problem.residual_sum_of_squares = numbers(line, line.find(':') + 1).at(0);
    } else if (begins_with(line, "Number of Observations:")) {
      observations = static_cast<std::size_t>(numbers(line, line.find(':') + 1).at(0));
    } else if (begins_with(line, "Data:")) {
      // "Data:" stands twice: over the description, and over the columns ("Data:   y   x").
      std::istringstream words(line.substr(line.find(':') + 1));
      std::string word;
      in_data = words >> word && word == "y";
    }
  }
  if (problem.certified.empty() || observations == 0 || problem.response.size() != observations) {
    throw std::runtime_error(path + ": not a complete problem file");
  }
  return problem;
}

double mean_log_relative_error(const std::vector<double>& values, const std::vector<double>& certified) {
  double sum = 0;
  for (std::size_t i = 0; i < certified.size(); ++i) sum += correct_digits(values.at(i), certified[i]);
  return sum / static_cast<double>(certified.size());
}

double least_log_relative_error(const std::vector<double>& values, const std::vector<double>& certified) {
  double least = correct_digits(values.at(0), certified.at(0));
  for (std::size_t i = 1; i < certified.size(); ++i) {
    least = std::min(least, correct_digits(values.at(i), certified[i]));
  }
  return least;
}

}  // namespace nist
