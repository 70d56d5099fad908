// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/messaging/topics.hpp"

namespace sidestep {

/// The owner of a key: "agent 3", "coordinator 1", "vision", "simulator", "robot 0-10", "referee",
/// "client NAME", "operator", "viewer" or "judge". It is the common name of the key's certificate.
struct Identity {
  Role role = Role::kViewer;
  std::uint32_t first = 0, last = 0;  ///< range of agent, coordinator or robot numbers
  std::string name{};                 ///< name of a client: letters, digits, '-' and '_'

  bool operator==(const Identity&) const = default;
};

/// Parses the text form of an identity. Accepts "coordinator" for "coordinator 0". nullopt if the text names
/// no identity.
[[nodiscard]] std::optional<Identity> parse_identity(const std::string& text);
/// Describes what parse_identity() accepts, for error messages.
[[nodiscard]] std::string identity_forms();
[[nodiscard]] std::string to_text(const Identity& identity);
/// The name of the identity's key folder, for example "agent-3".
[[nodiscard]] std::string folder_name(const Identity& identity);

/// Whether the identity may write or read a robot's channel of a topic. The robot is ignored for topics with
/// a single channel.
[[nodiscard]] bool may_write(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
[[nodiscard]] bool may_read(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
/// Whether either identity may write a topic that the other may read. The topic `rules` does not count: it is
/// exchanged only between processes that also exchange other messages.
[[nodiscard]] bool exchange_messages(const Identity& a, const Identity& b);
/// Whether messages from this identity may have this Header.sender.
[[nodiscard]] bool may_speak_as(const Identity& identity, std::uint32_t sender);

}  // namespace sidestep
