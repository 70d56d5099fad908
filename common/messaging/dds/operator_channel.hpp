// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/messaging/bus.hpp"
#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// An operator's writer for one topic, with a list of the topic's subscribers. Its messages are exempt from
/// network faults.
class OperatorChannel {
 public:
  /// Throws std::runtime_error if DdsBus does.
  OperatorChannel(const DdsSettings& settings, const TopicInfo& topic);
  ~OperatorChannel();
  OperatorChannel(const OperatorChannel&) = delete;
  OperatorChannel& operator=(const OperatorChannel&) = delete;

  /// Names of the participants that subscribe now, sorted; one entry per participant.
  std::vector<std::string> subscribers() const;
  /// Whether a channel, for example "feedback/3", has a writer.
  bool has_writer(const std::string& channel) const;
  /// Sends messages of the topic's type to all subscribers.
  RawWriter& writer();
  /// Waits until every subscriber has acknowledged all messages; false on timeout.
  [[nodiscard]] bool wait_until_acknowledged(Duration timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
