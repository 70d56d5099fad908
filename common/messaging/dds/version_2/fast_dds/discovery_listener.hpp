// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
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
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) final {
    const bool has_gone = info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
                          info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT;
    on_participant(info.info.m_guid.guidPrefix,
                   {info.info.m_participantName.to_string(), host_of(info.info.m_properties)}, has_gone);
    const auto& user_data = info.info.m_userData.data_vec();
    if (on_announcement && !has_gone) on_announcement({user_data.data(), user_data.size()});
  }
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) final {
    using Info = rtps::WriterDiscoveryInfo;
    on_endpoint(info.info.guid(), endpoint_of(info.info, true),
                change_of(info.status == Info::DISCOVERED_WRITER, info.status == Info::REMOVED_WRITER));
  }
  void on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) final {
    using Info = rtps::ReaderDiscoveryInfo;
    on_endpoint(info.info.guid(), endpoint_of(info.info, false),
                change_of(info.status == Info::DISCOVERED_READER, info.status == Info::REMOVED_READER));
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

  /// Converts WriterProxyData or ReaderProxyData.
  template <typename Proxy>
  static DiscoveredEndpoint endpoint_of(const Proxy& proxy, bool is_writer) {
    DiscoveredEndpoint result;
    std::ostringstream guid;
    guid << proxy.guid();
    result.guid = guid.str();
    result.topic = proxy.topicName().to_string();
    result.type = proxy.typeName().to_string();
    result.is_writer = is_writer;
    result.is_keyed = proxy.topicKind() == rtps::WITH_KEY;
    result.is_reliable = proxy.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
    result.is_exclusive = proxy.m_qos.m_ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
    result.durability = static_cast<DiscoveredEndpoint::Durability>(proxy.m_qos.m_durability.kind);
    result.liveliness = static_cast<DiscoveredEndpoint::Liveliness>(proxy.m_qos.m_liveliness.kind);
    result.lease = to_duration(proxy.m_qos.m_liveliness.lease_duration);
    result.deadline = to_duration(proxy.m_qos.m_deadline.period);
    result.partitions = proxy.m_qos.m_partition.names();
    return result;
  }
};

}  // namespace sidestep::fast_dds
