// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/process/command_line.hpp"

namespace sidestep {

/// Location of the topics of robot bases. Bases are third-party programs, such as those of ROS 2.
struct BasesBusOptions {
  std::string topic_prefix = "robot";  ///< the prefix "robot" in rt/robot3/cmd_vel and rt/robot3/odom
  std::optional<int> domain;           ///< a domain on this machine; nullopt: the agents' network
};

/// Adds the options --topic-prefix and --base-domain. `condition` precedes their descriptions.
void add_bases_bus_options(const CliCommand& app, const std::string& condition, BasesBusOptions& options);

/// The bus for the topics of robot bases: `bus` itself, or a separate bus on this machine without keys.
/// Throws std::invalid_argument if `bus` has keys and no domain is given, because bases have no keys, or if
/// the domain is that of `bus`.
[[nodiscard]] std::shared_ptr<Bus> bases_bus(DdsBus& bus, const BasesBusOptions& options);

}  // namespace sidestep
