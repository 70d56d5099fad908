// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/messaging/dds/operator_channel.hpp"
#include "common/messaging/senders.hpp"
#include "idl/header.h"

namespace sidestep {

/// A process that an order is for.
struct OrderTarget {
  std::uint32_t number = kEveryProcess;  ///< as NetworkFault.target
  std::string participant;               ///< the name it goes by in the domain; empty: every process
};

/// From "all", "agent 3", "coordinator", "coordinator 1", "vision" or "simulator"; nothing else is one.
std::optional<OrderTarget> order_target(const std::string& words);

/// Waits until this participant takes the orders, or, for an empty name, until somebody does and nobody new
/// comes for a while. Throws std::runtime_error saying who does take them, when it does not come.
void wait_for_taker(OperatorChannel& orders, const std::string& participant);
/// Waits until somebody writes this channel; throws std::runtime_error with `complaint`.
void wait_for_writer(OperatorChannel& orders, const std::string& channel, const std::string& complaint);
/// Waits until all takers have what was sent; throws std::runtime_error.
void wait_until_taken(OperatorChannel& orders);

/// The head of an order that is sent now.
msg::Header order_head();

}  // namespace sidestep
