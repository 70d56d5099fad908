// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/messaging/dds/listener.hpp"

namespace sidestep {

/// The output of `sidestep topic list`: one line per topic with its type, writers, readers and QoS, followed
/// by one line per reason for a mismatch.
[[nodiscard]] std::string topic_table(const std::vector<DiscoveredEndpoint>& endpoints);

/// The output of `sidestep topic info`: the type of a topic, with its IDL if it is one of ours, and each
/// endpoint with its QoS and its mismatches. Empty if the topic has no endpoint.
[[nodiscard]] std::string topic_details(const std::vector<DiscoveredEndpoint>& endpoints,
                                        const std::string& topic);

/// Why writers and readers of one topic do not match: "feedback/3: reason (writer -> reader, …)".
[[nodiscard]] std::vector<std::string> mismatch_lines(const std::vector<DiscoveredEndpoint>& endpoints);

/// The topic names, separated by spaces.
[[nodiscard]] std::string topic_names(const std::vector<DiscoveredEndpoint>& endpoints);

}  // namespace sidestep
