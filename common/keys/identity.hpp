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
  std::uint32_t first = 0, last = 0;  ///< numbers of agents, coordinators and robots
  std::string name{};                 ///< of a client: letters, digits, '-' and '_'

  bool operator==(const Identity&) const = default;
};

/// The identity that a text names, also "coordinator" for "coordinator 0"; nullopt if there is no such one.
[[nodiscard]] std::optional<Identity> parse_identity(const std::string& text);
/// What parse_identity() understands, for error messages.
[[nodiscard]] std::string identity_forms();
[[nodiscard]] std::string to_text(const Identity& identity);
/// The name of its folder: "agent-3".
[[nodiscard]] std::string folder_name(const Identity& identity);

/// Whether it may write, or read, a topic's channel of a robot (ignored for topics with one channel).
[[nodiscard]] bool may_write(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
[[nodiscard]] bool may_read(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
/// Whether one of them may write what the other may read. `rules` do not count: they are compared only among
/// those who also exchange other messages.
[[nodiscard]] bool exchange_messages(const Identity& a, const Identity& b);
/// Whether messages from it may have this Header.sender.
[[nodiscard]] bool may_speak_as(const Identity& identity, std::uint32_t sender);

}  // namespace sidestep
