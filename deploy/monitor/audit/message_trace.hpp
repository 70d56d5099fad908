// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "common/time/time.hpp"
#include "idl/header.h"

namespace sidestep {

/// What the auditor can say of one message's way to it. Times are by the auditor's clock.
struct Heard {
  std::int64_t earliest_ns = 0;  ///< not sent before
  std::int64_t latest_ns = 0;    ///< not sent after
  bool is_next = false;          ///< follows directly the one heard before from that sender
  bool is_newest = false;        ///< no later one, nor this one, has been heard from that sender
};

/// Counts what the auditor missed, and bounds when messages were sent, from their heads alone.
class MessageTrace {
 public:
  /// A message of a channel takes at most `fastest` on its fastest way to the auditor; zero: every message is
  /// heard at the moment it is sent.
  explicit MessageTrace(Duration fastest) : fastest_ns_(fastest.count()) {}

  /// `channel` tells apart what one sender counts separately.
  Heard note(std::uint64_t channel, const msg::Header& head, Time now);

  std::uint64_t heard() const { return heard_; }
  std::uint64_t missed() const { return missed_; }

 private:
  static constexpr std::size_t kMostStreams = 1 << 15;
  /// Of so many messages one came the fastest way.
  static constexpr int kEnough = 64;

  struct Key {
    std::uint64_t channel, incarnation;
    std::uint32_t sender;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return (key.channel * 0x9e3779b97f4a7c15u) ^ (key.incarnation * 0xc2b2ae3d27d4eb4fu) ^
             (key.sender << 7);
    }
  };
  struct Stream {
    std::uint64_t newest = 0;
    std::uint64_t window = 0;  ///< bit i: number newest - i was heard
    std::int64_t least_ahead_ns =
        0;                   ///< least of (heard - stamp): the clocks' difference and the fastest way
    std::int64_t at_ns = 0;  ///< when that was brought up to date
    int count = 0;           ///< messages that it rests on, up to kEnough
  };
  void bound(Stream& stream, std::int64_t stamp_ns, std::int64_t now_ns, Heard& heard) const;

  std::int64_t fastest_ns_;
  std::unordered_map<Key, Stream, Hash> streams_;
  std::uint64_t heard_ = 0, missed_ = 0;
};

}  // namespace sidestep
