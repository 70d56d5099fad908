// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/keys/certificate.hpp"
#include "common/messaging/dds/presence.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// The key files of a participant, from any authority.
struct AttackerKeys {
  std::string identity_authority, certificate, private_key, permissions_authority, governance, permissions;

  /// The files of an identity made by `sidestep keys`.
  static AttackerKeys of(const std::string& folder);
};

struct AttackerSettings {
  int domain = 0;
  std::optional<AttackerKeys> keys{};  ///< nullopt: no security
  /// Returns the user data that the participant with this id announces.
  std::function<std::vector<std::uint8_t>(const ParticipantId&)> announced{};
  std::optional<CertifiedPrefix> prefix{};  ///< prefix of the participant's id; nullopt: chosen by Fast DDS
};

/// A Fast DDS participant with no checks except those of its own library.
class Attacker {
 public:
  /// Throws std::runtime_error if its own library refuses the keys.
  explicit Attacker(const AttackerSettings& settings);
  ~Attacker();
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;

  /// Writes a message. Throws std::runtime_error if its own library refuses the topic.
  template <typename Message>
  void write(const Topic<Message>& topic, std::uint32_t robot, Message message) {
    write(static_cast<const TopicInfo&>(topic), robot, &message);
  }
  /// Number of readers that its writers have found, over all topics.
  int readers() const;

 private:
  struct Impl;
  void write(const TopicInfo& topic, std::uint32_t robot, void* message);

  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
