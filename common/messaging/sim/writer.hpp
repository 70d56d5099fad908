// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "common/messaging/bus.hpp"
#include "common/messaging/sim/network.hpp"

namespace sidestep {

/// A simulated process's writer for one channel. Messages that its readers have not received are lost when it
/// is destroyed.
class SimNetwork::Writer : public RawWriter {
 public:
  /// `timers` is the subscription of the process's timers.
  Writer(SimNetwork& network, SimSubscription& timers, const TopicInfo& topic, Channel& channel)
      : network_(network), timers_(timers), topic_(topic), channel_(channel), begin_(network.now()) {}
  ~Writer() override {
    *alive_ = nullptr;
    for (const auto& [reader, stream] : streams_) network_.discard_waiting(*stream);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void write(const void* message) override { network_.send(*this, message); }

  SimProcessInstance& instance() const { return *timers_.instance; }
  SimSubscription& timers() const { return timers_; }
  const TopicInfo& topic() const { return topic_; }
  Channel& channel() const { return channel_; }
  /// A pointer to this writer that becomes null when the writer is destroyed.
  std::shared_ptr<Writer*> alive() const { return alive_; }

  /// The stream to a reader, created if necessary with the delays that `delays` returns. Processes that exist
  /// at `network_begin` have already discovered each other.
  template <typename MakeDelays>
  const std::shared_ptr<ReliableStream>& stream_to(SimSubscription& reader, Time network_begin,
                                                   MakeDelays delays) {
    auto& stream = streams_[&reader];
    if (stream) return stream;
    std::erase_if(streams_, [&](const auto& entry) {
      if (entry.second == nullptr || entry.second->reader().instance->is_alive) return false;
      network_.discard_waiting(*entry.second);
      return true;
    });
    const Time begin = std::max(begin_, reader.begin);
    stream = std::make_shared<ReliableStream>(reader, begin <= network_begin ? Time::min() : begin, delays());
    return stream;
  }

 private:
  SimNetwork& network_;
  SimSubscription& timers_;
  TopicInfo topic_;
  Channel& channel_;
  Time begin_;
  std::shared_ptr<Writer*> alive_ = std::make_shared<Writer*>(this);
  std::map<const SimSubscription*, std::shared_ptr<ReliableStream>> streams_;
};

}  // namespace sidestep
