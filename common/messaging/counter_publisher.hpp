// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/messaging/bus.hpp"
#include "common/protocol/drop_counters.hpp"

namespace sidestep {

/// Publishes the drop counts of this process's bus and node once per kPeriod.
class CounterPublisher {
 public:
  static constexpr Duration kPeriod{1'000'000'000};

  /// `process` and `incarnation` identify the node. `count_drops` adds the node's counts since its start. The
  /// bus makes no callbacks after this object's destruction.
  CounterPublisher(Bus& bus, std::uint32_t process, Incarnation incarnation,
                   std::function<void(DropCounters&)> count_drops);
  CounterPublisher(const CounterPublisher&) = delete;
  CounterPublisher& operator=(const CounterPublisher&) = delete;

 private:
  void publish();

  Bus& bus_;
  std::function<void(DropCounters&)> count_drops_;
  Writer<msg::Counters> writer_;
  msg::Counters message_;
};

}  // namespace sidestep
