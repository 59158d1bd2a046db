#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tribofit/ingest/units.hpp"

/// A value as typed, in SI. Throws tribofit::InputError that names the option as parse_quantity does, and for a value
/// that no machine has: it is a slip of the finger or of the unit, and what it would lead to costs hours or memory.
double stated_value(std::string_view text, tribofit::Quantity quantity, const std::string& option,
                    std::string_view bare_unit = {});

/// A seed as typed. Usage error where it is no whole number of 64 bits.
std::uint64_t stated_seed(const std::string& text);

/// The same of an option that need not be given.
double given_or(const std::string& text, tribofit::Quantity quantity, const char* option, std::string_view bare_unit,
                double otherwise);
