// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/admission.hpp"
#include "common/messaging/topics.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// Keeps participants without a valid key away from a participant with keys: applies Admission in a process,
/// logs refusals, and reloads the list of revoked keys when its file changes. Thread-safe.
class ParticipantFilter {
 public:
  /// Throws std::invalid_argument if the list of revoked keys cannot be read.
  ParticipantFilter(const KeyFolder& keys, const std::string& version);

  /// See Admission::set_self().
  void set_self(const ParticipantId& id);
  /// Whether a datagram of the sender may be passed on. `address` is the IPv4 address that it came from, for
  /// the log.
  [[nodiscard]] bool passes(const ParticipantId& sender, std::span<const std::uint8_t> datagram,
                            bool is_discovery, std::span<const std::uint8_t, 4> address);
  /// See Admission::newly_refused(). Call it about once a second.
  [[nodiscard]] std::vector<ParticipantId> newly_refused();
  /// Whether a participant may send messages with this Header.sender on a robot's channel of a topic. Logs
  /// and counts refusals.
  [[nodiscard]] bool may_send(const ParticipantId& participant, const TopicInfo& topic, std::uint32_t robot,
                              std::uint32_t sender);
  [[nodiscard]] bool is_operator(const ParticipantId& participant) const;
  /// Handles Fast DDS's verdict on a participant's private key and certificate. Logs a refusal.
  void on_authentication(const ParticipantId& participant, bool is_genuine);

  /// Number of datagrams with messages from participants that were not admitted.
  std::uint64_t unknown() const { return unknown_; }
  /// Number of refused announcements and malformed discovery datagrams.
  std::uint64_t refused() const { return refused_; }
  /// Number of messages for which may_send() was false.
  std::uint64_t forged() const { return forged_; }

 private:
  void read_revoked();
  void report(const std::string& text);

  const std::string revoked_file_;
  const Certificate authority_;
  mutable std::mutex mutex_;  ///< guards the members below
  Admission admission_;
  std::filesystem::file_time_type revoked_at_{};
  std::set<std::string> reported_;
  RateLimit reports_;
  std::atomic<std::uint64_t> unknown_{0}, refused_{0}, forged_{0};
};

}  // namespace sidestep
