// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/unmatched_readers.hpp"

#include <algorithm>

namespace sidestep {

std::vector<std::string> unmatched_readers(const std::vector<DiscoveredEndpoint>& endpoints,
                                           const std::string& topic, const PublishedType& type,
                                           const std::set<std::string>& matched) {
  DiscoveredEndpoint writer;
  writer.type = type.name;
  writer.is_keyed = type.is_keyed;
  writer.is_reliable = true;
  writer.durability = DiscoveredEndpoint::Durability::kTransientLocal;
  std::vector<std::string> result;
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    if (endpoint.is_writer || endpoint.topic != topic || matched.contains(endpoint.guid)) continue;
    if (!qos_mismatches(writer, endpoint).empty()) continue;
    result.push_back(endpoint.participant.empty() ? endpoint.guid : endpoint.participant);
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace sidestep
