// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/messaging/bus.hpp"
#include "common/messaging/dds/dds_bus.hpp"

namespace sidestep {

/// An operator's hand in a domain: writes one topic and knows who takes what it writes. No fault holds it up.
class OperatorChannel {
 public:
  /// Throws std::runtime_error as DdsBus does.
  OperatorChannel(const DdsSettings& settings, const TopicInfo& topic);
  ~OperatorChannel();
  OperatorChannel(const OperatorChannel&) = delete;
  OperatorChannel& operator=(const OperatorChannel&) = delete;

  /// The names of the participants that take it now, sorted; a name stands there once for each.
  std::vector<std::string> takers() const;
  /// Whether somebody writes to a channel, e.g. "feedback/3".
  bool is_written(const std::string& channel) const;
  /// What sends messages of the topic's type to all takers.
  RawWriter& writer();
  /// Waits until every taker has all that was written; false when that takes longer.
  [[nodiscard]] bool wait_until_taken(Duration patience);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
