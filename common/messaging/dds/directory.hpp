// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "common/messaging/dds/discovered_endpoint.hpp"

namespace sidestep {

/// Participant listener that records the endpoints announced by the participants of the domain. Thread-safe.
class DdsDirectory : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  using DomainParticipant = eprosima::fastdds::dds::DomainParticipant;

  void on_participant_discovery(DomainParticipant*,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_publisher_discovery(DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

  /// All endpoints known at present, sorted by topic.
  std::vector<DiscoveredEndpoint> endpoints() const;
  /// Name of the participant of the endpoint with this GUID; empty if unknown.
  std::string participant_of(const eprosima::fastrtps::rtps::GUID_t& guid) const;

 private:
  void update(const eprosima::fastrtps::rtps::GUID_t& guid, bool is_removed, DiscoveredEndpoint&& endpoint);

  mutable std::mutex mutex_;
  std::map<eprosima::fastrtps::rtps::GuidPrefix_t, std::string> names_;
  std::map<eprosima::fastrtps::rtps::GUID_t, DiscoveredEndpoint> endpoints_;
};

}  // namespace sidestep
