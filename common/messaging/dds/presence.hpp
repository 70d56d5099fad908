// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/messaging/reliability.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A participant's GUID prefix (RTPS 2.2, 8.2.4).
using ParticipantId = std::array<std::uint8_t, 12>;

/// A notice from one participant to another.
struct PresenceNotice {
  enum class Kind : std::uint32_t {
    /// The sender has forgotten `whom`. `number` identifies this event among those of the sender.
    kForgotten = 1,
    /// The sender has received the kForgotten notice of `whom` with the same number, and has itself forgotten
    /// `whom`.
    kAgreed = 2,
  };
  ParticipantId whom{};
  Kind kind = Kind::kForgotten;
  std::uint64_t number = 0;

  bool operator==(const PresenceNotice&) const = default;
};

/// Decides which participants are forgotten, and makes both sides forget each other.
///
/// Fast DDS can forget a silent participant by itself (its lease), but not safely: versions 2.9 and 3.1 may
/// abort if the participant leaves during the check, and if only one side forgets the other, as when a
/// process was stopped for a while, they may never find each other again. Participants therefore announce an
/// infinite lease, and this class decides instead. When a forgotten participant is heard again, it is
/// notified, and also forgets the other side. For a moment it refuses the other side's datagrams, because old
/// datagrams may still wait in its sockets: if Fast DDS took an old acknowledgement for a new one, it would
/// never resend the messages in question. Then it sends kAgreed, and its own datagrams are accepted again.
///
/// Only participants that announce presence are tracked; those of other software are left to Fast DDS.
class Presence {
 public:
  /// Maximum number of forgotten participants that are remembered; the oldest are dropped first.
  static constexpr std::size_t kMaxPeers = 1024;
  /// Maximum number of notices that notices() returns.
  static constexpr std::size_t kMaxNotices = 64;

  /// Whether a datagram from the sender may be passed on.
  [[nodiscard]] bool accept(const ParticipantId& sender, Time now);
  /// Processes an announcement. If true, everything known about the sender must be removed before any further
  /// data from it is passed on.
  [[nodiscard]] bool on_announcement(const ParticipantId& self, const ParticipantId& sender,
                                     std::span<const PresenceNotice> notices, Time now);
  /// The participants that have become silent since the last call and must be removed now. Call it about once
  /// a second. If seconds have passed since the last call, this process itself was stopped, so no participant
  /// is forgotten.
  [[nodiscard]] std::vector<ParticipantId> newly_silent(Time now);
  /// The notices to announce now.
  std::vector<PresenceNotice> notices(Time now) const;

 private:
  struct Peer {
    Time last_heard{};
    bool is_forgotten = false;
    std::uint64_t forgotten_number = 0;
    Time forgotten_notices_until{};       ///< time until which kForgotten notices are sent to the peer
    std::optional<std::uint64_t> agreed;  ///< number of the peer's last processed kForgotten notice
    Time accepts_datagrams_from{},
        agreed_notices_until{};  ///< refuses datagrams until the former, then sends kAgreed until the latter
  };

  Peer* find_or_add(const ParticipantId& id, Time now);

  std::map<ParticipantId, Peer> peers_;
  Time last_check_{};
  std::uint64_t last_number_ = 0;
};

}  // namespace sidestep
