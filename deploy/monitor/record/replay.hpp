// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/messaging/dds/discovered_endpoint.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// Whether a message of the topic makes processes or robots of a running system act as if it were theirs.
[[nodiscard]] bool is_commanding(const TopicInfo& topic);

/// Why messages of these topics must not be written to a domain with these endpoints: one of them belongs to
/// a process that drives a robot or coordinates. nullopt: they may.
[[nodiscard]] std::optional<std::string> reason_against_replay(const std::vector<DiscoveredEndpoint>& others);

}  // namespace sidestep
