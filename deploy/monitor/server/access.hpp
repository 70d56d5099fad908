// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

/// Who may use a web server.
struct AccessSettings {
  std::string address = "127.0.0.1";  ///< that the server listens on
  std::uint16_t port = 8080;
  std::vector<std::string> allowed_origins;  ///< of pages of other servers, e.g. https://example.org
  std::string token;                         ///< for requests that command; empty: none may
};

/// What a request's headers say; empty: the header is missing.
struct RequestSource {
  std::string_view host, origin, authorization;
};

/// Why a request is refused, e.g. because a page of another server sent it through the user's browser; empty:
/// it is not. Requests must name this server as their host, so that no other name can be made to lead here
/// (DNS rebinding).
[[nodiscard]] std::string refusal(const AccessSettings& settings, const RequestSource& source);

/// Why a request may not command; empty: it may.
[[nodiscard]] std::string command_refusal(const AccessSettings& settings, const RequestSource& source);

/// A random token of 128 bits, in hexadecimal.
[[nodiscard]] std::string random_token();

}  // namespace sidestep
