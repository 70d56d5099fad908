// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/messaging/cdr.hpp"
#include "common/messaging/sim/reachability.hpp"

namespace sidestep {

struct SimSubscription;

/// The messages of one writer of a reliable topic that one reader has not been given yet. As over DDS, a
/// reader gets nothing that was written before the two had found each other, and a writer keeps the last
/// kEventDepth messages of each key. A reader keeps a message that has arrived until those before it have
/// arrived too, or are lost for good.
class ReliableStream {
 public:
  struct Sample {
    CdrKey key;
    std::uint32_t sent;  ///< the network's index of the message
    bool has_arrived = false;
    bool is_in_history = true;  ///< of the writer
  };

  /// How long the writer and the reader need to find each other: if they can hear each other from the
  /// beginning, and after a silence.
  struct Delays {
    Duration at_first{0}, anew{0};
  };

  /// `begin`: when both exist; Time::min() if they have found each other already.
  ReliableStream(SimSubscription& reader, Time begin, const Delays& delays)
      : reader_(&reader), begin_(begin), delays_(delays) {}

  SimSubscription& reader() const { return *reader_; }
  /// Decides whether writer and reader know each other. If not, what waits is lost.
  [[nodiscard]] bool update(const Reachability& reachability, Time now);
  std::deque<Sample>& waiting() { return waiting_; }
  /// Removes the oldest message of the key from the writer's history if it holds more than kEventDepth.
  /// Returns the message if it is lost by that.
  std::optional<Sample> overwrite(const CdrKey& key);
  /// Takes out the first message if it has arrived.
  std::optional<Sample> take_arrived();

  bool has_heartbeat = false;  ///< a heartbeat is scheduled

 private:
  SimSubscription* reader_;
  Time begin_;
  Delays delays_;
  bool is_anew_ = false;
  bool is_matched_ = false;
  std::deque<Sample> waiting_;  // in the order of writing
};

}  // namespace sidestep
