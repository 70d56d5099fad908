// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/messaging/dds/discovered_endpoint.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// Whether messages of this topic would make processes or robots of a running system act.
[[nodiscard]] bool is_commanding(const TopicInfo& topic);

/// Why commanding messages must not be written to a domain with these endpoints: one of the endpoints belongs
/// to a process that drives a robot or coordinates. nullopt if commanding messages may be written.
[[nodiscard]] std::optional<std::string> reason_against_replay(const std::vector<DiscoveredEndpoint>& others);

}  // namespace sidestep
