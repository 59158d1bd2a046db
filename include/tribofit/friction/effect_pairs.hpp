#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The experiment that tells two effects apart which look alike in most records, as one imperative sentence without a
/// full stop; empty where the catalogue knows of none. The order of the keys does not matter.
std::string telling_test(std::string_view key_a, std::string_view key_b);

/// Every effect that looks like the one of that key, with the test that tells them apart.
std::vector<LookAlike> look_alikes(std::string_view key);

}  // namespace tribofit
