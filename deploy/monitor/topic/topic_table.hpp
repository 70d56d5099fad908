// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/messaging/dds/listen.hpp"

namespace sidestep {

/// What `sidestep topic list` prints: a line for each topic with its type, who writes and reads it and its
/// QoS, and below it a line for each mismatch, grouped by its reason.
std::string topic_table(const std::vector<DdsEndpoint>& endpoints);

/// The names of the topics, separated by spaces.
std::string topic_names(const std::vector<DdsEndpoint>& endpoints);

}  // namespace sidestep
