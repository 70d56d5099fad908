// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/access.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <random>

namespace sidestep {
namespace {

/// Compares two texts in a time that does not reveal how many characters are equal.
bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// Whether a browser may address this server by the name `host`.
bool is_own_host(const AccessSettings& settings, std::string_view host) {
  const std::string port = fmt::format(":{}", settings.port);
  const auto is = [&](std::string_view name) { return host == std::string(name) + port; };
  return is(settings.address) || is("localhost") || is("127.0.0.1") || is("[::1]");
}

}  // namespace

std::string refusal(const AccessSettings& settings, const RequestSource& source) {
  if (!is_own_host(settings, source.host))
    return fmt::format("the host '{}' is not this server, expected {}:{}", source.host, settings.address,
                       settings.port);
  const bool is_allowed =
      source.origin.empty() || source.origin == fmt::format("http://{}", source.host) ||
      std::ranges::find(settings.allowed_origins, source.origin) != settings.allowed_origins.end();
  if (!is_allowed) return fmt::format("pages of {} are not allowed, see --allow-origin", source.origin);
  return {};
}

std::string command_refusal(const AccessSettings& settings, const RequestSource& source) {
  if (settings.token.empty()) return "this monitor refuses commands; start it with --control";
  if (!is_same_secret(source.authorization, "Bearer " + settings.token))
    return "the header 'Authorization: Bearer TOKEN' is missing or has another token";
  return {};
}

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

}  // namespace sidestep
