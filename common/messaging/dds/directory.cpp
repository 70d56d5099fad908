// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/directory.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>
#include <utility>

namespace sidestep {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::dds;

Duration to_duration(const eprosima::fastrtps::Duration_t& d) {
  return d == eprosima::fastrtps::c_TimeInfinite ? Duration::max() : Duration{d.to_ns()};
}

/// Works for WriterProxyData and ReaderProxyData.
template <typename Proxy>
DiscoveredEndpoint to_endpoint(const Proxy& proxy, bool is_writer) {
  DiscoveredEndpoint result;
  std::ostringstream guid;
  guid << proxy.guid();
  result.guid = guid.str();
  result.topic = proxy.topicName().to_string();
  result.type = proxy.typeName().to_string();
  result.is_writer = is_writer;
  result.is_keyed = proxy.topicKind() == rtps::WITH_KEY;
  result.is_reliable = proxy.m_qos.m_reliability.kind == RELIABLE_RELIABILITY_QOS;
  result.is_exclusive = proxy.m_qos.m_ownership.kind == EXCLUSIVE_OWNERSHIP_QOS;
  result.durability = static_cast<DiscoveredEndpoint::Durability>(proxy.m_qos.m_durability.kind);
  result.liveliness = static_cast<DiscoveredEndpoint::Liveliness>(proxy.m_qos.m_liveliness.kind);
  result.lease = to_duration(proxy.m_qos.m_liveliness.lease_duration);
  result.deadline = to_duration(proxy.m_qos.m_deadline.period);
  result.partitions = proxy.m_qos.m_partition.names();
  return result;
}

}  // namespace

void DdsDirectory::on_participant_discovery(DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) {
  const std::lock_guard lock(mutex_);
  if (info.status == rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT ||
      info.status == rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT) {
    names_[info.info.m_guid.guidPrefix] = info.info.m_participantName.to_string();
  }
}

void DdsDirectory::on_publisher_discovery(DomainParticipant*, rtps::WriterDiscoveryInfo&& info) {
  update(info.info.guid(), info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER,
         to_endpoint(info.info, true));
}

void DdsDirectory::on_subscriber_discovery(DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) {
  update(info.info.guid(), info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER,
         to_endpoint(info.info, false));
}

std::vector<DiscoveredEndpoint> DdsDirectory::endpoints() const {
  const std::lock_guard lock(mutex_);
  std::vector<DiscoveredEndpoint> result;
  for (const auto& [guid, endpoint] : endpoints_) {
    result.push_back(endpoint);
    const auto name = names_.find(guid.guidPrefix);
    if (name != names_.end()) result.back().participant = name->second;
  }
  std::sort(result.begin(), result.end(), [](const DiscoveredEndpoint& a, const DiscoveredEndpoint& b) {
    return std::tie(a.topic, b.is_writer, a.participant, a.guid) <
           std::tie(b.topic, a.is_writer, b.participant, b.guid);
  });
  return result;
}

std::string DdsDirectory::participant_of(const rtps::GUID_t& guid) const {
  const std::lock_guard lock(mutex_);
  const auto name = names_.find(guid.guidPrefix);
  return name == names_.end() ? std::string() : name->second;
}

void DdsDirectory::update(const rtps::GUID_t& guid, bool is_removed, DiscoveredEndpoint&& endpoint) {
  const std::lock_guard lock(mutex_);
  if (is_removed) {
    endpoints_.erase(guid);
  } else {
    endpoints_[guid] = std::move(endpoint);
  }
}

}  // namespace sidestep
