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
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// Keeps strangers away from a participant with keys: Admission in a process, with a list of revoked keys
/// that is read again when its file changes, and a log. Thread-safe.
class Gate {
 public:
  /// Throws std::invalid_argument if the list of revoked keys cannot be read.
  Gate(const KeyFolder& keys, const std::string& version);

  /// As Admission::set_self().
  void set_self(const ParticipantId& id);
  /// Whether a datagram of the sender may be passed on. `address`: the IPv4 address from which it comes, for
  /// the log.
  [[nodiscard]] bool passes(const ParticipantId& sender, std::span<const std::uint8_t> datagram,
                            bool is_discovery, std::span<const std::uint8_t, 4> address);
  /// As Admission::newly_refused(). Call it about once a second.
  [[nodiscard]] std::vector<ParticipantId> newly_refused();
  /// Whether a participant may send messages of the topic's channel of a robot with this Header.sender. Logs
  /// and counts if not.
  [[nodiscard]] bool may_send(const ParticipantId& participant, const TopicInfo& topic, std::uint32_t robot,
                              std::uint32_t sender);
  [[nodiscard]] bool is_operator(const ParticipantId& participant) const;
  /// What Fast DDS says of a participant's private key and certificate; false is logged.
  void on_authentication(const ParticipantId& participant, bool is_genuine);

  /// Datagrams with messages of participants that were not admitted.
  std::uint64_t unknown() const { return unknown_; }
  /// Announcements, and malformed datagrams of discovery, that were refused.
  std::uint64_t refused() const { return refused_; }
  /// Messages for which may_send() was false.
  std::uint64_t forged() const { return forged_; }

 private:
  void read_revoked();
  void report(const std::string& text);

  const std::string revoked_file_;
  const Certificate authority_;
  std::set<std::string> revoked_;  ///< serial numbers of all lists that were read; guarded by mutex_
  mutable std::mutex mutex_;       ///< guards the members below
  Admission admission_;
  std::filesystem::file_time_type revoked_at_{};
  std::set<std::string> reported_;
  RateLimit reports_;
  std::atomic<std::uint64_t> unknown_{0}, refused_{0}, forged_{0};
};

}  // namespace sidestep
