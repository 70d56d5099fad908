// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "common/messaging/dds/discovered_endpoint.hpp"
#include "fast_dds/discovery_listener.hpp"

namespace sidestep {

/// Participant listener that records the endpoints announced by the participants of the domain. Thread-safe.
class DdsDirectory : public fast_dds::DiscoveryListener {
 public:
  void on_participant(const fast_dds::rtps::GuidPrefix_t& prefix, const AnnouncedProcess& process,
                      bool has_gone) override;
  void on_endpoint(const fast_dds::rtps::GUID_t& guid, DiscoveredEndpoint&& endpoint,
                   EndpointChange change) override;

  /// All endpoints that are known now, sorted by topic.
  std::vector<DiscoveredEndpoint> endpoints() const;
  /// The name of the participant that owns the endpoint with this GUID; empty if unknown.
  std::string participant_of(const fast_dds::rtps::GUID_t& guid) const;

 private:
  mutable std::mutex mutex_;
  std::map<fast_dds::rtps::GuidPrefix_t, AnnouncedProcess> processes_;
  std::map<fast_dds::rtps::GUID_t, DiscoveredEndpoint> endpoints_;
};

}  // namespace sidestep
