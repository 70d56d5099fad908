// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messaging/dds/operator_channel.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// Waits until this participant subscribes to the channel. If the name is empty, waits until there are
/// subscribers and no new ones appear. On timeout throws std::runtime_error that names the subscribers found.
void wait_for_subscriber(OperatorChannel& channel, const std::string& participant);
/// Waits until the topic has a writer. On timeout throws std::runtime_error with this message.
void wait_for_writer(OperatorChannel& channel, const std::string& topic, const std::string& error);
/// Waits until all subscribers have acknowledged every message. On timeout throws std::runtime_error.
void wait_until_acknowledged(OperatorChannel& channel);

/// The header of an operator's message that is sent now.
msg::Header operator_header();

}  // namespace sidestep
