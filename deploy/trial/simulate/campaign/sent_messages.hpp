// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// Checks the messages that a system's own processes send by the checks of their receivers. What a process
/// takes from a message or an observation, and then sends on, has to be within the receivers' bounds.
/// Otherwise one false message makes the receivers refuse all that this process sends from then on.
class SentMessages {
 public:
  /// `bus` is an observer's. It must outlive this.
  SentMessages(Bus& bus, const Scenario& scenario);
  SentMessages(const SentMessages&) = delete;
  SentMessages& operator=(const SentMessages&) = delete;

  /// For each sender and topic with malformed messages, their number and the time of the first by the bus's
  /// clock.
  std::vector<std::string> failures() const;

 private:
  struct Count {
    std::uint64_t messages = 0;
    Time first_at{};
  };
  template <typename Message>
  void check(const Topic<Message>& topic, RobotId robot = 0);

  Bus& bus_;
  Time begin_;
  std::map<std::string, Count> malformed_;  ///< by sender and topic
};

}  // namespace sidestep
