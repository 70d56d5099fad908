// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/protocol/senders.hpp"
#include "idl/order.hpp"

namespace sidestep {

/// A client's name, which people read instead of its id, filled up with zeros. All zeros: it has none, or one
/// that does not fit.
using ClientName = std::array<std::uint8_t, msg::MAX_CLIENT_NAME>;

/// Whether the character may be part of the name in a client's key.
constexpr bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// Returns all zeros for a text that is too long or has other characters.
[[nodiscard]] inline ClientName client_name(std::string_view text) {
  ClientName name{};
  if (text.size() <= name.size() && std::ranges::all_of(text, is_name_character))
    std::ranges::copy(text, name.begin());
  return name;
}

[[nodiscard]] inline std::string to_text(const ClientName& name) {
  return {name.begin(), std::ranges::find(name, std::uint8_t{0})};
}

/// Whether a received name is empty, or well formed and the one from which the client's id is made.
[[nodiscard]] inline bool is_name_of(const ClientName& name, std::uint32_t client) {
  const std::string text = to_text(name);
  return name == client_name(text) && (text.empty() || client_id(text) == client);
}

}  // namespace sidestep
