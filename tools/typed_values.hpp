#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/units.hpp"

/// What is typed as the value of an option: numbers with units, ranges of them, and values by name. The one grammar of
/// all options.

/// A value in SI. Usage error: a quantity that has a unit is typed without one. Throws tribofit::InputError that names
/// the option as parse_quantity does, and for a value that no machine has: it is a slip of the finger or of the unit,
/// and what it would lead to costs hours or memory.
double stated_value(std::string_view text, tribofit::Quantity quantity, const std::string& option);

/// The same of a value that must be greater than zero.
double positive_value(std::string_view text, tribofit::Quantity quantity, const std::string& option);

/// What stands behind the number; empty for a bare number.
std::string unit_of(std::string_view text);

/// Whether a number stands there alone, which most quantities are not typed as.
bool is_bare_number(std::string_view text);

/// Both ends of "LOW..HIGH"; the unit of the last holds for both where the first has none.
/// Throws tribofit::InputError, which shows the example.
std::pair<std::string, std::string> range_ends(const std::string& text, const std::string& option,
                                               const std::string& example);

/// "NAME=TEXT,NAME=TEXT" in order. Throws UsageError where a part is not so, and where a name comes twice.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;
NamedTexts named_texts(const std::vector<std::string>& texts, const std::string& option, const std::string& example);

/// Two parts of "A,B". Throws tribofit::InputError, which shows the example.
std::pair<std::string, std::string> two_parts(const std::string& text, std::string_view separator,
                                              const std::string& option, const std::string& example);

/// What `work` gives; input that it refuses is taken for wrong usage.
template <class Work>
auto as_usage(Work&& work) {
  try {
    return work();
  } catch (const tribofit::InputError& error) {
    throw UsageError(error.what());
  }
}

/// A seed. Usage error where it is no whole number of 64 bits.
std::uint64_t stated_seed(const std::string& text);
