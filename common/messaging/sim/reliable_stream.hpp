// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/messaging/cdr.hpp"
#include "common/messaging/sim/reachability.hpp"

namespace sidestep {

struct SimSubscription;

/// Messages from one writer of a reliable topic that have not been delivered to one reader yet. As in DDS, a
/// reader receives nothing that was written before reader and writer discovered each other, and a writer
/// keeps the last kEventDepth messages of each key. A reader holds back a message until all earlier messages
/// have arrived or are permanently lost.
class ReliableStream {
 public:
  struct Sample {
    CdrKey key;
    std::uint32_t sent;  ///< index of the message in the network
    bool has_arrived = false;
    bool is_in_history = true;  ///< still in the writer's history
  };

  /// Time that writer and reader need to discover each other: at first contact, and again after a silence.
  struct Delays {
    Duration at_first{0}, anew{0};
  };

  /// `begin` is the time from which both ends exist; Time::min() if they have already discovered each other.
  ReliableStream(SimSubscription& reader, Time begin, const Delays& delays)
      : reader_(&reader), begin_(begin), delays_(delays) {}

  SimSubscription& reader() const { return *reader_; }
  /// Updates and returns whether writer and reader know each other. If not, the waiting messages are lost.
  [[nodiscard]] bool update(const Reachability& reachability, Time now);
  std::deque<Sample>& waiting() { return waiting_; }
  /// If the writer's history holds more than kEventDepth messages of the key, removes the oldest of them.
  /// Returns the message if it is thereby lost.
  std::optional<Sample> overwrite(const CdrKey& key);
  /// Removes and returns the first message if it has arrived.
  std::optional<Sample> pop_arrived();

  bool has_heartbeat = false;  ///< a heartbeat is scheduled

 private:
  SimSubscription* reader_;
  Time begin_;
  Delays delays_;
  bool is_rediscovery_ = false;
  bool is_matched_ = false;
  std::deque<Sample> waiting_;  // messages in the order of writing
};

}  // namespace sidestep
