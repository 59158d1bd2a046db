#include "guard.hpp"

#include <fmt/format.h>

#include <array>
#include <random>

namespace tribofit::workbench {

std::string fresh_token() {
  std::random_device device;  // getrandom() or its like
  std::string token;
  for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", device());
  return token;
}

bool same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0u : 1u;
  for (std::size_t k = 0; k < b.size(); ++k) {
    const char other = k < a.size() ? a[k] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(other) ^ static_cast<unsigned char>(b[k]));
  }
  return difference == 0;
}

std::string refusal(const Caller& caller, int port) {
  const std::array<std::string, 2> own = {fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)};
  if (caller.host != own[0] && caller.host != own[1]) return "it is addressed to another host";
  if (!caller.origin.empty() && caller.origin != "http://" + own[0] && caller.origin != "http://" + own[1]) {
    return "it comes from another page";
  }
  const bool own_site = caller.fetch_site.empty() || caller.fetch_site == "same-origin" || caller.fetch_site == "none";
  return own_site ? "" : "it comes from another site";
}

}  // namespace tribofit::workbench
