// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/messaging/dds/listener.hpp"
#include "deploy/monitor/topic/topic_tools.hpp"

namespace sidestep {

/// Waits for a participant that writes the topic. If there is none, says so on stderr; nullopt also if the
/// listener was stopped.
[[nodiscard]] std::optional<DiscoveredEndpoint> find_writer(DdsListener& listener,
                                                            const TopicOptions& options);

/// Says on stderr what a topic does not have in this domain, e.g. "no writer", and which topics there are.
void print_missing_topic(const TopicOptions& options, const char* what, const DdsListener& listener);

}  // namespace sidestep
