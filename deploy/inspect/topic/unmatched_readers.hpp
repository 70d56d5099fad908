// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/messaging/dds/discovered_endpoint.hpp"

namespace sidestep {

/// The type of a DdsRawPublisher's messages.
struct PublishedType {
  std::string name;
  bool is_keyed = false;
};

/// The processes, sorted by name, of the topic's readers that DdsRawPublisher can reach but whose GUIDs are
/// not in `matched`. A reader with another type or an unsuitable QoS never matches, so it is not listed.
[[nodiscard]] std::vector<std::string> unmatched_readers(const std::vector<DiscoveredEndpoint>& endpoints,
                                                         const std::string& topic, const PublishedType& type,
                                                         const std::set<std::string>& matched);

}  // namespace sidestep
