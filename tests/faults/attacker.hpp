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

/// The files of a participant's keys, of whatever origin.
struct AttackerKeys {
  std::string identity_authority, certificate, private_key, permissions_authority, governance, permissions;

  /// Those of an identity, as `sidestep keys` has made them.
  static AttackerKeys of(const std::string& folder);
};

struct AttackerSettings {
  int domain = 0;
  std::optional<AttackerKeys> keys{};  ///< nullopt: no security
  /// Its user data, by its id.
  std::function<std::vector<std::uint8_t>(const ParticipantId&)> announced{};
  std::optional<CertifiedPrefix> prefix{};  ///< how its id begins; nullopt: chosen by Fast DDS
};

/// A participant of Fast DDS that checks nothing and is checked by nobody but its own library.
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
  /// Readers that its writers of all topics have found.
  int readers() const;

 private:
  struct Impl;
  void write(const TopicInfo& topic, std::uint32_t robot, void* message);

  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
