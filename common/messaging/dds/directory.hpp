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

#include "common/messaging/dds/listen.hpp"

namespace sidestep {

/// What a domain's participants have announced so far: a participant's listener. From any thread.
class DdsDirectory : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  using DomainParticipant = eprosima::fastdds::dds::DomainParticipant;

  void on_participant_discovery(DomainParticipant*,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_publisher_discovery(DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

  /// Everybody who is known now, sorted by topic.
  std::vector<DdsEndpoint> endpoints() const;
  /// The name of the participant that the endpoint with this GUID belongs to; empty when it is not known.
  std::string participant_of(const eprosima::fastrtps::rtps::GUID_t& guid) const;

 private:
  void update(const eprosima::fastrtps::rtps::GUID_t& guid, bool is_gone, DdsEndpoint&& endpoint);

  mutable std::mutex mutex_;
  std::map<eprosima::fastrtps::rtps::GuidPrefix_t, std::string> names_;
  std::map<eprosima::fastrtps::rtps::GUID_t, DdsEndpoint> endpoints_;
};

}  // namespace sidestep
