// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/process/command_line.hpp"

namespace sidestep {

/// Where the topics of bases are, which are programs of others, such as ROS 2's.
struct BasesBusOptions {
  std::string topic_prefix = "robot";  ///< of rt/robot3/cmd_vel and rt/robot3/odom
  std::optional<int> domain;           ///< of this machine; none: the network of the agents
};

/// Adds --topic-prefix and --base-domain. `condition` begins their descriptions.
void add_bases_bus_options(const CliCommand& app, const std::string& condition, BasesBusOptions& options);

/// The bus of the bases' topics: `bus` itself, or one of this machine, without keys. Throws
/// std::invalid_argument if `bus` has keys and no domain is given, since bases have none, or if the domain is
/// that of `bus`.
[[nodiscard]] std::shared_ptr<Bus> bases_bus(DdsBus& bus, const BasesBusOptions& options);

}  // namespace sidestep
