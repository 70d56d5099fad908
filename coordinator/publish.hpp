// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/bus.hpp"
#include "coordinator/failover.hpp"

namespace sidestep {

/// Publishes a message in this coordinator's name.
template <typename Message>
void publish(const CoordinatorIdentity& self, Writer<Message>& writer, Message& message, Time now) {
  message.header().sender(process_of(self.number));
  message.header().incarnation(self.incarnation);
  writer.publish(message, now);
}

}  // namespace sidestep
