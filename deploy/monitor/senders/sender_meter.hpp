// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include "common/time/histogram.hpp"
#include "deploy/monitor/senders/message_trace.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// What arrives of a topic from each sender: how late, and what is lost, repeated or out of order. Delays are
/// from the sender's stamp to the reception, so that they include the difference of the two hosts' clocks.
class SenderMeter {
 public:
  void add(const msg::Header& header, Time received);

  /// A line per sender, with a title.
  [[nodiscard]] std::string table() const;

  /// Of more senders, and runs of them, those are kept that were heard last.
  static constexpr std::size_t kMaxStreams = 1024;

 private:
  struct Stream {
    MessageTrace trace{Duration{0}};
    Time last_received{};
    std::uint64_t not_newest = 0;  // repeated or out of order
    Duration min_delay = Duration::max(), max_delay = Duration::min();
    DurationHistogram delays;
  };
  std::map<std::pair<std::uint32_t, std::uint64_t>, Stream> streams_;  // by sender and incarnation
  std::uint64_t forgotten_ = 0;
};

}  // namespace sidestep
