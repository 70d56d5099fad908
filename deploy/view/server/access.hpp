// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

/// Who may use a web server.
struct AccessSettings {
  std::string address = "127.0.0.1";  ///< address that the server listens on
  std::uint16_t port = 8080;
  /// Origins of other servers' pages, for example https://example.org.
  std::vector<std::string> allowed_origins;
  std::string token;  ///< token for requests that give commands; empty: no request may give commands
};

/// The relevant headers of a request; empty: the header is missing.
struct RequestSource {
  std::string_view host, origin, authorization;
};

/// Why a request is refused, for example because another server's page sent it through the user's browser;
/// empty if it is not refused. Requests must name this server as their host, which prevents DNS rebinding.
[[nodiscard]] std::string refusal(const AccessSettings& settings, const RequestSource& source);

/// Why a request may not give commands; empty if it may.
[[nodiscard]] std::string command_refusal(const AccessSettings& settings, const RequestSource& source);

/// A random token of 128 bits, in hexadecimal.
[[nodiscard]] std::string random_token();

}  // namespace sidestep
