// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/messaging/dds/listener.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"

namespace sidestep {

/// Waits for a participant that writes the topic. If there is none, reports that on stderr and returns
/// nullopt. Also returns nullopt if the listener was stopped.
[[nodiscard]] std::optional<DiscoveredEndpoint> find_writer(DdsListener& listener,
                                                            const TopicOptions& options);

/// Reports on stderr what a topic lacks in this domain, for example "no writer", and lists the topics.
void print_missing_topic(const TopicOptions& options, const char* what, const DdsListener& listener);

}  // namespace sidestep
