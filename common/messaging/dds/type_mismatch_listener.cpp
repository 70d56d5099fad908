// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/type_mismatch_listener.hpp"

#include <algorithm>
#include <fmt/core.h>

#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/participant.hpp"

namespace sidestep {

void TypeMismatchListener::expect(const std::string& channel, const std::string& type) {
  const std::lock_guard lock(mutex_);
  types_[channel] = type;
}

std::optional<Time> TypeMismatchListener::latest_writer_found_at(const std::string& channel) const {
  const std::lock_guard lock(mutex_);
  std::optional<Time> latest;
  const auto own = types_.find(channel);
  if (own == types_.end()) return latest;
  if (const auto writers = writers_.find(*own); writers != writers_.end()) {
    for (const auto& [guid, since] : writers->second) latest = std::max(latest.value_or(since), since);
  }
  return latest;
}

void TypeMismatchListener::on_endpoint(const fast_dds::rtps::GUID_t&, DiscoveredEndpoint&& endpoint,
                                       EndpointChange change) {
  const std::lock_guard lock(mutex_);
  if (change == EndpointChange::kDiscovered) compare(endpoint);
  if (!endpoint.is_writer) return;
  auto& writers = writers_[{endpoint.topic, endpoint.type}];
  if (change == EndpointChange::kGone) {
    writers.erase(endpoint.guid);
  } else if (change == EndpointChange::kDiscovered) {
    writers.emplace(endpoint.guid, EventLoop::now());
  }
}

void TypeMismatchListener::compare(const DiscoveredEndpoint& endpoint) {
  const auto own = types_.find(endpoint.topic);
  if (own == types_.end() || own->second == endpoint.type) return;
  log_dds(fmt::format("topic '{}': a {} has type {} and is ignored, expected {}", endpoint.topic,
                      endpoint.is_writer ? "writer" : "reader", endpoint.type, own->second));
}

}  // namespace sidestep
