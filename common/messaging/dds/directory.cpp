// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/directory.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sidestep {

namespace rtps = fast_dds::rtps;

void DdsDirectory::on_participant(const rtps::GuidPrefix_t& prefix, const AnnouncedProcess& process,
                                  bool has_gone) {
  const std::lock_guard lock(mutex_);
  if (has_gone)
    processes_.erase(prefix);
  else
    processes_[prefix] = process;
}

void DdsDirectory::on_endpoint(const rtps::GUID_t& guid, DiscoveredEndpoint&& endpoint,
                               EndpointChange change) {
  const std::lock_guard lock(mutex_);
  if (change == EndpointChange::kGone)
    endpoints_.erase(guid);
  else
    endpoints_[guid] = std::move(endpoint);
}

std::vector<DiscoveredEndpoint> DdsDirectory::endpoints() const {
  const std::lock_guard lock(mutex_);
  std::vector<DiscoveredEndpoint> result;
  for (const auto& [guid, endpoint] : endpoints_) {
    result.push_back(endpoint);
    const auto process = processes_.find(guid.guidPrefix);
    if (process == processes_.end()) continue;
    result.back().participant = process->second.name;
    result.back().host = process->second.host;
  }
  std::sort(result.begin(), result.end(), [](const DiscoveredEndpoint& a, const DiscoveredEndpoint& b) {
    return std::tie(a.topic, b.is_writer, a.participant, a.guid) <
           std::tie(b.topic, a.is_writer, b.participant, b.guid);
  });
  return result;
}

std::string DdsDirectory::participant_of(const rtps::GUID_t& guid) const {
  const std::lock_guard lock(mutex_);
  const auto process = processes_.find(guid.guidPrefix);
  return process == processes_.end() ? std::string() : process->second.name;
}

}  // namespace sidestep
