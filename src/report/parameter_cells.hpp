#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

struct Identification;

/// What tables of parameters hold, on a terminal and on a page alike.

/// "mu = mu_k + (mu_s - mu_k) exp(-alpha v)".
std::string_view equation(BaseLaw law);

/// What a reader must know of a parameter: "at bound, correlated"; empty where nothing.
std::string flags_of(const Fit& fit, std::size_t parameter);

/// "[0.507, 0.511]"; "-" where neither end is known.
std::string bracket(double lower, double upper, int places);

/// Decimal places of a parameter's value: those its standard error allows, else five significant digits.
int places_of(const FitParameter& parameter);

/// The joint fit of the same law, which may carry effects that the published protocol does not know; nullptr: none.
const Fit* partner_of(const Identification& result, const Fit& fit);

/// A parameter by the published protocol beside the joint fit: law (empty in all rows of it but the first), parameter,
/// published, joint, difference, unit.
struct ProtocolRow {
  std::vector<std::string> cells;
  bool differs = false;  ///< the published value lies outside the 95 % interval of the joint fit
};
std::vector<ProtocolRow> protocol_rows(const Identification& result);

/// The best law against each other one: "exponential predicts data it has not seen better than fractional (...)".
std::vector<std::string> comparison_sentences(const Identification& result);

}  // namespace tribofit
