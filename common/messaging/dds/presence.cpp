// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/presence.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr Duration kMaxCheckInterval{3'000'000'000};
/// Time for which a notice is repeated. It is sent with each announcement, once a second.
constexpr Duration kRepeatDuration{2'500'000'000};
/// Time within which a process that was stopped reads all datagrams that were waiting in its sockets.
constexpr Duration kCatchUp{300'000'000};

}  // namespace

bool Presence::accept(const ParticipantId& sender, Time now) {
  const auto found = peers_.find(sender);
  if (found == peers_.end()) return true;
  Peer& peer = found->second;
  if (peer.is_forgotten) {
    peer.forgotten_notices_until = now + kRepeatDuration;
    return false;
  }
  peer.last_heard = now;
  return now >= peer.accepts_datagrams_from;
}

bool Presence::on_announcement(const ParticipantId& self, const ParticipantId& sender,
                               std::span<const PresenceNotice> notices, Time now) {
  Peer* const peer = find_or_add(sender, now);
  if (!peer) return false;
  bool must_forget = false;
  for (const PresenceNotice& notice : notices) {
    if (notice.whom != self) continue;
    if (notice.kind == PresenceNotice::Kind::kForgotten) {
      // Our record of the sender predates the sender's reset, unless this notice was already processed.
      const bool is_repeated = peer->agreed == notice.number;
      must_forget = must_forget || (!peer->is_forgotten && !is_repeated);
      peer->is_forgotten = false;
      peer->agreed = notice.number;
      if (!is_repeated) peer->accepts_datagrams_from = now + kCatchUp;
      peer->agreed_notices_until = std::max(peer->accepts_datagrams_from, now) + kRepeatDuration;
    } else if (peer->is_forgotten && notice.number == peer->forgotten_number) {
      peer->is_forgotten = false;
    }
  }
  if (peer->is_forgotten)
    peer->forgotten_notices_until = now + kRepeatDuration;
  else
    peer->last_heard = now;
  return must_forget;
}

std::vector<ParticipantId> Presence::newly_silent(Time now) {
  std::vector<ParticipantId> result;
  const bool was_stopped = now - last_check_ > kMaxCheckInterval;
  last_check_ = now;
  for (auto& [id, peer] : peers_) {
    if (peer.is_forgotten) continue;
    if (was_stopped) peer.last_heard = now;
    if (now - peer.last_heard <= kSilenceLimit) continue;
    peer.is_forgotten = true;
    peer.forgotten_number = ++last_number_;
    result.push_back(id);
  }
  return result;
}

std::vector<PresenceNotice> Presence::notices(Time now) const {
  std::vector<PresenceNotice> result;
  for (const auto& [id, peer] : peers_) {
    if (result.size() + 2 > kMaxNotices) break;
    if (peer.is_forgotten && now < peer.forgotten_notices_until)
      result.push_back({id, PresenceNotice::Kind::kForgotten, peer.forgotten_number});
    if (peer.agreed && now >= peer.accepts_datagrams_from && now < peer.agreed_notices_until)
      result.push_back({id, PresenceNotice::Kind::kAgreed, *peer.agreed});
  }
  return result;
}

Presence::Peer* Presence::find_or_add(const ParticipantId& id, Time now) {
  if (const auto found = peers_.find(id); found != peers_.end()) return &found->second;
  if (peers_.size() >= kMaxPeers) {
    // Numbers increase with time, so the lowest one is the oldest.
    const auto oldest = std::ranges::min_element(peers_, {}, [](const auto& entry) {
      return entry.second.is_forgotten ? entry.second.forgotten_number : ~std::uint64_t{0};
    });
    if (!oldest->second.is_forgotten) return nullptr;
    peers_.erase(oldest);
  }
  Peer& peer = peers_[id];
  peer.last_heard = now;
  return &peer;
}

}  // namespace sidestep
