#pragma once

#include <string>
#include <string_view>

namespace tribofit {

/// One spelling for units that people write in many ways, in ASCII: "\u00b5m" is "um", "N\u00b7m" is "N*m", "ft-lb" is
/// "lbf*ft".
std::string usual_spelling(std::string_view text);

}  // namespace tribofit
