// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "common/time/time.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// The sending time of a received message, and its place in its sender's sequence. Times are by the auditor's
/// clock.
struct Reception {
  std::int64_t earliest_ns = 0;  ///< lower bound of the sending time
  std::int64_t latest_ns = 0;    ///< upper bound of the sending time
  std::uint64_t missed = 0;  ///< number of messages missed between the newest earlier message and this one
  bool is_next = false;      ///< directly follows the newest message previously received from that sender
  bool is_newest = false;    ///< neither this nor a later message from that sender was received before
};

/// Counts missed messages and bounds sending times, using only message headers.
class MessageTrace {
 public:
  /// `min_latency_bound`: the fastest messages of a channel take at most this long to reach the auditor. Zero
  /// means that every message is received at the moment it is sent.
  explicit MessageTrace(Duration min_latency_bound) : min_latency_bound_ns_(min_latency_bound.count()) {}

  /// Records a message. `channel` distinguishes the streams that one sender numbers separately.
  [[nodiscard]] Reception record(std::uint64_t channel, const msg::Header& header, Time now);

  /// Number of receptions, including repetitions of a message.
  std::uint64_t received() const { return received_; }
  /// Number of different messages received.
  std::uint64_t distinct() const { return distinct_; }
  /// Number of missed messages, inferred from gaps between received messages of one sender and topic.
  std::uint64_t missed() const { return missed_; }

 private:
  static constexpr std::size_t kMaxStreams = 1 << 15;
  /// Among this many messages, at least one is assumed to have had the minimum latency.
  static constexpr int kMinSamples = 64;

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
    /// Bit i: message newest - i was received, or precedes the first one that was received.
    std::uint64_t window = 0;
    std::int64_t min_difference_ns = 0;  ///< minimum of (received - stamp): clock offset + minimum latency
    std::int64_t updated_ns = 0;         ///< when min_difference_ns was updated
    int count = 0;                       ///< number of messages behind that minimum, up to kMinSamples
  };
  void bound(Stream& stream, std::int64_t stamp_ns, std::int64_t now_ns, Reception& reception) const;

  std::int64_t min_latency_bound_ns_;
  std::unordered_map<Key, Stream, Hash> streams_;
  std::uint64_t received_ = 0, distinct_ = 0, missed_ = 0;
};

}  // namespace sidestep
