// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/messaging/dds/operator_channel.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// Waits until this participant subscribes to the channel. If the name is empty, waits until there are
/// processes that apply faults and no new ones appear. Returns the processes that will apply a fault. On
/// timeout throws std::runtime_error that names the network of `dds`, where the channel is, and the processes
/// found, and ends with `remedy`.
std::vector<std::string> wait_for_targets(OperatorChannel& channel, const DdsSettings& dds,
                                          const std::string& participant, const std::string& remedy = "");
/// Waits until the topic has a writer. On timeout throws std::runtime_error with this message.
void wait_for_writer(OperatorChannel& channel, const std::string& topic, const std::string& error);
/// Waits until all subscribers have acknowledged every message. On timeout throws std::runtime_error.
void wait_until_acknowledged(OperatorChannel& channel);

/// The header of an operator's message that is sent now.
msg::Header operator_header();

}  // namespace sidestep
