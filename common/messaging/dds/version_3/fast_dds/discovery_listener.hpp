// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/rtps/builtin/data/ParticipantBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/SubscriptionBuiltinTopicData.hpp>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.hpp>
#include <fastdds/rtps/reader/ReaderDiscoveryStatus.hpp>
#include <fastdds/rtps/writer/WriterDiscoveryStatus.hpp>
#include <functional>
#include <span>
#include <sstream>
#include <string>

#include "common/messaging/dds/discovered_endpoint.hpp"
#include "fast_dds/library.hpp"

namespace sidestep::fast_dds {

/// Listener that reports discovery in plain structs.
class DiscoveryListener : public dds::DomainParticipantListener {
 public:
  /// A participant was discovered, has changed or has gone.
  virtual void on_participant(const rtps::GuidPrefix_t&, const AnnouncedProcess&, bool /*has_gone*/) {}
  /// An endpoint was discovered, has changed or has gone.
  virtual void on_endpoint(const rtps::GUID_t& guid, DiscoveredEndpoint&& endpoint,
                           EndpointChange change) = 0;

  /// Called when Fast DDS has accepted a participant's private key, certificate and permissions, or has
  /// refused its private key or certificate. It is not called if permissions are refused. Set it before the
  /// listener is used.
  std::function<void(const rtps::GuidPrefix_t&, bool is_genuine)> on_authentication;

  /// Called with the user data of a participant that was discovered or has changed. Set it before the
  /// listener is used.
  std::function<void(std::span<const std::uint8_t> user_data)> on_announcement;

  void onParticipantAuthentication(dds::DomainParticipant*,
                                   rtps::ParticipantAuthenticationInfo&& info) final {
    if (on_authentication)
      on_authentication(info.guid.guidPrefix,
                        info.status == rtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT);
  }
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus status,
                                const rtps::ParticipantBuiltinTopicData& info, bool&) final {
    const bool has_gone = status == rtps::ParticipantDiscoveryStatus::REMOVED_PARTICIPANT ||
                          status == rtps::ParticipantDiscoveryStatus::DROPPED_PARTICIPANT;
    on_participant(info.guid.guidPrefix, {info.participant_name.to_string(), host_of(info.properties)},
                   has_gone);
    const auto& user_data = info.user_data.data_vec();
    if (on_announcement && !has_gone) on_announcement({user_data.data(), user_data.size()});
  }
  void on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus status,
                                const rtps::PublicationBuiltinTopicData& info, bool&) final {
    using Status = rtps::WriterDiscoveryStatus;
    on_endpoint(info.guid, endpoint_of(info, true),
                change_of(status == Status::DISCOVERED_WRITER, status == Status::REMOVED_WRITER));
  }
  void on_data_reader_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryStatus status,
                                const rtps::SubscriptionBuiltinTopicData& info, bool&) final {
    using Status = rtps::ReaderDiscoveryStatus;
    on_endpoint(info.guid, endpoint_of(info, false),
                change_of(status == Status::DISCOVERED_READER, status == Status::REMOVED_READER));
  }

 private:
  static std::string host_of(const dds::ParameterPropertyList_t& properties) {
    for (const dds::ParameterProperty_t& property : properties)
      if (property.first() == dds::parameter_policy_physical_data_host)
        return announced_host(property.second());
    return {};
  }

  static EndpointChange change_of(bool is_new, bool has_gone) {
    return is_new ? EndpointChange::kDiscovered : has_gone ? EndpointChange::kGone : EndpointChange::kChanged;
  }

  static Duration to_duration(const Duration_t& d) {
    return d == kInfiniteDuration ? Duration::max() : Duration{d.to_ns()};
  }

  /// Converts PublicationBuiltinTopicData or SubscriptionBuiltinTopicData.
  template <typename TopicData>
  static DiscoveredEndpoint endpoint_of(const TopicData& data, bool is_writer) {
    DiscoveredEndpoint result;
    std::ostringstream guid;
    guid << data.guid;
    result.guid = guid.str();
    result.topic = data.topic_name.to_string();
    result.type = data.type_name.to_string();
    result.is_writer = is_writer;
    result.is_keyed = data.topic_kind == rtps::WITH_KEY;
    result.is_reliable = data.reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
    result.is_exclusive = data.ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
    result.durability = static_cast<DiscoveredEndpoint::Durability>(data.durability.kind);
    result.liveliness = static_cast<DiscoveredEndpoint::Liveliness>(data.liveliness.kind);
    result.lease = to_duration(data.liveliness.lease_duration);
    result.deadline = to_duration(data.deadline.period);
    result.partitions = data.partition.names();
    return result;
  }
};

}  // namespace sidestep::fast_dds
