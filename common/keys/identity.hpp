// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/protocol/roles.hpp"

namespace sidestep {

/// The owner of a key: "agent 3", "coordinator 1", "vision", "simulator", "robot 0-10", "referee",
/// "client NAME", "operator", "viewer" or "judge". It is the common name of the key's certificate.
struct Identity {
  Role role = Role::kViewer;
  std::uint32_t first = 0, last = 0;  ///< range of agent, coordinator or robot numbers
  std::string name{};                 ///< name of a client: letters, digits, '-' and '_'

  /// Whether the number is in the range.
  bool covers(std::uint32_t number) const { return number >= first && number <= last; }
  bool operator==(const Identity&) const = default;
};

/// Parses the text form of an identity. Accepts "coordinator" for "coordinator 0". nullopt if the text names
/// no identity.
[[nodiscard]] std::optional<Identity> parse_identity(const std::string& text);
/// Describes what parse_identity() accepts, for error messages.
[[nodiscard]] std::string identity_forms();
/// What parse_identity() accepts instead of a text that it does not accept: the form that begins with the
/// text's first word, with its limits; all forms if none does.
[[nodiscard]] std::string expected_identity(const std::string& text);
[[nodiscard]] std::string to_text(const Identity& identity);
/// The name of the identity's key folder, for example "agent-3".
[[nodiscard]] std::string folder_name(const Identity& identity);

/// Whether messages from this identity may have this Header.sender.
[[nodiscard]] bool may_use_sender(const Identity& identity, std::uint32_t sender);

}  // namespace sidestep
