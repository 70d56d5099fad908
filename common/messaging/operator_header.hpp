// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/senders.hpp"
#include "common/time/time.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// The header of an operator's message that is sent at `now`. `begun` is when the operator's process began to
/// send on the topic, and `number` counts its messages there from 1.
inline msg::Header operator_header(Time begun, std::uint64_t number, Time now) {
  msg::Header header;
  header.sender(static_cast<std::uint32_t>(Sender::kOperator));
  header.incarnation(static_cast<std::uint64_t>(to_ns(begun)));
  header.message_number(number);
  header.stamp_ns(to_ns(now));
  return header;
}

}  // namespace sidestep
