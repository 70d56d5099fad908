// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/bus.hpp"
#include "common/messaging/senders.hpp"
#include "coordinator/failover.hpp"

namespace sidestep {

/// The process that a coordinator is to others.
inline std::uint32_t process_of(const CoordinatorIdentity& coordinator) {
  return static_cast<std::uint32_t>(Sender::kCoordinator) + coordinator.number;
}

/// Publishes a message as this coordinator's.
template <typename Message>
void publish(const CoordinatorIdentity& self, Writer<Message>& writer, Message& message, Time now) {
  message.header().sender(process_of(self));
  message.header().incarnation(self.incarnation);
  writer.publish(message, now);
}

}  // namespace sidestep
