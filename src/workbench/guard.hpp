#pragma once

#include <string>
#include <string_view>

namespace tribofit::workbench {

/// 128 bits from the system's generator, as 32 hexadecimal digits.
std::string fresh_token();

/// Whether two texts are the same, in a time that does not tell where they differ.
bool same_secret(std::string_view a, std::string_view b);

/// What a request says of where it comes from; empty: it does not say.
struct Caller {
  std::string host, origin, fetch_site;
};
/// Why the server at this port must not answer it; empty: it may.
std::string refusal(const Caller& caller, int port);

}  // namespace tribofit::workbench
