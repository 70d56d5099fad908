// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include "common/time/histogram.hpp"
#include "deploy/inspect/senders/message_trace.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// Statistics of a topic's messages from each sender: their delay, and how many are lost, repeated or out of
/// order. Delays are measured from the sender's stamp to the reception, so they include the difference
/// between the two hosts' clocks.
class SenderMeter {
 public:
  void add(const msg::Header& header, Time received);
  bool is_empty() const { return streams_.empty(); }

  /// A table with a title and one line per sender.
  [[nodiscard]] std::string table() const;

  /// Maximum number of sender incarnations; the most recently heard ones are kept.
  static constexpr std::size_t kMaxStreams = 1024;

 private:
  struct Stream {
    MessageTrace trace{Duration{0}};
    Time last_received{};
    std::uint64_t not_newest = 0;  // number of repeated or out-of-order messages
    Duration min_delay = Duration::max(), max_delay = Duration::min();
    DurationHistogram delays;
  };
  std::map<std::pair<std::uint32_t, std::uint64_t>, Stream> streams_;  // indexed by sender and incarnation
  std::uint64_t forgotten_ = 0;
};

}  // namespace sidestep
